//! Quality measures of a simulation: stretch, depth inside colliders, non-finite values.

use super::Simulation;
use crate::parallel::prelude::*;
use crate::{collide::MovingCollider, math::RigidTransform};
use glam::Vec3;

/// Depth from which a point or segment counts as inside [m].
const INSIDE: f64 = 1e-6;

/// Length of hair beneath the skin that belongs to its root, over the depth of the root [1]. Hair that leaves
/// the skin at 20° or more is out after that length.
const WITH_ROOT: f32 = 3.0;

/// Measures over all simulated points at the end of a step.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Measure {
    /// Mean of |ℓ/L − 1| over segments [1].
    pub stretch_mean: f64,
    /// Largest |ℓ/L − 1| [1].
    pub stretch_max: f64,
    /// Points that are inside a collider, by more than a micrometer. Those beneath the skin together with their
    /// root count only if they are deeper than authored.
    pub inside_points: usize,
    /// Depth of the deepest of these points below its authored depth [m].
    pub max_depth: f64,
    /// Points of these that are no deeper than they were authored, or were authored more than 5 mm inside a mesh.
    pub started_inside_points: usize,
    /// Depth of the deepest of those [m].
    pub started_inside_depth: f64,
    /// Strands with such a point.
    pub started_inside_strands: usize,
    /// Segments more than 1 µm deeper inside a collider than they were authored. Eight positions along the segment
    /// are tested.
    pub inside_segments: usize,
    /// Segments of these that are more than a millimeter deeper.
    pub deep_segments: usize,
    /// Depth of the deepest of these segments [m].
    pub segment_depth: f64,
    /// Depth of the deepest segment below the exact surface of a collider [m]: for a distance field, in the
    /// mesh that it was made from. The other depths are those that the solver sees. At sharp edges they differ
    /// by up to a third of the field's cell. Segments that were authored inside are left out.
    pub surface_depth: f64,
    /// Segments whose driven first point is inside a collider. The strand cannot move them out. Only depth beyond
    /// that of the first point counts as penetration.
    pub held_segments: usize,
    /// Depth of the deepest of these segments [m].
    pub held_depth: f64,
    /// Number of state values that are NaN or infinite.
    pub non_finite: usize,
    /// Speed of the fastest point [m/s].
    pub speed_max: f64,
}

impl Simulation {
    /// Measures the state against the colliders at the end of their frame, in the order of the steps.
    pub fn measure(&self, colliders: &[MovingCollider]) -> Measure {
        let poses: Vec<_> = colliders.iter().map(|o| (o, o.end)).collect();
        let (sum, segments, figures) = self
            .model
            .lane_of_strand
            .par_iter()
            .map(|&place| self.measure_strand(place as usize, &poses))
            .reduce(
                || (0.0, 0, Measure::default()),
                |(s1, n1, a), (s2, n2, b)| {
                    let merged = Measure {
                        stretch_mean: 0.0,
                        stretch_max: a.stretch_max.max(b.stretch_max),
                        inside_points: a.inside_points + b.inside_points,
                        max_depth: a.max_depth.max(b.max_depth),
                        started_inside_points: a.started_inside_points + b.started_inside_points,
                        started_inside_depth: a.started_inside_depth.max(b.started_inside_depth),
                        started_inside_strands: a.started_inside_strands + b.started_inside_strands,
                        inside_segments: a.inside_segments + b.inside_segments,
                        deep_segments: a.deep_segments + b.deep_segments,
                        segment_depth: a.segment_depth.max(b.segment_depth),
                        surface_depth: a.surface_depth.max(b.surface_depth),
                        held_segments: a.held_segments + b.held_segments,
                        held_depth: a.held_depth.max(b.held_depth),
                        non_finite: a.non_finite + b.non_finite,
                        speed_max: a.speed_max.max(b.speed_max),
                    };
                    (s1 + s2, n1 + n2, merged)
                },
            );
        Measure { stretch_mean: sum / segments.max(1) as f64, ..figures }
    }

