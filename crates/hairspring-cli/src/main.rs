//! The binary of the `hairspring` program.

use hairspring_cli::out_of_memory;
use std::process::ExitCode;

#[global_allocator]
static MEMORY: out_of_memory::Watched = out_of_memory::Watched;

/// Calls the function before the standard library begins.
// SAFETY: the section holds pointers to functions without arguments that the C library calls in turn; this one reads a flag of
// a file descriptor and sets an atomic, and so needs nothing of the standard library.
#[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
#[cfg(unix)]
#[used]
static BEFORE_MAIN: extern "C" fn() = hairspring_cli::remember_closed_output;

fn main() -> ExitCode {
    out_of_memory::report();
    ExitCode::from(hairspring_cli::run(std::env::args_os()))
}
