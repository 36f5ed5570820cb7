//! Helpers for stages: their points, and playing a number of frames.

use glam::Vec3;
use hairspring_scene::stage::Stage;
use hairspring_test::FRAME;

/// Returns the points of all grooms [m].
pub fn points(stage: &Stage) -> Vec<Vec3> {
    stage.strands().flat_map(|strands| strands.points.to_vec()).collect()
}

/// Advances by `frames` frames, in which no strand may be reset.
pub fn play(stage: &mut Stage, frames: usize) {
    for _ in 0..frames {
        assert_eq!(stage.step(FRAME).step.reset_strands, 0, "strands became non-finite and were reset");
    }
}
