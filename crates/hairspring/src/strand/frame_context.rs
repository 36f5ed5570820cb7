//! What every tile is told about an exchange interval: the substeps, and where root anchor, colliders and air are in each.

use crate::{
    collide::ColliderPose,
    settings::{Integrator, Response},
};
use glam::{Mat3, Vec3};
use std::ops::Range;

/// The substeps of one exchange interval (a frame), shared by all tiles.
#[derive(Default)]
pub struct FrameContext {
    /// Length of a substep [s].
    pub h: f32,
    /// How a substep is made.
    pub integrator: Integrator,
    /// Newton iterations a substep, 1 or more.
    pub iterations: u32,
    /// Whether the substep before this interval was as long as those in it.
    pub continues: bool,
    /// Whether any strands touch each other, which they do between substeps.
    pub meets: bool,
    /// What keeps hair out of colliders.
    pub response: Response,
    /// Whether segments are looked at between their points, see `segment`.
    pub segments: bool,
    /// Iterations of fast projection a substep.
    pub projection_iterations: u32,
    /// Gravity [m/s²].
    pub gravity: Vec3,
    /// Anchor pose at the start of the interval.
    pub anchor: (Mat3, Vec3),
    /// Each substep's end.
    pub substeps: Vec<Substep>,
    /// Those that are to be run now: all of them, or one where strands meet each other in between.
    pub now: Range<usize>,
}

impl FrameContext {
    /// Fraction of the interval that has passed before the substeps that are to be run, and the anchor's pose there.
    pub fn begun(&self) -> (f32, &(Mat3, Vec3)) {
        let before = self.now.start.checked_sub(1).map(|k| &self.substeps[k]);
        before.map_or((0.0, &self.anchor), |substep| (substep.fraction, &substep.anchor))
    }
}

/// The world at the end of one substep.
#[derive(Default)]
pub struct Substep {
    /// Fraction of the interval that has passed, above 0, at most 1.
    pub fraction: f32,
    /// The frame that roots are given in: rotation, translation [m].
    pub anchor: (Mat3, Vec3),
    /// Velocity of the air [m/s].
    pub wind: Vec3,
    /// Colliders, each at the start and the end of the substep.
    pub obstacles: Vec<ColliderPose>,
}
