//! Plays the frames of a scene until the last one, or until the user stops the run.

use crate::{fault::Fault, interrupt};
use hairspring_scene::stage::{FrameRate, FrameReport, Stage};

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
