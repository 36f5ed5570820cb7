//! What all tiles share in a frame: the substeps, and the pose of anchor, colliders and air at the end of
//! each.

use crate::{
    collide::ColliderPose,
    settings::{Integrator, Response},
};
use glam::{Mat3, Vec3};
use std::ops::Range;

/// The substeps of one frame, shared by all tiles.
#[derive(Default)]
pub struct FrameContext {
    /// Length of a substep [s].
    pub h: f32,
    /// Length of a substep over its length without refinement [1]: the share of a correction by contact that becomes
    /// velocity; see [`relax`](super::relax).
    pub relaxation: f32,
    /// How a substep is integrated.
    pub integrator: Integrator,
    /// Newton iterations in a substep, 1 or more.
    pub iterations: u32,
    /// Whether the last substep before this frame was as long as those in it.
    pub continues: bool,
    /// Whether any strands touch each other. Strand contacts are solved between substeps.
    pub hair_contact: bool,
    /// The method that keeps hair out of colliders.
    pub response: Response,
    /// Whether segments are tested between their points; see `segment`.
    pub segments: bool,
    /// Iterations of fast projection in a substep.
    pub projection_iterations: u32,
    /// Gravity [m/s²].
    pub gravity: Vec3,
    /// Anchor pose at the start of the frame.
    pub anchor: (Mat3, Vec3),
    /// The state at the end of each substep.
    pub substeps: Vec<Substep>,
    /// The substeps to run now: all of them, or a single one when strand contacts are solved in between.
    pub now: Range<usize>,
}

impl FrameContext {
    /// Fraction of the frame that has passed before the substeps to run now, and the anchor pose at that
    /// time.
    pub fn begun(&self) -> (f32, &(Mat3, Vec3)) {
        let before = self.now.start.checked_sub(1).map(|k| &self.substeps[k]);
        before.map_or((0.0, &self.anchor), |substep| (substep.fraction, &substep.anchor))
    }
}

/// The world at the end of one substep.
#[derive(Default)]
pub struct Substep {
    /// Fraction of the frame that has passed: above 0, at most 1.
    pub fraction: f32,
    /// Pose of the anchor that roots are given in: rotation, translation [m].
    pub anchor: (Mat3, Vec3),
    /// Velocity of the air [m/s].
    pub wind: Vec3,
    /// Colliders, each with its pose at the start and at the end of the substep.
    pub colliders: Vec<ColliderPose>,
}
