//! `hairspring bake`: writes a scene's hair as one groom file per frame.

use crate::{
    console::{Console, say},
    fault::Fault,
    frames::{self, FrameRange},
    input::Input,
    interrupt,
    manifest::{Manifest, Origin},
    output,
    play::{Ending, play},
    totals::{self, Totals},
};
use clap::Parser;
use hairspring_io::{Format, FrameWriter};
use hairspring_scene::stage::{FrameRate, Stage};
use serde_json::json;
use std::{path::PathBuf, time::Instant};

/// Simulates a scene and writes its hair as one groom file per frame (.hair, .tfx or .data), in meters, Y up.
///
/// Frame 1 is the rest pose at time 0. A file holds the hairs of all grooms of the scene, one groom after the
/// other. Every frame has the same strands in the same order. A file appears only when it is complete. The
/// result is bit-identical for any number of threads.
#[derive(Parser)]
#[command(after_help = "\
Examples:
  hairspring bake shot.toml -o bake/hair.####.hair
  hairspring bake shot.toml -o bake/hair.####.hair --frames 1-240 --fps 24 --substeps 8
  hairspring bake shot.toml -o bake/hair.####.hair --resume        after Ctrl-C or a crash")]
pub struct Options {
    #[command(flatten)]
    input: Input,

    /// Files to write; `#` signs stand for the digits of the frame number: NAME.####.hair, .tfx or .data
    #[arg(short, long, value_name = "NAME.####.hair")]
    output: PathBuf,

    /// Frames to write, such as 1-150 or 60 [default: the scene's motion, or 5 seconds without one]
    #[arg(long, value_name = "A-B")]
    frames: Option<FrameRange>,

    /// Frames per second
    #[arg(long, value_name = "RATE", default_value = "30", value_parser = frames::rate)]
    fps: FrameRate,

    /// Skip frames that an earlier run has finished. They are still simulated, so that the result has
    /// the same bits as an uninterrupted run. The manifest next to the frames (NAME.bake.hair.json) records
    /// the inputs; a run with another scene, input file, option, version or instruction set is
    /// refused. Finished frames are checked by length and checksum
    #[arg(long)]
    resume: bool,

    /// Print a summary as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(options: &Options, console: Console) -> Result<(), Fault> {
    let pattern = &options.output;
    if !Format::of(pattern).is_some_and(|f| Format::GROOMS.contains(&f)) {
        let text = format!("{}: unknown extension; hair is baked to .hair, .tfx or .data", pattern.display());
        return Err(Fault::Usage(text));
    }
    let one = options.frames.is_some_and(|f| f.count() == 1);
    if !output::is_sequence(pattern) && !one {
        let text = format!(
            "{} is one file for many frames; put # signs where the frame number goes (NAME.####.hair)",
            pattern.display()
        );
        return Err(Fault::Usage(text));
    }
    if options.resume && !output::is_sequence(pattern) {
        let text = "--resume needs numbered files, such as NAME.####.hair; a single file cannot be resumed";
        return Err(Fault::Usage(text.into()));
    }
    output::try_folder(&output::frame_path(pattern, 1))?;
    let (scene, files) = options.input.scene_and_files(console)?;
    let range = options.frames.unwrap_or(FrameRange::whole(scene.clip.as_ref(), options.fps));
    let mut wanted: Vec<u32> = range.numbers().collect();
    let mut manifest = None;
    if output::is_sequence(pattern) {
        let mut all = options.input.options().to_vec();
        all.push(("fps", Some(options.fps.to_string())));
        let begun = Manifest::begin(pattern, Origin::new("bake", &all, files), options.resume, console)?;
        if options.resume {
            wanted = begun.unfinished(&wanted, pattern, console);
        }
        manifest = Some(begun);
    }
    let mut stage = Stage::new(scene)?;
    console.note_all(stage.thin_mesh());
    console.note_all(stage.starts_inside());
    let (mut writer, left_out) = FrameWriter::new(stage.strands().map(|s| s.groom.into()));
    console.note_all(left_out);
    interrupt::finish_current("the current frame");
    if let Some(manifest) = &mut manifest {
        manifest.will_replace(&wanted, pattern);
        manifest.write()?;
    }
    let mut totals = Totals::new();
    let last = wanted.last().copied().unwrap_or(0);
    let mut progress = console.progress("simulating", last);
    let outcome = play(&mut stage, last, options.fps, |frame, stage, report| {
        totals.stepped(frame, report);
        if wanted.binary_search(&frame).is_ok() {
            let began = Instant::now();
            let path = output::frame_path(pattern, frame);
            writer.write(&path, stage.time(), stage.strands().map(|s| s.points))?;
            if let Some(manifest) = &mut manifest {
                manifest.finished(&path)?;
            }
            totals.written(1, began.elapsed());
        }
        progress.step(|| {
            format!(
                "frame {frame}: body {:.1?}, simulate {:.1?}, follow {:.1?}",
                report.body, report.simulate, report.follow
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
            "stopped after frame {after} of {}; run the same command with --resume to continue",
            range.last
        );
        return Err(Fault::Interrupted(text));
    }
    let skipped = range.count() as usize - wanted.len();
    if options.json {
        let summary = json!({
            "output": pattern,
            "frames": wanted.len(),
            "skipped": skipped,
            "fps": options.fps.hertz(),
        });
        say(totals.json(&stage, summary));
    } else {
        let skipped = if skipped > 0 { format!(", {skipped} existed already") } else { String::new() };
        say(format_args!("wrote    {} ({}{skipped})", pattern.display(), totals::frames(wanted.len())));
        totals.tell(&stage);
    }
    Ok(())
}
