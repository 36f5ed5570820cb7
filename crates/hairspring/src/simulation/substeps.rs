//! Substep refinement: shorter substeps while a body that is fast relative to its thickness passes through
//! hair. Otherwise it could tunnel through a strand.
//!
//! ```text
//!      ◯ · · · · · ·│· · · · ·◯       one substep: the strand is outside at both ends, and no contact is found
//!      ◯◯◯◯◯◯◯◯◯◯◯◯◯│                 substeps shorter than the radius: the strand is pushed along
//! ```
//!
//! Fast hair near a thin body also requires short substeps: when a rod stops, the hair on it goes on at the
//! rod's speed.
//!
//! All strands use the same substeps, so that results do not depend on which strands share a tile. A rod of 1
//! cm at 20 m/s requires 133 in a frame, a hand at 5 m/s some 20, and a body that moves with the head none.
//!
//! The limbs of a skinned body are part of one shape, and so is a skinned sheet. Where they are fast, they
//! have a shape for each time slice of the frame (`stage/fast_surface.rs`), and all time slices have the same
//! number of substeps.

use super::{
    Simulation,
    step::{StepInput, substep_length},
};
use crate::parallel::prelude::*;
use crate::{collide::MovingCollider, math::RigidTransform};

/// Largest motion of a body in a substep, over its half thickness [1]. A strand in contact then stays on the
/// side where the contact began.
pub const MAX_TRAVEL: f32 = 0.5;

/// The same for a body thinner than [`VERY_THIN`] [1].
const PART_OF_THIN: f32 = 0.25;

/// Half thickness below which [`PART_OF_THIN`] applies [m]. A segment is several times as long.
const VERY_THIN: f32 = 0.0025;

/// Motion in a frame, over the radius of the body's bounding sphere, below which no refinement is needed [1]:
/// bodies are not thinner than that.
const SLOW: f32 = 0.005;

/// Largest number of substeps for one body. A sheet has almost no thickness.
const MAX_SUBSTEPS: f32 = 256.0;

/// The same for a solid body: a rod of 0.5 mm radius at 3 m/s requires 400 in a frame.
const MAX_SUBSTEPS_OF_SOLID: f32 = 1024.0;

/// Half thickness below which fast hair may cross a body [m].
const THIN: f32 = 0.02;

impl Simulation {
    /// Returns the number of substeps in which no body tunnels through a strand; 1 if all bodies are slow or
    /// far away.
    pub(super) fn substeps_past(&self, input: &StepInput, carried: Option<&RigidTransform>) -> u32 {
        let mut needed = 1;
        for collider in input.colliders {
            needed = needed.max(self.substeps_of_hair(input, carried, collider));
            // Relative to the anchor, because hair moves with it.
            let start = self.state.anchor.inverse().after(&collider.start(carried));
            let end = input.anchor.inverse().after(&collider.end);
            let (center, radius) = collider.shape.bounds();
            let [a, b] = [start, end].map(|pose| pose.point(center));
            let turn = start.rotation.angle_between(end.rotation);
            let path = a.distance(b) + turn * radius;
            if !path.is_finite() || !radius.is_finite() || path < SLOW * radius {
                continue;
            }
            let half = collider.shape.half_thickness();
            let very_thin = collider.shape.is_thin(VERY_THIN);
            let (part, most) =
                if very_thin { (PART_OF_THIN, MAX_SUBSTEPS_OF_SOLID) } else { (MAX_TRAVEL, MAX_SUBSTEPS) };
            let count = (path / (part * half).max(1e-12)).ceil().min(most);
            if count <= 1.0 {
                continue;
            }
            let near = input.roots.iter().any(|root| {
                let root = input.anchor.inverse_point(root.translation);
                let along = ((root - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
                root.distance(a.lerp(b, along)) < radius + turn * radius + self.model.longest
            });
            if near {
                needed = needed.max(count as u32);
            }
        }
        needed
    }

    /// Returns the number of substeps that the velocity of the hair near a thin body requires. When a body
    /// stops, the hair on it goes on at the body's speed.
    fn substeps_of_hair(
        &self,
        input: &StepInput,
        carried: Option<&RigidTransform>,
        collider: &MovingCollider,
    ) -> u32 {
        let shape = &collider.shape;
        if !shape.is_thin(THIN) {
            return 1;
        }
        let (start, end) = (collider.start(carried), collider.end);
        let (center, radius) = shape.bounds();
        let center = start.point(center);
        let part = (MAX_TRAVEL * shape.half_thickness()).max(1e-12);
        let slow = part * input.dt / substep_length(&self.model.solver) as f32;
        let path_of_strand = |place: usize| {
            let strand = self.strand(place);
            let mut x = strand.root();
            if x.distance(center) > radius + 2.0 * self.model.longest {
                return 0.0;
            }
            let mut most = 0.0f32;
            for i in 0..strand.particle_count() {
                let edge = strand.edge(i);
                x += edge;
                let own = start.inverse_point(x);
                // Hair at rest follows the head and the body when they move away together.
                let slip = strand.velocity(i) * input.dt + x - end.point(own);
                let with_head = input.anchor.point(self.state.anchor.inverse_point(x)) - x;
                let path = slip.length().min((slip + with_head).length());
                if path > most.max(slow) && shape.distance(own) < path + edge.length() {
                    most = path;
                }
            }
            most
        };
        let path = self
            .model
            .lane_of_strand
            .par_iter()
            .map(|&place| path_of_strand(place as usize))
            .reduce(|| 0.0, f32::max);
        (path / part).ceil().min(MAX_SUBSTEPS) as u32
    }
}
