//! Promises of external forces: air, charge, global shape, manipulators, tethers. Each file is one promise.

mod charge_follows_coulombs_law;
mod comb_takes_hair_along;
mod dense_hair_carries_air_along;
mod dense_hair_shelters_itself;
mod global_shape_restores_the_style;
mod tether_limits_the_distance_to_the_root;
mod tie_holds_its_strands;
mod wind_sources_follow_their_laws;
