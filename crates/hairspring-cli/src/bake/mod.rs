//! `hairspring bake`: writes a scene's hair as one groom file per frame, or as one file of moving strands.

mod cache;
mod checkpoints;
mod samples;
mod selection;

use crate::{
    console::{Console, print_json, print_line},
    fault::Fault,
    frames::{self, FrameRange},
    input::Input,
    interrupt, output,
    play::{Ending, play_from, set_up},
    totals::{self, Totals, grouped},
};
use cache::Cache;
use checkpoints::Checkpoints;
use clap::Parser;
use hairspring::material::Material;
use hairspring_io::{Format, FrameWriter, Manifest, Origin};
use hairspring_scene::{Scene, stage::FrameRate};
use samples::Samples;
use selection::Selection;
use serde_json::json;
use std::{path::PathBuf, time::Instant};

/// Simulates a scene and writes its hair, in meters, Y up: one groom file per frame (.hair, .tfx or .data), or one
/// file of moving strands (.usdc, .usda, .abc or .pc2; USD and Alembic need the Python package).
///
/// The first frame is the rest pose at time 0. A file holds the hairs of all grooms of the scene, one groom after the
/// other. Every frame has the same strands in the same order. A file appears only when it is complete. The
/// result is bit-identical for any number of threads.
///
/// A .tfx file needs the same number of points in every strand.
///
/// One file of moving strands is put together at the end, from samples in a folder next to it, such as
/// hair.usdc.frames for hair.usdc. --resume continues with them.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring bake shot.toml -o bake/hair.####.hair
  hairspring bake shot.toml -o bake/hair.####.hair --frames 1-240 --fps 24 --substeps 8
  hairspring bake shot.toml -o bake/hair.####.hair --resume        after Ctrl-C or a crash
  hairspring bake shot.toml -o bake/hair.####.hair --checkpoint 24 --frames 101-200 --resume
  hairspring bake shot.toml -o hair.usdc --start 1001 --fps 24 --samples 2
  hairspring bake asset.usda -o hair.usdc --over asset.usda        a layer over the asset")]
pub struct Options {
    #[command(flatten)]
    input: Input,

    /// Files to write: NAME.####.hair, .tfx or .data, where `#` signs represent the digits of the frame number; or one
    /// file NAME.usdc, .usda, .abc or .pc2
    #[arg(short, long, value_name = "NAME.####.hair|NAME.usdc")]
    output: PathBuf,

    /// Frames to write, such as 1-150 or 60 [default: the scene's motion, or 5 seconds without one]
    #[arg(long, value_name = "A-B")]
    frames: Option<FrameRange>,

    /// Number of the frame at time 0
    #[arg(long, value_name = "FRAME", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    start: u32,

    /// Frames per second
    #[arg(long, value_name = "RATE", default_value = "30", value_parser = FrameRate::of_output)]
    fps: FrameRate,

    /// Samples per frame, for motion blur. More than 1 needs one file of moving strands
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    samples: u32,

    /// Seconds to simulate at the start before the first frame, while nothing moves, 0 to 60 [default: from the scene]
    #[arg(long, value_name = "SECONDS", value_parser = frames::preroll)]
    preroll: Option<f32>,

    /// Write only the simulated strands
    #[arg(long)]
    only_guides: bool,

    /// Write an animated layer over this USD file, from which the scene's grooms were read
    #[arg(long, value_name = "FILE.usd")]
    over: Option<PathBuf>,

    /// Keep the folder with the samples of a file of moving strands, such as hair.usdc.frames
    #[arg(long)]
    keep_frames: bool,

    /// Keep the state of the simulation every N frames, in the folder NAME.checkpoints. --resume continues from the last
    /// one, also for later frames on another machine
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    checkpoint: Option<u32>,

    /// Skip frames that an earlier run has finished. Those after the last checkpoint are still simulated, so that the
    /// result has the same bits as an uninterrupted run. The manifest next to the frames (NAME.bake.hair.json) records
    /// the inputs; a run with another scene, input file, option, version or instruction set is
    /// refused. Finished frames are checked by length and checksum
    #[arg(long)]
    resume: bool,

    /// Print a summary as JSON
    #[arg(long)]
    json: bool,
}