    fn measure_strand(
        &self,
        place: usize,
        poses: &[(&MovingCollider, RigidTransform)],
    ) -> (f64, usize, Measure) {
        let mut out = Measure::default();
        let (mut sum, mut segments) = (0.0, 0);
        let strand = self.strand(place);
        let (root, n, stride) = (strand.root(), strand.particle_count(), strand.stride());
        let mut before = Vec3::ZERO;
        let mut beneath_skin = WITH_ROOT * -strand.clearance(0);
        for (i, x) in strand.particles().enumerate() {
            let v = strand.velocity(i);
            out.non_finite += x.to_array().iter().chain(&v.to_array()).filter(|c| !c.is_finite()).count();
            out.speed_max = out.speed_max.max(v.length() as f64);
            // Only segments that are drawn, without a model's extra particles.
            if i % stride == 0 && i + stride < n {
                let length = f64::from(strand.rest_length(i));
                let strain = (strand.between(i, i + stride).length() / length - 1.0).abs();
                sum += strain;
                segments += 1;
                out.stretch_max = out.stretch_max.max(strain);
            }
            if i % stride == 0 && i >= 2 * stride {
                let clearance = strand.clearance(i);
                let depth = near(poses, root + x, clearance)
                    .filter(|(k, ..)| !strand.passes(i, *k))
                    .map(|(_, o, pose)| clearance - o.shape.distance(pose.inverse_transform_point(root + x)))
                    .fold(0.0, f32::max) as f64;
                out.max_depth = out.max_depth.max(depth);
                out.inside_points += (depth > INSIDE) as usize;
                if beneath_skin <= 0.0 && f64::from(-clearance) > INSIDE && depth <= INSIDE {
                    out.count_started_inside(poses, root + x);
                }
                let authored = strand.rest_penetration(i);
                let [a, b] = [root + before, root + x];
                let begins_held = i == 2 * stride;
                let (mut depth, mut held) = (0f64, 0f64);
                for (k, o, pose) in near(poses, a.midpoint(b), authored + 0.5 * a.distance(b)) {
                    if strand.passes(i, k) || strand.passes(i - stride, k) {
                        continue;
                    }
                    let [a, b] = [a, b].map(|p| pose.inverse_transform_point(p));
                    let least = o.shape.least_distance(a, b);
                    let begins = if begins_held { o.shape.distance(a).min(authored) } else { authored };
                    depth = depth.max(f64::from(begins - least));
                    if begins >= 0.0 {
                        let exact = -o.shape.least_distance_to_surface(a, b);
                        out.surface_depth = out.surface_depth.max(f64::from(exact));
                    }
                    held = held.max(f64::from(authored - least.max(begins)));
                }
                out.segment_depth = out.segment_depth.max(depth);
                out.inside_segments += (depth > INSIDE) as usize;
                out.deep_segments += (depth > 1e-3) as usize;
                if held > 1e-3 && depth <= 1e-3 {
                    out.held_segments += 1;
                    out.held_depth = out.held_depth.max(held);
                }
            }
            if i % stride == 0 {
                before = x;
                let outside = strand.clearance(i) >= 0.0;
                let length = if i + stride < n { strand.rest_length(i) } else { 0.0 };
                beneath_skin = if outside { 0.0 } else { beneath_skin - length };
            }
        }
        out.started_inside_strands = usize::from(out.started_inside_points > 0);
        (sum, segments, out)
    }
}

impl Measure {
    /// Returns the depth of the deepest of `inside_points` [m], whether it started inside or not.
    pub fn depth_inside(&self) -> f64 {
        self.max_depth.max(self.started_inside_depth)
    }

    /// Counts the point `p` [m], which was authored inside a collider, if it is inside one.
    fn count_started_inside(&mut self, poses: &[(&MovingCollider, RigidTransform)], p: Vec3) {
        let depth =
            near(poses, p, 0.0).map(|(_, o, pose)| -o.shape.distance(pose.inverse_transform_point(p)));
        let depth = f64::from(depth.fold(0.0, f32::max));
        if depth > INSIDE {
            self.inside_points += 1;
            self.started_inside_points += 1;
            self.started_inside_depth = self.started_inside_depth.max(depth);
        }
    }
}

/// Returns the colliders that may be nearer to `p` than `reach` [m], by their bounding spheres: index, collider and pose.
fn near<'a>(
    poses: &'a [(&MovingCollider, RigidTransform)],
    p: Vec3,
    reach: f32,
) -> impl Iterator<Item = (usize, &'a MovingCollider, RigidTransform)> {
    let all = poses.iter().enumerate().map(|(k, (o, pose))| (k, *o, *pose));
    all.filter(move |(_, o, pose)| {
        let (center, radius) = o.shape.bounds();
        // A margin for the rounding of the sphere.
        pose.transform_point(center).distance(p) <= 1.0001 * (radius + reach.max(0.0))
    })
}
