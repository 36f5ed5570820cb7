//! Promises of the readers and writers of grooms, bodies and motions. Each file is one promise.

#[path = "../common/ellipsoid.rs"]
mod ellipsoid;
#[path = "../common/gltf_file.rs"]
mod gltf_file;
#[path = "../common/samples.rs"]
mod samples;

mod gltf_checks;

mod bad_files_are_refused;
mod bodies_have_the_unit_of_their_shape_and_hair;
mod comments_begin_after_a_space;
mod errors_name_the_line_at_any_line_end;
mod example_meshes_are_made_by_code;
mod files_of_another_kind_are_named;
mod gltf_animations_move_what_they_name;
mod gltf_copies_are_where_they_are_drawn;
mod gltf_files_of_exporters_are_read;
mod gltf_files_that_break_the_rules_are_reported;
mod gltf_lines_are_strands;
mod gltf_morph_targets_move_the_body;
mod gltf_motions_keep_their_keys;
mod gltf_scenes_look_as_saved;
mod gltf_skins_stay_together;
mod grooms_fit_the_body;
mod grooms_round_trip;
mod headless_bake_runs;
mod hostile_files_are_bounded;
mod motions_fit_the_body;
mod motions_of_a_body_are_chosen_by_a_clip;
mod motions_of_vertices_are_noted_if_not_played;
mod obj_contents_without_a_use_are_reported;
mod obj_files_of_exporters_are_read;
mod ply_curves_are_strands;
mod real_files_are_read;
mod real_grooms_stay_on_real_heads;
mod strands_without_a_place_are_reported;
mod tfx_headers_are_checked;
mod units_of_motions_give_a_person;
mod vrm_avatars_look_ahead;