impl Options {
    /// Checks the options that concern the files to write. Returns the numbered files, and the cache that they are
    /// put together to, if any.
    fn files(&self) -> Result<(PathBuf, Option<Cache>), Fault> {
        let output = &self.output;
        output::check_name(output)?;
        let wrong = |text: String| Err(Fault::Usage(text));
        let cache = Cache::new(output, self.over.clone());
        let known = Format::of(output).is_some_and(|f| Format::GROOMS.contains(&f));
        let Some(cache) = cache else {
            if !known {
                let text =
                    "unknown extension; hair is baked to .hair, .tfx, .data, .usdc, .usda, .abc or .pc2";
                return wrong(format!("{}: {text}", output.display()));
            }
            let one = self.frames.is_some_and(|f| f.count() == 1);
            if !output::is_sequence(output) && !one {
                let name = output.display();
                return wrong(format!(
                    "{name} is one file for many frames; put # signs where the frame number goes (NAME.####.hair), or \
                     write .usdc, .abc or .pc2"
                ));
            }
            if self.resume && !output::is_sequence(output) {
                let text =
                    "--resume needs numbered files, such as NAME.####.hair; a single file cannot be resumed";
                return wrong(text.into());
            }
            if self.samples > 1 || self.over.is_some() || self.keep_frames {
                let text =
                    "--samples, --over and --keep-frames need one file of moving strands, such as NAME.usdc";
                return wrong(text.into());
            }
            output::try_folder(&output::frame_path(output, 1))?;
            return Ok((output.clone(), None));
        };
        output::try_folder(output)?;
        Ok((cache.samples()?, Some(cache)))
    }

    /// Applies the options that override the scene.
    fn overridden(&self, mut scene: Scene) -> Scene {
        scene.solver.preroll = self.preroll.unwrap_or(scene.solver.preroll);
        scene
    }

