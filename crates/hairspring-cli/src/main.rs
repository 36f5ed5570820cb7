//! The binary of the `hairspring` program.

use hairspring_cli::out_of_memory;
use std::process::ExitCode;

#[global_allocator]
static MEMORY: out_of_memory::Watched = out_of_memory::Watched;

fn main() -> ExitCode {
    out_of_memory::report();
    ExitCode::from(hairspring_cli::run(std::env::args_os()))
}
