//! Promises of the commands of the program. Each file is one promise.

#[path = "../common/mod.rs"]
mod common;

mod bad_input_gives_one_sentence;
mod bakes_are_reproducible;
mod bench_keeps_its_bounds;
mod compare_tells_integrators_apart;
mod grooms_convert_exactly;
mod info_reports_what_a_file_holds;
mod pictures_and_clips_are_written;
mod validate_compares_with_closed_forms;