    /// Options that change the result, for the manifest.
    fn listed(&self) -> Vec<(&'static str, Option<String>)> {
        let mut all = self.input.options().to_vec();
        all.push(("fps", Some(self.fps.to_string())));
        // Those that have their default are left out, as in earlier manifests.
        all.push(("start", Some(self.start).filter(|n| *n != 1).map(|n| n.to_string())));
        all.push(("samples", Some(self.samples).filter(|n| *n != 1).map(|n| n.to_string())));
        all.push(("preroll", self.preroll.map(|s| s.to_string())));
        all.push(("only-guides", self.only_guides.then(|| "on".into())));
        all.push(("checkpoint", self.checkpoint.map(|n| n.to_string())));
        all
    }
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let (pattern, cache) = options.files()?;
    let (scene, files) = options.input.scene_and_files(console)?;
    let scene = options.overridden(scene);
    let samples = Samples::new(options.start, options.samples, options.fps);
    let range = options.frames.map_or_else(
        || Ok(samples.whole(scene.motion_duration())),
        |range| samples.check(range).map(|()| range),
    )?;
    let all: Vec<u32> = samples.of(range).collect();
    let mut wanted = all.clone();
    let outputs = wanted.iter().map(|sample| output::frame_path(&pattern, *sample));
    output::check_outputs(&files, &options.input.path, outputs.chain([options.output.clone()]))?;
    let mut manifest = None;
    if output::is_sequence(&pattern) {
        let origin = Origin::new("bake", &options.listed(), files);
        let (begun, note) = Manifest::begin(&pattern, origin, options.resume)?;
        console.note_all(note);
        if options.resume {
            let (unfinished, notes) =
                begun.unfinished(&wanted, |sample| output::frame_path(&pattern, sample));
            console.note_all(notes);
            wanted = unfinished;
        }
        manifest = Some(begun);
    }
    if !options.only_guides {
        // Before the scene is set up, which may take long.
        FrameWriter::new(&pattern, scene.grooms.iter().map(|groom| (&groom.groom).into()))?;
    }
    let names: Vec<String> = scene.grooms.iter().map(|groom| groom.name.clone()).collect();
    let materials = scene.grooms.iter().map(|groom| match &groom.materials[..] {
        [] => vec![Material::default()],
        given => given.to_vec(),
    });
    let materials: Vec<_> = materials.collect();
    let mut stage = set_up(scene, console)?;
    let selection = Selection::new(&stage, options.only_guides);
    let grooms = selection.grooms(&stage);
    let (mut writer, left_out) = FrameWriter::new(&pattern, grooms.iter().map(|groom| groom.into()))?;
    // A file of moving strands takes everything but the points from the grooms.
    if cache.is_none() {
        console.note_all(left_out);
    }
    let described = cache.as_ref().map(|cache| {
        let source = options.input.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        cache.checked((&all, &samples), selection.describe(&names, grooms, materials, source))
    });
    let described = described.transpose()?;
    interrupt::finish_current("the current frame");
    if let Some(cache) = &cache {
        cache.create_folder()?;
    }
    if let Some(manifest) = &mut manifest {
        manifest.will_replace(wanted.iter().map(|sample| output::frame_path(&pattern, *sample)));
        manifest.write()?;
    }
    let checkpoints = match (options.checkpoint, &manifest) {
        (None, _) => None,
        (Some(every), Some(manifest)) => {
            Some(Checkpoints::new(&pattern, every * options.samples, manifest.origin())?)
        }
        (Some(_), None) => {
            let text =
                "--checkpoint needs numbered files, such as NAME.####.hair, or one file of moving strands";
            return Err(Fault::Usage(text.into()));
        }
    };
    let first = wanted.first().map_or(0, |sample| samples.step_of(*sample));
    let mut begin = 0;
    if options.resume
        && let Some(checkpoints) = &checkpoints
        && let Some((step, state)) = checkpoints.latest(first, console)
    {
        stage
            .restore(&state)
            .map_err(|why| Fault::Content(format!("the checkpoint of step {step}: {why}")))?;
        console.note(format_args!("continues from frame {}", samples.frame_of(samples.at_step(step))));
        begin = step;
    }
    let mut totals = Totals::new();
    let last = wanted.last().copied().map_or(0, |sample| samples.step_of(sample) + 1);
    let mut progress = console.progress("simulating", last.saturating_sub(begin));
    let outcome = play_from(begin + 1, &mut stage, last, samples.rate(), |step, stage, report| {
        totals.stepped(step, report);
        let sample = samples.at_step(step - 1);
        if wanted.binary_search(&sample).is_ok() {
            let began = Instant::now();
            let path = output::frame_path(&pattern, sample);
            writer.write(&path, stage.time(), selection.points(stage).iter().map(|points| &points[..]))?;
            if let Some(manifest) = &mut manifest {
                manifest.finished(&path)?;
            }
            totals.written(1, began.elapsed());
        }
        if let Some(checkpoints) = &checkpoints
            && checkpoints.is_due(step - 1)
            && step - 1 > begin
        {
            // Otherwise frames before the checkpoint that are not listed yet would be made again from an earlier one.
            manifest.as_mut().map_or(Ok(()), Manifest::write)?;
            checkpoints.write(step - 1, stage)?;
        }
        progress.step(|| {
            format!(
                "frame {}: body {:.1?}, simulate {:.1?}, follow {:.1?}",
                samples.frame_of(sample),
                report.body,
                report.simulate,
                report.follow
            )
        });
        Ok(())
    });
    drop(progress);
    // Also after an error, so that finished frames count.
    let listed = manifest.as_mut().map_or(Ok(()), Manifest::write);
    let ending = outcome?;
    listed?;
    if let Ending::Stopped(after) = ending {
        let text = format!(
            "stopped after frame {} of {}; run the same command with --resume to continue",
            samples.frame_of(samples.at_step(after - 1)),
            range.last
        );
        return Err(Fault::Interrupted(text));
    }
    if let (Some(cache), Some(description)) = (&cache, &described) {
        cache.put_together((&all, &samples), &pattern, description, console)?;
        if !options.keep_frames {
            cache.remove_samples(console);
        }
    }
    let frames = samples.frames_in(&wanted);
    let skipped = samples.frames_in(&all) - frames;
    if options.json {
        let summary = json!({
            "output": options.output,
            "frames": frames,
            "samples": wanted.len(),
            "skipped": skipped,
            "fps": options.fps.hertz(),
        });
        print_json(&totals.json(&stage, summary));
    } else {
        let skipped = if skipped > 0 { format!(", {skipped} existed already") } else { String::new() };
        let taken = match options.samples {
            1 => String::new(),
            _ => format!("; {} samples", grouped(wanted.len())),
        };
        print_line(format_args!(
            "wrote    {} ({}{skipped}{taken})",
            options.output.display(),
            totals::frames(frames)
        ));
        totals.print(&stage);
    }
    Ok(())
}
