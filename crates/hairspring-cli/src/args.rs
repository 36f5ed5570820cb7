//! The command line. Each command's options are in the module of the command.

use crate::{bake, bench, compare, convert, demo, info, live, render, validate};
use clap::{Parser, Subcommand, ValueEnum};

const AFTER_HELP: &str = "\
Examples:
  hairspring                                             open the window with a moving head of hair
  hairspring live shot.toml                              open a scene in the window
  hairspring demo --style curly --seconds 2              write a clip of curly hair
  hairspring info ponytail.tfx                           describe a file
  hairspring convert head.hair head.tfx                  convert a groom
  hairspring render head.hair -o head.png                draw a groom
  hairspring render shot.toml -o shot.mp4                write a scene as a clip
  hairspring render shot.toml -o f.####.png --frames 20-80 --resume
  hairspring bake shot.toml -o hair.####.hair            write one groom file per frame
  hairspring bench --strands 100000 --json               measure the speed
  hairspring compare a.toml b.toml -o compare.mp4        two scenes side by side, and their differences
  hairspring compare --methods --report compare.html     compare the integrators
  hairspring validate --report validation.html           compare the simulation with closed-form solutions

Results go to standard output, progress and notes to standard error.

Exit codes:
  0    success
  1    a validation result is outside its tolerance
  2    invalid argument
  3    a file was not found or could not be read
  4    a file's content is wrong
  5    a file or standard output could not be written
  6    the scene cannot be simulated
  7    the machine lacks what the command needs: a desktop, a GPU
  8    out of memory
  70   internal error
  130  interrupted (Ctrl-C, SIGTERM): no partial file is left. A run that writes frames completes the
       current one first; a second interrupt ends it immediately";

/// Heading of the options that every command has.
const EVERYWHERE: &str = "Global options";

/// Real-time strand hair: simulate, draw, convert, bake and measure it.
///
/// Without a command, this opens a window with a moving head of hair. Without a desktop, it writes a clip and
/// a still picture instead (`hairspring demo`).
#[derive(Parser)]
#[command(name = "hairspring", version, after_help = AFTER_HELP, max_term_width = 110)]
pub struct Cli {
    /// Number of threads [default: one per processor]
    #[arg(long, global = true, help_heading = EVERYWHERE, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Print only results and errors
    #[arg(short, long, global = true, help_heading = EVERYWHERE, conflicts_with = "verbose")]
    pub quiet: bool,

    /// Print the time of each frame of a long run
    #[arg(short, long, global = true, help_heading = EVERYWHERE)]
    pub verbose: bool,

    /// How the progress of a long run is shown
    #[arg(long, global = true, help_heading = EVERYWHERE, value_name = "FORM", default_value = "text")]
    pub progress: ProgressForm,

    /// The command to run.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// How the progress of a long run is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressForm {
    /// A bar on a terminal, otherwise a line every tenth.
    Text,
    /// One line of JSON on standard error for each frame and each note.
    Json,
    /// Lines of Open Job Description on standard output: `openjd_progress` and `openjd_status`.
    Openjd,
}

/// The commands. Each is documented at its options.
#[derive(Subcommand)]
pub enum Command {
    Live(live::Options),
    Demo(demo::Options),
    Render(render::Options),
    Bake(bake::Options),
    Convert(convert::Options),
    Info(info::Options),
    Bench(bench::Options),
    Compare(compare::Options),
    Validate(validate::Options),
}

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
