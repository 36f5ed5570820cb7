//! Statistics of collider contact: number of points and segments, total force, and number of distance
//! queries.

use super::Simulation;
use crate::collide::MovingCollider;
use crate::parallel::prelude::*;
use crate::{
    collide::ColliderShape,
    math::RigidTransform,
    simd::lanes::LANES,
    strand::tile::{segment_contact, state},
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
    /// Pairs of a point and a collider for which a substep queries the distance: the point is in the
    /// collider's bounds and, for a distance field, in a cell that is not entirely outside.
    pub distance_queries: usize,
}

impl Simulation {
    /// Counts the contacts of all strands with `obstacles`, the colliders of the last step. It reads the state
    /// after the step, so steps whose contacts are not counted cost nothing extra. For the place and the
    /// collider of each contact, see [`Simulation::contact_points`].
    pub fn contacts(&self, obstacles: &[MovingCollider]) -> Contacts {
        let poses: Vec<_> = obstacles.iter().map(|o| (&o.shape, o.end)).collect();
        // Summed in a fixed order, so that the force is bitwise independent of the number of threads.
        let of_strands: Vec<Contacts> =
            self.model.places.par_iter().map(|&place| self.strand_contacts(place as usize, &poses)).collect();
        of_strands.into_iter().fold(Contacts::default(), |a, b| Contacts {
            points: a.points + b.points,
            segments: a.segments + b.segments,
            force: a.force + b.force,
            distance_queries: a.distance_queries + b.distance_queries,
        })
    }

    fn strand_contacts(&self, place: usize, poses: &[(&ColliderShape, RigidTransform)]) -> Contacts {
        let (tile, lane) = (place / LANES, place % LANES);
        let (first, stride) = (self.model.tiles[tile].first as usize, self.model.tiles[tile].model.stride());
        let root = self.root_position(place);
        let mut out = Contacts::default();
        // The first two points are driven by the root.
        for (i, x) in self.particles(place).enumerate().step_by(stride).skip(2) {
            let at = first + i;
            let point = f64::from(self.state.points[at][state::NORMAL_FORCE].0[lane]);
            let segment = self
                .state
                .segment_contacts
                .get(at)
                .map_or(0.0, |rows| f64::from(rows[segment_contact::FORCE].0[lane]));
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
    let local = pose.inverse_point(p);
    local.distance(center) <= radius
        && match shape {
            ColliderShape::Field(grid) => grid.may_be_inside_at(local),
            _ => true,
        }
}
