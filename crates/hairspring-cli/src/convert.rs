//! `hairspring convert`: a groom from one format to another.

use crate::{
    console::{Console, print_line},
    fault::Fault,
    input::{Units, print_notes},
    output,
    totals::counted,
};
use clap::Parser;
use hairspring_io::{Format, Inputs, read_groom, write_groom};
use std::path::PathBuf;

/// Converts a groom between the formats .hair, .tfx and .data; the file extension selects the format. Grooms are also read
/// from .csv and .ply files, and from the lines of .obj, .glb and .gltf files.
///
/// A .tfx file needs the same number of points in every strand.
///
/// The output is in meters, Y up, and repaired: it has no segment of zero length and no value that is not
/// finite, and every strand has at least three points. Standard error reports what was repaired, guessed or
/// could not be stored in the new format.
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
        let text = format!("{}: unknown extension; a groom is written as .hair, .tfx or .data", to.display());
        return Err(Fault::Usage(text));
    }
    output::check_single(to)?;
    output::try_folder(to)?;
    let (loaded, files) = Inputs::record(from, || read_groom(from, &(*units).into()));
    let mut loaded = loaded.map_err(|e| Fault::reading(e, from))?;
    output::check_outputs(&files, from, [to.clone()])?;
    print_notes(&loaded.notes, console);
    if units.reverse {
        loaded.value.reverse();
    }
    let lost = write_groom(to, &loaded.value).map_err(Fault::writing_groom)?;
    lost.iter().for_each(|l| console.note(l));
    print_line(format_args!(
        "wrote    {} ({}, {})",
        to.display(),
        counted(loaded.value.strand_count(), "strand"),
        counted(loaded.value.point_count(), "point")
    ));
    Ok(())
}
