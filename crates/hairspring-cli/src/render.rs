//! `hairspring render`: draws a scene or a groom.

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    film::{Film, Sink},
    frames::FrameRange,
    input::Input,
    interrupt, output,
    picture::{Setup, Studio, View},
    play::{Ending, play, set_up},
    totals::{self, Totals},
};
use clap::Parser;
use hairspring_io::{Manifest, Origin};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, Stage},
};
use hairspring_view::{ClipWriter, OutputError};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Simulates a scene or a groom and draws it.
///
/// Frame 1 is the rest pose at time 0. Frames before the first drawn one are simulated too. A file appears
/// only when it is complete.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring render head.hair -o head.png
  hairspring render shot.toml -o shot.mp4 --size 1920x1080 --fps 24
  hairspring render shot.toml -o frame.####.png --frames 20-80 --resume
  hairspring render shot.toml -o side.png --frames 60 --camera 1.2,1.6,0 --target 0,1.5,0
  hairspring render shot.toml -o comp.####.exr --frames 1-120 --shutter 180
  hairspring render shot.toml -o turn.mp4 --turntable --frames 61-180")]
pub struct Options {
    #[command(flatten)]
    input: Input,

    /// File to write: still.png, still.jpg, still.exr, numbered pictures such as frame.####.png or
    /// frame.####.exr, or clip.mp4
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Frames to draw, such as 1-150 or 60 [default: the scene's motion, or 5 seconds without one; frame 1
    /// for a still]
    #[arg(long, value_name = "A-B")]
    frames: Option<FrameRange>,

    /// Frames per second
    #[arg(long, value_name = "RATE", default_value = "30", value_parser = FrameRate::of_output)]
    fps: FrameRate,

    #[command(flatten)]
    view: View,

    /// Rotate the camera and its lights around the target, one full turn over the drawn frames
    #[arg(long)]
    turntable: bool,

    /// Skip pictures that an earlier run has finished; their frames are still simulated. The manifest beside
    /// the pictures (NAME.render.png.json) says what they were made from; a run with another scene, input
    /// file, option, version or instruction set is refused. Finished pictures are checked by length and
    /// checksum
    #[arg(long)]
    resume: bool,

    /// Print a summary as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    output::check_name(&options.output)?;
    let kind = Kind::of(&options.output)?;
    output::try_folder(&output::frame_path(&options.output, 1))?;
    if options.resume && kind != Kind::Pictures {
        let text =
            "--resume needs numbered pictures, such as frame.####.png; a clip or a still cannot be resumed";
        return Err(Fault::Usage(text.into()));
    }
    if options.turntable && kind == Kind::Still {
        let text = "--turntable needs a clip (turn.mp4) or numbered pictures (turn.####.png)";
        return Err(Fault::Usage(text.into()));
    }
    let (scene, files) = options.input.scene_and_files(console)?;
    let range = match (kind, options.frames) {
        (Kind::Still, None) => FrameRange { first: 1, last: 1 },
        (Kind::Still, Some(range)) if range.count() > 1 => {
            let text = format!(
                "{} holds one frame; select it (--frames {}), or number the pictures (frame.####.png)",
                options.output.display(),
                range.first
            );
            return Err(Fault::Usage(text));
        }
        (_, Some(range)) => range,
        (_, None) => FrameRange::whole(scene.motion_duration(), options.fps),
    };
    let mut wanted: Vec<u32> = range.numbers().collect();
    let outputs = wanted.iter().map(|number| output::frame_path(&options.output, *number));
    output::check_outputs(&files, &options.input.path, outputs)?;
    let mut size = options.view.size;
    let sink = match kind {
        Kind::Clip => {
            let clip = clip(&options.output, size, options.fps.hertz(), console)?;
            size = clip.size();
            Sink::Clip(clip)
        }
        Kind::Pictures => {
            let origin = Origin::new("render", &all_options(options, range), files);
            let file = |number| output::frame_path(&options.output, number);
            let (mut manifest, note) = Manifest::begin(&options.output, origin, options.resume)?;
            console.note_all(note);
            if options.resume {
                let (unfinished, notes) = manifest.unfinished(&wanted, file);
                console.note_all(notes);
                wanted = unfinished;
            }
            manifest.will_replace(wanted.iter().copied().map(file));
            Sink::Pictures(options.output.clone(), Box::new(manifest))
        }
        Kind::Still => Sink::Still(options.output.clone(), range.first),
    };
    let turn = options.turntable.then_some(range);
    let (stage, totals, ending) =
        shoot(scene, &wanted, options.fps, &options.view, turn, vec![sink], console)?;
    if let Ending::Stopped(after) = ending {
        let how = match kind {
            Kind::Pictures => "run the same command with --resume to continue",
            Kind::Clip | Kind::Still => "the file was not written; numbered pictures can be resumed",
        };
        return Err(Fault::Interrupted(format!("stopped after frame {after} of {}; {how}", range.last)));
    }
    if options.json {
        let summary = json!({
            "output": options.output,
            "frames": wanted.len(),
            "skipped": range.count() as usize - wanted.len(),
            "fps": options.fps.hertz(),
            "size": [size.0, size.1],
        });
        print_json(&totals.json(&stage, summary));
    } else {
        let skipped = match range.count() as usize - wanted.len() {
            0 => String::new(),
            n => format!(", {n} existed already"),
        };
        print_line(format_args!(
            "wrote    {} ({}{skipped})",
            options.output.display(),
            totals::frames(wanted.len())
        ));
        totals.print(&stage);
    }
    Ok(())
}

/// Plays a scene and draws the frames in `wanted`, which are in order. Over the frames of `turn` the camera
/// makes one full turn.
pub fn shoot(
    scene: Scene,
    wanted: &[u32],
    fps: FrameRate,
    view: &View,
    turn: Option<FrameRange>,
    sinks: Vec<Sink>,
    console: Console,
) -> Result<(Stage, Totals, Ending), Fault> {
    let mut stage = set_up(scene, console)?;
    let setup = Setup { turned: turn.is_some(), format: Sink::format(&sinks) };
    let mut studio = Studio::new(view, &mut stage, setup)?;
    if studio.lacks_alpha() {
        console.note("clips and JPEG files have no transparency, so the backdrop is drawn; write PNG or EXR for a transparent background");
    }
    if studio.width_scale() != 1.0 {
        console.note(format_args!(
            "{} hairs are drawn {:.2} times as wide as they are; set --hair-width to change it",
            stage.simulated_strands().1,
            studio.width_scale()
        ));
    }
    if let Some(card) = studio.card() {
        console.note(format_args!("drawing on {card}"));
    }
    interrupt::finish_current("the current frame");
    let mut film = Film::new(sinks)?;
    let mut totals = Totals::new();
    let last = wanted.last().copied().unwrap_or(0);
    let mut progress = console.progress("simulating and drawing", last);
    let ending = play(&mut stage, last, fps, |frame, stage, report| {
        totals.stepped(frame, report);
        let mut timings = None;
        if let Some(turn) = turn.filter(|turn| frame >= turn.first) {
            studio.turn((frame - turn.first) as f32 / turn.count() as f32);
        }
        if wanted.binary_search(&frame).is_ok() {
            let (drawn, times) = studio.draw(stage)?;
            timings = Some(times);
            film.show(frame, drawn)?;
            totals.drawn(times, studio.sent());
        } else {
            studio.pass(stage);
        }
        progress.step(|| {
            let drawn = timings.map_or(String::new(), |t| {
                format!(", shadow {:.1?}, draw {:.1?}", t.shadow, t.strands + t.tiles)
            });
            format!(
                "frame {frame}: body {:.1?}, simulate {:.1?}, follow {:.1?}{drawn}",
                report.body, report.simulate, report.follow
            )
        });
        Ok(())
    })?;
    drop(progress);
    if ending == Ending::Played {
        totals.written(wanted.len() as u32, film.finish()?);
    }
    Ok((stage, totals, ending))
}

/// Starts a clip. A size or rate that clips do not support is an error of the command line.
pub fn clip(
    path: &Path,
    (width, height): (u32, u32),
    fps: f64,
    console: Console,
) -> Result<Box<ClipWriter>, Fault> {
    let clip = ClipWriter::create(path, width, height, fps).map_err(|e| match e {
        OutputError::Clip { .. } => Fault::Usage(e.to_string()),
        other => other.into(),
    })?;
    let (even_width, even_height) = clip.size();
    if (even_width, even_height) != (width, height) {
        console.note(format_args!(
            "a clip has an even width and height, so that of {width}x{height} pixels has {even_width}x{even_height}; set --size to choose another"
        ));
    }
    Ok(Box::new(clip))
}

/// The kind of output that a file name selects.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Clip,
    Pictures,
    Still,
}

