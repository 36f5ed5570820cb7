//! The `hairspring` program, as a function of its arguments: the binary and the Python package run it.

mod args;
mod bake;
mod bench;
mod compare;
mod console;
mod convert;
mod demo;
mod fault;
mod film;
mod frames;
mod info;
mod input;
mod interrupt;
mod live;
mod moment;
pub mod out_of_memory;
mod output;
mod picture;
mod play;
mod render;
mod report;
mod totals;
mod validate;

use args::{Cli, Command};
use clap::{
    Parser,
    error::{ContextKind, ContextValue},
};
use console::Console;
pub use console::remember_closed_output;
use fault::Fault;
use std::{ffi::OsString, io::Write, path::Path};

/// What the program says about the command `wedge`, which the Python package adds.
const WEDGE: &str = "`hairspring wedge` comes with the Python package: run `pip install '.[wedge]'` in a clone of the \
    repository, and write `wedge` as the first argument";

/// Runs the program with its arguments, of which the first is its name. Returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    fault::report_panics();
    console::remember_closed_output();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let outcome = std::panic::catch_unwind(|| {
        let cli = match Cli::try_parse_from(&arguments) {
            Ok(cli) => cli,
            // It quotes arguments as they are.
            Err(refused) => {
                return explain(&Cli::try_parse_from(one_line_each(&arguments)).err().unwrap_or(refused));
            }
        };
        run_command(cli)?;
        console::finish().map(|()| 0)
    });
    match outcome {
        Ok(Ok(code)) => code,
        Ok(Err(fault)) => {
            console::print_error(&fault);
            fault.code()
        }
        // The panic hook has already printed the error.
        Err(_) => fault::PANICKED,
    }
}

/// The arguments without characters that control a terminal or begin a new line.
fn one_line_each(arguments: &[OsString]) -> impl Iterator<Item = OsString> {
    let shown = |text: &str| OsString::from(&*hairspring_io::printable(text));
    arguments.iter().map(move |argument| argument.to_str().map_or_else(|| argument.clone(), shown))
}

/// Prints the help, the version, or what is wrong with the command line.
fn explain(refused: &clap::Error) -> Result<u8, Fault> {
    let named = refused.get(ContextKind::InvalidSubcommand);
    if named.is_some_and(|value| matches!(value, ContextValue::String(name) if name == "wedge")) {
        return Err(Fault::Usage(WEDGE.into()));
    }
    let printed = refused.print().and_then(|()| std::io::stdout().flush());
    if refused.use_stderr() {
        return Ok(Fault::Usage(String::new()).code());
    }
    let printed = console::check_open().and(printed);
    printed.map_err(console::unprinted)?;
    Ok(0)
}

/// Returns the text of the scene file `path` with other values, for a file in `folder`: the paths of the files that it names are
/// rewritten. `values` holds keys such as `solver.substeps`, and values as TOML.
///
/// # Errors
/// One sentence, if the file cannot be read or a value is not valid.
pub fn scene_with(path: &Path, folder: &Path, values: &[(String, String)]) -> Result<String, String> {
    let mut text = hairspring_io::scene_text(path).map_err(|why| why.to_string())?;
    for (key, value) in values {
        let wrong = |why: &dyn std::fmt::Display| format!("{key} = {value}: {why}");
        text = hairspring_app::set_in_text(&text, key, value).map_err(|why| wrong(&why))?;
        hairspring_io::read_settings(path, &text).map_err(|why| wrong(&why))?;
    }
    let from = path.parent().unwrap_or(Path::new(""));
    hairspring_app::text_in_folder(&text, [from, folder]).map_err(|why| why.to_string())
}

fn run_command(cli: Cli) -> Result<(), Fault> {
    interrupt::install_handler(cli.quiet);
    if let Some(threads) = cli.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads as usize)
            .build_global()
            .map_err(|e| Fault::Usage(format!("{threads} threads could not be started: {e}")))?;
    }
    let console = Console::new(cli.quiet, cli.verbose, cli.progress);
    match cli.command {
        None => live::run_or_demo(console),
        Some(Command::Live(options)) => live::run(&options),
        Some(Command::Demo(options)) => demo::run(&options, console),
        Some(Command::Render(options)) => render::run(&options, console),
        Some(Command::Bake(options)) => bake::run(&options, console),
        Some(Command::Convert(options)) => convert::run(&options, console),
        Some(Command::Info(options)) => info::run(&options, console),
        Some(Command::Bench(options)) => bench::run(&options, console),
        Some(Command::Compare(options)) => compare::run(&options, console),
        Some(Command::Validate(options)) => validate::run(&options, console),
    }
}
