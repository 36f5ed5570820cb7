//! Promises of the library's interface. Each file is one promise.

mod accepted_values_do_not_overflow;
mod builder_refuses_what_cannot_be_simulated;
mod custom_colliders_match_built_in_ones;
mod custom_forces_match_built_in_ones;
mod debug_lines_show_the_state;
mod examples_run;
mod groups_have_handles_and_user_data;
mod input_errors_are_reported;
mod sampled_fields_match_voxelized_ones;
mod settings_change_in_place;
mod snapshots_restore_exactly;
mod states_can_be_read_and_set;
mod support;