impl Kind {
    fn of(path: &Path) -> Result<Self, Fault> {
        match (output::extension(path).as_str(), output::is_sequence(path)) {
            ("png" | "exr", true) => Ok(Self::Pictures),
            ("png" | "jpg" | "exr", false) => Ok(Self::Still),
            ("mp4", false) => Ok(Self::Clip),
            _ => Err(Fault::Usage(format!(
                "{}: unknown output; pictures are written as still.png, still.jpg, still.exr, frame.####.png or frame.####.exr, clips as clip.mp4",
                path.display()
            ))),
        }
    }
}

/// The options that change pictures, for their manifest.
fn all_options(options: &Options, range: FrameRange) -> Vec<(&'static str, Option<String>)> {
    let View { size, camera, target, follow, fov, background, light_angle, shutter, hair_width, gpu } =
        &options.view;
    let point = |p: glam::Vec3| format!("{},{},{}", p.x, p.y, p.z);
    let set = |flag: bool| flag.then(|| "set".to_owned());
    let mut all = options.input.options().to_vec();
    all.extend([
        ("fps", Some(options.fps.to_string())),
        ("size", Some(format!("{}x{}", size.0, size.1))),
        ("camera", camera.map(point)),
        ("target", target.map(point)),
        ("follow", follow.map(|follow| if follow { "yes" } else { "no" }.into())),
        ("fov", fov.map(|fov| fov.to_string())),
        ("background", background.map(|background| background.name().to_owned())),
        ("light-angle", light_angle.map(|angle| angle.to_string())),
        ("shutter", shutter.map(|shutter| shutter.to_string())),
        ("hair-width", hair_width.map(|width| width.to_string())),
        ("gpu", set(*gpu)),
        // The angle of a frame depends on the range of all.
        ("turntable", options.turntable.then(|| format!("over frames {}-{}", range.first, range.last))),
    ]);
    all
}
