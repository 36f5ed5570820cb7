//! `hairspring convert`: a groom from one format to another.

use crate::{
    console::{Console, say},
    fault::Fault,
    input::{Units, tell},
    output,
    totals::grouped,
};
use clap::Parser;
use hairspring_io::{Format, read_groom, write_groom};
use std::path::PathBuf;

/// Converts a groom from one format to another, told by the extensions .hair, .tfx and .data.
///
/// What is written is in metres, Y up, and repaired: no zero-length segment, no value that is not finite, three points a
/// strand at least. What was repaired, guessed, or has no place in the new format is said on standard error.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring convert head.hair head.tfx
  hairspring convert ponytail.tfx ponytail.data --scale 0.0025 --up y")]
pub struct Options {
    /// The groom to read
    #[arg(value_name = "IN")]
    from: PathBuf,

    /// The file to write
    #[arg(value_name = "OUT")]
    to: PathBuf,

    #[command(flatten)]
    units: Units,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let Options { from, to, units } = options;
    if !Format::of(to).is_some_and(|f| Format::GROOMS.contains(&f)) {
        let text =
            format!("{}: a groom is written as .hair, .tfx or .data, told by the extension", to.display());
        return Err(Fault::Usage(text));
    }
    output::try_folder(to)?;
    let loaded = read_groom(from, &(*units).into()).map_err(|e| Fault::reading(e, from))?;
    tell(&loaded.notes, &loaded.repairs, console);
    let lost = write_groom(to, &loaded.value).map_err(Fault::writing)?;
    lost.iter().for_each(|l| console.note(l));
    say(format_args!(
        "wrote    {} ({} strands, {} points)",
        to.display(),
        grouped(loaded.value.strand_count()),
        grouped(loaded.value.point_count())
    ));
    Ok(())
}
