//! Promises of contact with colliders, and of hair with hair. Each file is one promise.

mod collider_shapes_keep_hair_out;
mod contact_friction_holds_on_a_slope;
mod contact_methods_keep_hair_out;
mod contact_works_at_any_scale;
mod distance_field_is_exact_near_the_surface;
mod fast_colliders_take_hair_along;
mod folded_bundles_rest_with_a_small_contact_radius;
mod follow_hairs_stay_out_of_sheets;
mod hair_deep_inside_a_mesh_comes_to_rest;
mod hair_over_an_edge_comes_to_rest;
mod hair_with_a_covered_root_comes_to_rest;
mod segment_penetration_is_measured;
mod segments_stay_out_of_colliders;
mod thin_colliders_keep_their_hair;
mod thin_colliders_throw_no_hair;
mod tresses_stop_each_other;
