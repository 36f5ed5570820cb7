//! Where on a segment a collider is deepest: its ends may be outside while it cuts a corner, or holds a ball smaller than itself.
//!
//! ```text
//!   d_a ╲                ╱ d_b      d along the segment, with its slope n·e at both ends: for a convex shape it
//!        ╲   least d   ╱            lies above both tangents, and is least near the place where they cross
//!         ╲╌╌╌╌╌╌╌╌╌╌╱
//! ```

use super::{Obstacle, ObstaclePose, contact_at};
use crate::strand::lanes::{F, V3};
use fearless_simd::{mask32x8, prelude::*};
use glam::{Mat3, Vec3};

/// Places of a segment that are looked at one after the other where it is measured, its end among them.
const PLACES: usize = 8;

impl Obstacle {
    /// The least distance on the way from `a` to `b` [m] in the collider's own space, of the eight places at each eighth of it; negative
    /// inside. Where that is far from negative, of its middle alone.
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let middle = self.distance(a.midpoint(b));
        // A field's gradient is not quite of length 1: twice what could be nearer than the middle.
        if middle > a.distance(b) {
            return middle;
        }
        let places = (1..=PLACES).map(|k| a.lerp(b, k as f32 / PLACES as f32));
        places.map(|p| self.distance(p)).fold(middle, f32::min)
    }
}

/// Sine of the angle between segment and normal below which the segment comes out end first [1].
const STEEP: f32 = 0.1;

/// The deepest place that was found on a segment.
pub(crate) struct Deepest<S: Simd> {
    /// Distance to the surface there, negative inside [m].
    pub distance: F<S>,
    /// Unit normal of the segment there, outward: that of the surface without what is along the segment. On an edge the surface's jumps between
    /// two faces, this one does not.
    pub normal: V3<S>,
    /// Where it is: 0 at the segment's beginning, 1 at its end.
    pub at: F<S>,
}

/// Distance and normal at both ends of a segment.
pub(crate) type Ends<S> = [(F<S>, V3<S>); 2];

/// Which of the segments `e` may be nearer to the surface than `clear` at some place, by what is known of their ends: above the tangents of
/// a convex shape; elsewhere distance falls by no more than one goes.
#[inline(always)]
pub(crate) fn may_cut<S: Simd>(pose: &ObstaclePose, e: V3<S>, ends: &Ends<S>, clear: F<S>) -> mask32x8<S> {
    let [(d_a, n_a), (d_b, n_b)] = *ends;
    let least = if pose.shape.is_convex() {
        let (f_a, f_b) = (n_a.dot(e), n_b.dot(e));
        let at = crossing((d_a, f_a), (d_b, f_b)).max(0.0).min(1.0);
        let dips = f_a.simd_lt(0.0) & f_b.simd_gt(0.0);
        dips.select(f_a.mul_add(at, d_a), d_a.min(d_b))
    } else {
        (d_a + d_b - e.length_and_unit().0) * 0.5
    };
    least.simd_lt(clear)
}

/// The deepest place of two on the segments from `a` to `a + e` (world): where the tangents at the ends cross, and then those of that place and the end that it falls toward; their middle where they do not.
#[inline(always)]
pub(crate) fn deepest<S: Simd>(
    simd: S,
    pose: &ObstaclePose,
    at: &(Mat3, Vec3),
    (a, e): (V3<S>, V3<S>),
    ends: &Ends<S>,
) -> Deepest<S> {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let look = |s: F<S>| {
        let (distance, normal) = contact_at(simd, pose, at, e.mul_add(s, a));
        Deepest { distance, normal, at: s }
    };
    let between = |(s0, d0, f0): (F<S>, F<S>, F<S>), (s1, d1, f1): (F<S>, F<S>, F<S>)| {
        let size = s1 - s0;
        let cross = crossing((d0, f0 * size), (d1, f1 * size)).max(0.0).min(1.0);
        let dips = f0.simd_lt(0.0) & f1.simd_gt(0.0);
        size.mul_add(dips.select(cross, F::splat(simd, 0.5)), s0)
    };
    let [(d_a, n_a), (d_b, n_b)] = *ends;
    let (begin, end) = ((zero, d_a, n_a.dot(e)), (one, d_b, n_b.dot(e)));
    let first = look(between(begin, end));
    let slope = first.normal.dot(e);
    let (here, falls) = ((first.at, first.distance, slope), slope.simd_lt(0.0));
    let second = look(falls.select(between(here, end), between(begin, here)));
    let deeper = second.distance.simd_lt(first.distance);
    let normal = V3::select(deeper, second.normal, first.normal);
    let (_, u) = e.length_and_unit();
    let across = normal - u * normal.dot(u);
    let steep = across.dot(across).simd_lt(STEEP * STEEP);
    Deepest {
        distance: second.distance.min(first.distance),
        normal: V3::select(steep, normal, across.length_and_unit().1),
        at: deeper.select(second.at, first.at),
    }
}

/// Where the lines cross that begin at 0 and end at 1, each with a value there and a slope; anywhere where they do not.
#[inline(always)]
fn crossing<S: Simd>((d0, f0): (F<S>, F<S>), (d1, f1): (F<S>, F<S>)) -> F<S> {
    (f1 + d0 - d1) / (f1 - f0).max(1e-30)
}
