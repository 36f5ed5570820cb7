//! Shorter substeps while a body passes through hair that is faster than it is thick: in steps of its own size it would be on the other side of a strand before it met it.
//!
//! ```text
//!      ◯ · · · · · ·│· · · · ·◯       one substep: the strand is outside at both ends, and was never met
//!      ◯◯◯◯◯◯◯◯◯◯◯◯◯│                 so many that each is a part of the radius: it is pushed along
//! ```
//!
//! Hair that is fast by itself asks for them too where it is near a thin body: a rod that stops leaves hair that goes on around it as fast as the rod was.
//!
//! All strands take them, so that none depends on which of them share a tile; a rod of 1 cm at 20 m/s asks for 133 in a frame, a hand at 5 m/s for
//! some 20, and what moves with the head for none.
//!
//! The limbs of a skinned body are one shape with it, and so is a skinned sheet: where they are fast, they come as a shape for each part of the frame
//! (`stage/fast_surface.rs`), and each part has as many substeps as the others.

use super::{
    Simulation,
    step::{StepInput, substep_length},
};
use crate::{collide::MovingCollider, math::RigidTransform, strand::tile::state};
use rayon::prelude::*;

/// Part of a body's half thickness that it may move by in a substep [1]: a strand that it presses is still on the side where it was met.
pub const MAX_TRAVEL: f32 = 0.5;

/// The same of a body thinner than [`VERY_THIN`] [1].
const PART_OF_THIN: f32 = 0.25;

/// Half thickness below which a body's steps are as short as that [m]: a segment is several times as long.
const VERY_THIN: f32 = 0.0025;

/// Way in a frame, over the radius of the ball around a body, below which nothing is looked at [1]: what is so slow is not thinner.
const SLOW: f32 = 0.005;

/// Most substeps that a body may ask for: a sheet has no thickness to speak of.
const MOST: f32 = 256.0;

/// The same of a solid: a rod of 0.5 mm radius at 3 m/s asks for 400 in a frame.
const MOST_OF_SOLID: f32 = 1024.0;

/// Half thickness below which a body may be crossed by hair that is fast by itself [m].
const THIN: f32 = 0.02;

impl Simulation {
    /// Substeps that this frame needs so that no body is on the other side of a strand before it meets it; 1 where all are slow or far.
    pub(super) fn substeps_past(&self, drive: &StepInput, carried: Option<&RigidTransform>) -> u32 {
        let mut asked = 1;
        for obstacle in drive.obstacles {
            asked = asked.max(self.substeps_of_hair(drive, carried, obstacle));
            // Against the anchor: hair moves with that.
            let start = self.settings.anchor.inverse().after(&obstacle.start(carried));
            let end = drive.anchor.inverse().after(&obstacle.end);
            let (center, radius) = obstacle.shape.bounds();
            let [a, b] = [start, end].map(|pose| pose.point(center));
            let turn = start.rotation.angle_between(end.rotation);
            let way = a.distance(b) + turn * radius;
            if !way.is_finite() || !radius.is_finite() || way < SLOW * radius {
                continue;
            }
            let half = obstacle.shape.half_thickness();
            let very_thin = obstacle.shape.is_thin(VERY_THIN);
            let (part, most) = if very_thin { (PART_OF_THIN, MOST_OF_SOLID) } else { (MAX_TRAVEL, MOST) };
            let count = (way / (part * half).max(1e-12)).ceil().min(most);
            if count <= 1.0 {
                continue;
            }
            let near = drive.roots.iter().any(|root| {
                let root = drive.anchor.inverse_point(root.translation);
                let along = ((root - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
                root.distance(a.lerp(b, along)) < radius + turn * radius + self.longest
            });
            if near {
                asked = asked.max(count as u32);
            }
        }
        asked
    }

    /// Substeps that the velocity of the hair near a thin body asks for. A body that stops leaves hair that goes on around it as fast as it was.
    fn substeps_of_hair(
        &self,
        drive: &StepInput,
        carried: Option<&RigidTransform>,
        obstacle: &MovingCollider,
    ) -> u32 {
        let shape = &obstacle.shape;
        if !shape.is_thin(THIN) {
            return 1;
        }
        let (start, end) = (obstacle.start(carried), obstacle.end);
        let (center, radius) = shape.bounds();
        let center = start.point(center);
        let part = (MAX_TRAVEL * shape.half_thickness()).max(1e-12);
        let slow = part * drive.dt / substep_length(&self.settings.solver) as f32;
        let way_of_strand = |place: usize| {
            let mut x = self.root_position(place);
            let n = self.simulated_points(place);
            if x.distance(center) > radius + 2.0 * self.longest {
                return 0.0;
            }
            let mut most = 0.0f32;
            for i in 0..n {
                let edge = self.vector(place, i, state::EDGE);
                x += edge;
                let own = start.inverse_point(x);
                // Hair that stands still while the head and the body move off together goes along with them.
                let slip = self.vector(place, i, state::V) * drive.dt + x - end.point(own);
                let with_head = drive.anchor.point(self.settings.anchor.inverse_point(x)) - x;
                let way = slip.length().min((slip + with_head).length());
                if way > most.max(slow) && shape.distance(own) < way + edge.length() {
                    most = way;
                }
            }
            most
        };
        let way = self.places.par_iter().map(|&place| way_of_strand(place as usize)).reduce(|| 0.0, f32::max);
        (way / part).ceil().min(MOST) as u32
    }
}
