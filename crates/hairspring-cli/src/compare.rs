//! `hairspring compare`: two scenes side by side, or every integrator on the same hair.

mod methods;
mod scenes;

use crate::{console::Console, fault::Fault, frames, input::Units};
use clap::Parser;
use glam::Vec3;
use hairspring_scene::{Guides, stage::FrameRate};
use std::path::PathBuf;

/// Compares two scenes, or one scene with two settings, side by side; with --methods, compares the
/// integrators.
///
/// Two scenes: both are simulated over the same frames. A clip or a contact sheet shows them next to each
/// other, with their differences as captions. A table lists the settings that differ and the figures of both
/// sides: speed, stretch, depth, energy, time per frame, and the distance of their points if they have the
/// same strands.
///
/// Integrators (--methods): runs the scene with each integrator and reports stability, stretch and cost per
/// step. Strands of the scene also swing freely without air, damping or a body, which gives the share of the
/// energy that is kept. A few of them swing with steps of different lengths, which gives the longest stable
/// step. The report explains each method with its equations, and shows the scene at the same moments side by
/// side. Without a scene, it is a head of straight hair that nods, turns and shakes.
#[derive(Parser)]
#[command(after_help = after_help())]
pub struct Options {
    /// A scene (.toml), or a groom (.hair, .tfx, .data, .csv, .ply, or lines in .obj, .glb and .gltf; .usd and .abc with the
    /// Python package) that hangs still under gravity [default with --methods: the built-in head]
    #[arg(value_name = "A", required_unless_present = "methods")]
    a: Option<PathBuf>,

    /// The second scene or groom [default: the first, with the settings of --set-b]
    #[arg(value_name = "B", conflicts_with = "methods")]
    b: Option<PathBuf>,

    /// Change a setting of both sides, such as wind.gust=0.5; can be repeated
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "methods")]
    set: Vec<String>,

    /// Change a setting of A, such as solver.substeps=4 or groom[0].material=wavy; can be repeated
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "methods")]
    set_a: Vec<String>,

    /// Change a setting of B; can be repeated
    #[arg(long, value_name = "KEY=VALUE", conflicts_with = "methods")]
    set_b: Vec<String>,

    /// File to write: clip.mp4, or a contact sheet of four moments as sheet.png or sheet.jpg
    /// [default: compare.png]
    #[arg(short, long, value_name = "FILE", conflicts_with = "methods")]
    output: Option<PathBuf>,

    /// Write no picture, only the table
    #[arg(long, conflicts_with_all = ["methods", "output", "size", "camera", "target", "gpu"])]
    no_picture: bool,

    #[command(flatten)]
    units: Units,

    /// Length [s] [default: the longer of the two motions, or 5 seconds without one; 3 with --methods]
    #[arg(long, value_name = "SECONDS", value_parser = frames::positive)]
    seconds: Option<f32>,

    /// Frames per second [default: 30]
    #[arg(long, value_name = "RATE", value_parser = FrameRate::of_output, conflicts_with = "methods")]
    fps: Option<FrameRate>,

    /// Width and height of the two pictures together [pixels] [default: 1280x720]
    #[arg(long, value_name = "WxH", value_parser = frames::size, conflicts_with = "methods")]
    size: Option<(u32, u32)>,

    /// Camera position of both pictures [m] [default: from scene A, otherwise one that shows all its hair]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true, conflicts_with = "methods")]
    camera: Option<Vec3>,

    /// Point that the camera looks at [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = frames::point, allow_hyphen_values = true, conflicts_with = "methods")]
    target: Option<Vec3>,

    /// Draw on the GPU [default: on the CPU]
    #[arg(long, conflicts_with = "methods")]
    gpu: bool,

    /// Print the figures as JSON
    #[arg(long)]
    json: bool,

    /// Compare the integrators on one scene
    #[arg(long, help_heading = METHODS)]
    methods: bool,

    /// Integrators to compare, such as verlet,backward-euler [default: all]
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', help_heading = METHODS)]
    integrators: Vec<String>,

    /// Strands to simulate in each groom; the others follow. A number, `all`, or `file` for the guides that
    /// the file names [default: from the scene; 300 for the built-in head]
    #[arg(long, value_name = "N|all|file", value_parser = frames::guides, help_heading = METHODS)]
    guides: Option<Guides>,

    /// Substeps per 1/60 s, for every method [default: from the scene, otherwise 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = METHODS)]
    substeps: Option<u32>,

    /// Write an HTML page that explains and shows the comparison
    #[arg(long, value_name = "FILE.html", help_heading = METHODS)]
    report: Option<PathBuf>,
}

/// Heading of the options of the comparison of integrators.
const METHODS: &str = "Comparison of integrators";

fn after_help() -> String {
    format!(
        "\
{}

{}

Exit code 0 means that the comparison was made, whether the sides differ or not.

Examples:
  hairspring compare before.toml after.toml -o compare.mp4
  hairspring compare shot.toml --set-a solver.substeps=4 --set-b solver.substeps=8
  hairspring compare shot.toml --set-b 'groom[0].material=curly' --no-picture --json
  hairspring compare --methods --report compare.html
  hairspring compare shot.toml --methods --guides 200 --integrators verlet,backward-euler,bdf2",
        scenes::FIGURES,
        methods::figures()
    )
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    if options.methods {
        return methods::run(options, console);
    }
    for (given, option) in [
        (!options.integrators.is_empty(), "--integrators"),
        (options.guides.is_some(), "--guides"),
        (options.substeps.is_some(), "--substeps"),
        (options.report.is_some(), "--report"),
    ] {
        if given {
            return Err(Fault::Usage(format!(
                "{option} belongs to the comparison of integrators; add --methods, or use --set for a setting"
            )));
        }
    }
    scenes::run(options, console)
}
