//! The `hairspring` program.

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
mod manifest;
mod moment;
mod output;
mod picture;
mod play;
mod render;
mod report;
mod totals;
mod validate;

use args::{Cli, Command};
use clap::Parser;
use console::Console;
use fault::Fault;
use std::{io::Write, process::ExitCode};

fn main() -> ExitCode {
    fault::report_panics();
    let outcome = std::panic::catch_unwind(|| {
        let cli = match Cli::try_parse() {
            Ok(cli) => cli,
            Err(refused) => return explain(&refused),
        };
        run(cli)?;
        console::finish().map(|()| ExitCode::SUCCESS)
    });
    match outcome {
        Ok(Ok(code)) => code,
        Ok(Err(fault)) => {
            console::complain(&fault);
            ExitCode::from(fault.code())
        }
        // The panic hook has already printed the error.
        Err(_) => ExitCode::from(fault::PANICKED),
    }
}

/// Prints the help, the version, or what is wrong with the command line.
fn explain(refused: &clap::Error) -> Result<ExitCode, Fault> {
    let printed = refused.print().and_then(|()| std::io::stdout().flush());
    if refused.use_stderr() {
        return Ok(ExitCode::from(Fault::Usage(String::new()).code()));
    }
    printed.map_err(console::unprinted)?;
    Ok(ExitCode::SUCCESS)
}

fn run(cli: Cli) -> Result<(), Fault> {
    interrupt::listen(cli.quiet);
    if let Some(threads) = cli.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads as usize)
            .build_global()
            .map_err(|e| Fault::Usage(format!("{threads} threads could not be started: {e}")))?;
    }
    let console = Console::new(cli.quiet, cli.verbose);
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
