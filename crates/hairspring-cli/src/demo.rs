//! `hairspring demo`, which also runs without a command if there is no desktop: the built-in head, as a clip
//! and a still.

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    film::Sink,
    frames, output,
    picture::View,
    play::Ending,
    render::{clip, shoot},
};
use clap::{Parser, builder::PossibleValuesParser};
use hairspring::material::PRESETS;
use hairspring_scene::{
    Guides,
    builtin::{BuiltinOptions, Style, scene},
    stage::FrameRate,
};
use serde_json::json;
use std::path::PathBuf;

/// Simulates the built-in head of hair and writes hairspring.mp4 and hairspring.png.
///
/// The head nods, turns to both sides and shakes for five seconds, then rests.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring demo --style coily
  hairspring demo --strands 10000 --guides all --seconds 3 --size 640x360")]
pub struct Options {
    /// Hairstyle
    #[arg(long, value_name = "STYLE", default_value = Style::Wavy.name(), value_parser = PossibleValuesParser::new(PRESETS))]
    style: String,

    /// Number of hairs on the head
    #[arg(long, value_name = "N", default_value_t = BuiltinOptions::default().strands, value_parser = clap::value_parser!(u32).range(0..=2_000_000))]
    strands: u32,

    /// Points per hair, 3 to 256 [default: depends on the style; 32 for wavy hair]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(3..=256))]
    points: Option<u32>,

    /// Hairs to simulate; the others follow: a number or `all`
    #[arg(long, value_name = "N|all", default_value = "2000", value_parser = frames::guides)]
    guides: Guides,

    /// Seed of the random variation of the style
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u32,

    /// Length of the clip [s]
    #[arg(long, value_name = "SECONDS", default_value = "5", value_parser = frames::positive)]
    seconds: f32,

    /// Frames per second
    #[arg(long, value_name = "RATE", default_value = "24", value_parser = FrameRate::of_output)]
    fps: FrameRate,

    #[command(flatten)]
    view: View,

    /// Output folder; created if it does not exist
    #[arg(short, long, value_name = "FOLDER", default_value = "out")]
    output: PathBuf,

    /// Print a summary as JSON
    #[arg(long)]
    json: bool,
}

/// Time of the still [s]: the head sweeps to one side, the hair trails behind it, and the face is visible.
const STILL: f64 = 2.67;

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let style = Style::from_name(&options.style).unwrap_or_default();
    std::fs::create_dir_all(&options.output).map_err(|e| {
        Fault::Unwritable(format!("the folder {} could not be created: {e}", options.output.display()))
    })?;
    let (film, still) = (options.output.join("hairspring.mp4"), options.output.join("hairspring.png"));
    output::try_folder(&film)?;
    output::try_folder(&still)?;
    let frames = ((f64::from(options.seconds) * options.fps.hertz()).round().min(1e6) as u32).max(1);
    let moment = ((STILL * options.fps.hertz()).round() as u32 + 1).min(frames);
    let clip = clip(&film, options.view.size, options.fps.hertz(), console)?;
    let (width, height) = clip.size();
    let sinks = vec![Sink::Clip(clip), Sink::Still(still.clone(), moment)];
    console.doing(format_args!("growing {} hairs", crate::totals::grouped(options.strands as usize)));
    let scene = scene(&BuiltinOptions {
        strands: options.strands,
        points: options.points.unwrap_or(style.points()),
        style,
        seed: options.seed,
        guides: options.guides,
    });
    let wanted: Vec<u32> = (1..=frames).collect();
    let (stage, totals, ending) = shoot(scene, &wanted, options.fps, &options.view, None, sinks, console)?;
    if let Ending::Stopped(after) = ending {
        let text = format!("stopped after frame {after} of {frames}; the clip was not written");
        return Err(Fault::Interrupted(text));
    }
    if options.json {
        let summary = json!({
            "clip": film,
            "still": still,
            "style": style.name(),
            "frames": frames,
            "fps": options.fps.hertz(),
            "size": [width, height],
        });
        print_json(&totals.json(&stage, summary));
    } else {
        print_line(format_args!(
            "clip     {} ({frames} frames, {width}x{height}, {} per second)",
            film.display(),
            options.fps
        ));
        print_line(format_args!("still    {} (frame {moment})", still.display()));
        totals.print(&stage);
    }
    Ok(())
}
