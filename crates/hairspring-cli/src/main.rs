//! The binary of the `hairspring` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(hairspring_cli::run(std::env::args_os()))
}
