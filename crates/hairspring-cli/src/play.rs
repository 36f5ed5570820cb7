//! Sets a scene up, and plays its frames until the last one, or until the user stops the run.

use crate::{console::Console, fault::Fault, interrupt};
use hairspring_scene::{
    Scene,
    stage::{FrameRate, FrameReport, Stage},
};

/// Sets a scene up. Shows the progress of the pre-roll, which may take longer than the scene, and prints the notes about
/// the scene.
pub fn set_up(scene: Scene, console: Console) -> Result<Stage, Fault> {
    let mut shown = None;
    let stage = Stage::with_preroll_progress(scene, &mut |done, all| {
        let progress = shown.get_or_insert_with(|| console.preroll(all as u32));
        if done > 0 {
            progress.step(|| format!("frame {done} of the pre-roll"));
        }
    });
    drop(shown);
    let stage = stage?;
    console.note_all(stage.notes());
    Ok(stage)
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// All frames were played.
    Played,
    /// The user stopped the run after this frame.
    Stopped(u32),
}

/// Plays `stage`, which is at time 0, to frame `last` at the rate `fps`. Calls `show` with the number of each
/// frame and the report of its step. Frame 1 is the initial state and takes no step.
pub fn play(
    stage: &mut Stage,
    last: u32,
    fps: FrameRate,
    mut show: impl FnMut(u32, &Stage, &FrameReport) -> Result<(), Fault>,
) -> Result<Ending, Fault> {
    play_from(1, stage, last, fps, |frame, stage, report| show(frame, stage, report))
}

/// Like [`play`], for a stage that is at the time of frame `first`, which takes no step. `show` may write to the stage.
pub fn play_from(
    first: u32,
    stage: &mut Stage,
    last: u32,
    fps: FrameRate,
    mut show: impl FnMut(u32, &mut Stage, &FrameReport) -> Result<(), Fault>,
) -> Result<Ending, Fault> {
    for frame in first..=last {
        let report = if frame == first { FrameReport::default() } else { stage.step_frame(fps) };
        show(frame, stage, &report)?;
        if frame < last && interrupt::stop_requested() {
            return Ok(Ending::Stopped(frame));
        }
    }
    Ok(Ending::Played)
}
