//! Statistics of collider contact: number of points and segments, total force, and number of distance
//! queries.

use super::Simulation;
use crate::parallel::prelude::*;
use crate::{
    collide::{ColliderShape, MovingCollider},
    math::RigidTransform,
};
use glam::Vec3;

/// Contacts with colliders at the end of the last substep.
///
/// For an example, see [`Simulation::contact_points`], which lists them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Contacts {
    /// Points in contact with a collider.
    pub points: usize,
    /// Segments in contact with a collider between their ends.
    pub segments: usize,
    /// Sum of the normal forces of both [N].
    pub force: f64,
    /// Number of point-collider pairs that pass the broad phase.
    pub distance_queries: usize,
}

impl Simulation {
    /// Counts the contacts of all strands with `colliders`, the colliders of the last step. It reads the state
    /// after the step, so steps whose contacts are not counted cost nothing extra. For the place and the
    /// collider of each contact, see [`Simulation::contact_points`].
    pub fn contacts(&self, colliders: &[MovingCollider]) -> Contacts {
        let poses: Vec<_> = colliders.iter().map(|o| (&o.shape, o.end)).collect();
        // Summed in a fixed order, so that the force is bitwise independent of the number of threads.
        let of_strands: Vec<Contacts> = self
            .model
            .lane_of_strand
            .par_iter()
            .map(|&place| self.collider_contacts(place as usize, &poses))
            .collect();
        of_strands.into_iter().fold(Contacts::default(), |a, b| Contacts {
            points: a.points + b.points,
            segments: a.segments + b.segments,
            force: a.force + b.force,
            distance_queries: a.distance_queries + b.distance_queries,
        })
    }

    /// Counts the contacts of one strand with colliders.
    fn collider_contacts(&self, place: usize, poses: &[(&ColliderShape, RigidTransform)]) -> Contacts {
        let strand = self.strand(place);
        let root = strand.root();
        let mut out = Contacts::default();
        // The first two points are driven by the root.
        for (i, x) in strand.particles().enumerate().step_by(strand.stride()).skip(2) {
            let point = f64::from(strand.normal_force(i));
            let segment = f64::from(strand.segment_contact(i).1);
            out.points += usize::from(point > 0.0);
            out.segments += usize::from(segment > 0.0);
            out.force += point.max(0.0) + segment.max(0.0);
            out.distance_queries +=
                poses.iter().filter(|(shape, pose)| may_touch(shape, pose, root + x)).count();
        }
        out
    }
}

/// Returns whether a substep queries the distance of the world position `p` from a shape.
fn may_touch(shape: &ColliderShape, pose: &RigidTransform, p: Vec3) -> bool {
    let (center, radius) = shape.bounds();
    let local = pose.inverse_transform_point(p);
    local.distance(center) <= radius
        && match shape {
            ColliderShape::Field(grid) => grid.may_be_inside_at(local),
            _ => true,
        }
}
