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
use crate::{
    collide::{ColliderShape, MovingCollider},
    math::{RigidTransform, angle_between},
};

/// Largest motion of a body in a substep, over its half thickness [1]. A strand in contact then stays on the
/// side where the contact began.
pub const MAX_TRAVEL: f32 = 0.5;

/// Largest motion of a body thinner than [`VERY_THIN`] in a substep, over its half thickness [1].
const MAX_TRAVEL_OF_THIN: f32 = 0.25;

/// The same for a box, whose two edges cross a segment at different places [1]. Found by trial: at 0.25, a bar of 1 by 1
/// mm that is dragged through segments of 27 mm loses 7 of 60 strands, and at 0.15 none.
const MAX_TRAVEL_OF_THIN_BOX: f32 = 0.15;

/// Half thickness below which [`MAX_TRAVEL_OF_THIN`] applies [m]. A segment is several times as long.
const VERY_THIN: f32 = 0.0025;

/// Motion in a frame, over the radius of the bounding sphere of a field or a thin shell, below which no refinement is
/// needed [1]. It spares slow bodies the search for their thickness.
const SLOW: f32 = 0.005;

/// Largest number of substeps that one body may require. A sheet has almost no thickness.
const MAX_SUBSTEPS_OF_BODY: f32 = 256.0;

/// Largest number of substeps that a solid body thinner than [`VERY_THIN`] may require. A rod of 0.5 mm radius at
/// 3 m/s requires 400 in a frame.
const MAX_SUBSTEPS_OF_THIN_SOLID: f32 = 1024.0;

/// Half thickness below which fast hair may cross a body [m].
const THIN: f32 = 0.02;

/// Smallest motion in a substep that is divided by [m].
const MIN_TRAVEL: f32 = 1e-12;

/// Smallest squared length of a path that is divided by [m²].
const MIN_SQUARED_PATH: f32 = 1e-12;

impl Simulation {
    /// Returns the number of substeps in which no body tunnels through a strand; 1 if all bodies are slow or
    /// far away.
    pub(super) fn substeps_past(&self, input: &StepInput, carried: Option<&RigidTransform>) -> u32 {
        let mut needed = 1;
        for collider in input.colliders {
            needed = needed.max(self.substeps_of_hair(input, carried, collider));
            // Relative to the anchor, because hair moves with it.
            let start = self.state.anchor.inverse() * collider.start(carried);
            let end = input.anchor.inverse() * collider.end;
            let (center, radius) = collider.shape.bounds();
            let [a, b] = [start, end].map(|pose| pose.transform_point(center));
            let turn = angle_between(start.rotation, end.rotation);
            let path = a.distance(b) + turn * radius;
            let searched = matches!(collider.shape, ColliderShape::Field(_) | ColliderShape::Sheet(_));
            let slow = if searched { SLOW * radius } else { 0.0 };
            if !path.is_finite() || !radius.is_finite() || path <= slow {
                continue;
            }
            let half = collider.shape.half_thickness();
            let very_thin = collider.shape.is_thin(VERY_THIN);
            let (part, most) = match collider.shape {
                ColliderShape::Cuboid { .. } if very_thin => {
                    (MAX_TRAVEL_OF_THIN_BOX, MAX_SUBSTEPS_OF_THIN_SOLID)
                }
                _ if very_thin => (MAX_TRAVEL_OF_THIN, MAX_SUBSTEPS_OF_THIN_SOLID),
                _ => (MAX_TRAVEL, MAX_SUBSTEPS_OF_BODY),
            };
            let count = (path / (part * half).max(MIN_TRAVEL)).ceil().min(most);
            if count <= 1.0 {
                continue;
            }
            let near = input.roots.iter().any(|root| {
                let root = input.anchor.inverse_transform_point(root.translation);
                let along =
                    ((root - a).dot(b - a) / (b - a).length_squared().max(MIN_SQUARED_PATH)).clamp(0.0, 1.0);
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
        let center = start.transform_point(center);
        let part = (MAX_TRAVEL * shape.half_thickness()).max(MIN_TRAVEL);
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
                let own = start.inverse_transform_point(x);
                // Hair at rest follows the head and the body when they move away together.
                let slip = strand.velocity(i) * input.dt + x - end.transform_point(own);
                let with_head =
                    input.anchor.transform_point(self.state.anchor.inverse_transform_point(x)) - x;
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
        (path / part).ceil().min(MAX_SUBSTEPS_OF_BODY) as u32
    }
}
