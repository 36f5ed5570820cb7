//! Promises of the commands of the program. Each file is one promise.

#[path = "../common/mod.rs"]
mod common;

mod bad_input_gives_one_sentence;
mod bakes_are_reproducible;
mod bench_keeps_its_bounds;
mod compare_shows_two_scenes;
mod compare_tells_integrators_apart;
mod grooms_convert_exactly;
mod info_reports_what_a_file_holds;
mod interrupts_leave_nothing_partial;
mod out_of_memory_is_a_sentence;
mod pictures_and_clips_are_written;
mod pictures_hold_alpha_depth_and_motion;
mod prerolls_show_progress;
mod pressed_strands_are_reported;
mod resume_checks_inputs_and_frames;
mod standard_output_errors_are_reported;
mod validate_compares_with_closed_forms;
