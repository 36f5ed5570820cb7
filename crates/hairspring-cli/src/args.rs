//! The command line as a whole; each command's options are beside the command.

use crate::{bake, bench, compare, convert, demo, info, render, validate};
use clap::{Parser, Subcommand};

const AFTER_HELP: &str = "\
Examples:
  hairspring                                             a head of 100,000 hairs, moving, as a clip and a still
  hairspring demo --style curly --seconds 2              the same in curls
  hairspring info ponytail.tfx                           what a file holds
  hairspring convert head.hair head.tfx                  one groom format to another
  hairspring render head.hair -o head.png                a picture of a groom
  hairspring render shot.toml -o shot.mp4                a scene as a clip
  hairspring render shot.toml -o f.####.png --frames 20-80 --resume
  hairspring bake shot.toml -o hair.####.hair            a scene as one groom file a frame
  hairspring bench --strands 100000 --json               how fast this machine is
  hairspring compare --report compare.html               what each integrator does to the same hair
  hairspring validate --report validation.html           whether its hair is physics

Results go to standard output, progress and notes to standard error.

Exit codes:
  0    done
  1    a validation is out of its tolerance
  2    the command line asks for something that there is not
  3    a file was not found or could not be read
  4    a file's content is wrong
  5    a file could not be written
  6    the scene cannot be simulated
  7    there is no graphics card that can be used, or it gave up
  70   an error of the program itself
  130  interrupted (Ctrl-C): the frame in hand was completed, nothing is half-written";

/// Heading of the options that every command has.
const EVERYWHERE: &str = "With every command";

/// Real-time strand hair: simulate it, draw it, convert it, bake it, measure it.
///
/// Without a command, simulates five seconds of a moving head with 100,000 hairs and writes a clip and a still.
#[derive(Parser)]
#[command(name = "hairspring", version, after_help = AFTER_HELP, max_term_width = 110)]
pub struct Cli {
    /// Threads to work on [default: one a processor]
    #[arg(long, global = true, help_heading = EVERYWHERE, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,

    /// Say nothing but results and errors
    #[arg(short, long, global = true, help_heading = EVERYWHERE, conflicts_with = "verbose")]
    pub quiet: bool,

    /// Say what each frame of a long run took
    #[arg(short, long, global = true, help_heading = EVERYWHERE)]
    pub verbose: bool,

    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The commands; what each is for stands with its options.
#[derive(Subcommand)]
pub enum Command {
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
