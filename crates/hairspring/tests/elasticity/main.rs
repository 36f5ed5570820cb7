//! Promises of the elastic models, the integrators and the solver. Each file is one promise.

mod bending_follows_the_material;
mod fine_strands_come_to_rest;
mod first_frame_equals_the_groom;
mod folded_and_coiled_strands_come_to_rest;
mod solver_settings_all_run;
mod strands_of_any_length_are_stable;
mod swings_gain_no_energy;
mod teleports_keep_shape_and_motion;
