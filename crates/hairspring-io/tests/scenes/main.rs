//! Promises of scene files and of the book that documents them. Each file is one promise.

#[path = "../common/scenes.rs"]
mod scenes;

mod arrays_have_the_length_of_their_field;
mod backslashes_in_paths_are_explained;
mod book;
mod book_is_complete;
mod book_states_the_definitions;
mod lengths_of_no_hair_are_reported;
mod maps_vary_parameters_over_the_scalp;
mod props_move_by_their_own_keys;
mod scene_file_errors_name_line_and_remedy;
mod scene_files_give_the_scene_they_describe;
mod scene_page_is_correct;
mod settings_are_read_apart_from_geometry;
mod ties_that_strand_contact_keeps_open_are_reported;
mod what_a_scene_cannot_use_is_reported;
