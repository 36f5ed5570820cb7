//! Where on a segment a collider is deepest: its ends may be outside while it cuts a corner, or holds a ball smaller than itself.
//!
//! ```text
//!   d ╲                ╱ d'      d along the segment, and its slope n·e, at two places beside each other:
//!      ╲   least d   ╱           for a convex shape it lies above both tangents, and is least near where they cross
//!       ╲╌╌╌╌╌╌╌╌╌╌╱
//! ```

use super::{Obstacle, ObstaclePose, contact};
use crate::strand::lanes::{F, V3};
use fearless_simd::{mask32x8, prelude::*};
use glam::Vec3;

/// Places of a segment that are looked at where it is measured, its end among them. Not its beginning, which is the end of the one before or goes
/// with the root.
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

impl ObstaclePose {
    /// The same in the world at the end of the substep.
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let own = |p: Vec3| self.end.0.transpose() * (p - self.end.1);
        self.shape.least_distance(own(a), own(b))
    }
}

/// The deepest place that was found between the ends of eight segments.
pub(crate) struct Deepest<S: Simd> {
    /// Which of them have one within the distance that was asked for; of the others nothing is told.
    pub found: mask32x8<S>,
    /// Distance to the surface, negative inside [m].
    pub distance: F<S>,
    /// Unit normal of the segment there, outward: that of the surface without what is along the segment. On an edge the surface's jumps between
    /// two faces, this one does not.
    pub normal: V3<S>,
    /// Where it is: 0 at the segment's beginning, 1 at its end.
    pub at: F<S>,
}

/// Least cosine between the segment's normal and the surface's: what is steeper comes out end first.
pub(crate) const STEEP: f32 = 0.02;

/// How much nearer to a field a segment may come than its middle and its tangent there say, over by how much it is longer than a cell [1].
const BUMP: f32 = 0.1;

/// Which of the segments from `a` to `a + e` (world) have a place between their ends that is `within` so much of the surface, less than 0 for places
/// inside [m], and where. The middle is looked at and both quarters, and then beside the deepest of them where tangents say that it is deeper.
///
/// `None` where the middle says that none has: for a convex shape distance lies above its tangent; others are looked at more closely.
#[inline(always)]
pub(crate) fn deepest<S: Simd>(
    simd: S,
    pose: &ObstaclePose,
    (a, e): (V3<S>, V3<S>),
    within: F<S>,
) -> Option<Deepest<S>> {
    let splat = |x: f32| F::<S>::splat(simd, x);
    let (l, u) = e.length_and_unit();
    let nothing = Look { at: splat(0.0), distance: splat(0.0), normal: V3::zero(simd), slope: splat(0.0) };
    // The first quarter, the middle and the last; the deepest of them and of what is beside it.
    let (mut seen, mut best, mut found) = ([nothing; 3], nothing, mask32x8::splat(simd, false));
    // In a loop, so that the code that looks is there once.
    for k in 0..4 {
        let at = match k {
            0 => splat(0.5),
            1 => splat(0.25),
            2 => splat(0.75),
            _ => beside(simd, &seen, &best),
        };
        let (distance, normal) = contact(simd, pose, e.mul_add(at, a));
        let here = Look { at, distance, normal, slope: normal.dot(e) };
        if k == 0 {
            let bump = match &pose.shape {
                Obstacle::Field(grid) => (l - grid.cell).max(0.0) * BUMP,
                // What is farther off than the sheet is thick is not told how far.
                Obstacle::Sheet(_) => splat(f32::INFINITY),
                _ => splat(0.0),
            };
            found = (distance - bump.max(here.slope.abs() * 0.5)).simd_lt(within);
            if !found.any_true() {
                return None;
            }
            (seen, best) = ([here; 3], here);
        } else {
            if k < 3 {
                seen[2 * (k - 1)] = here;
            }
            best = here.nearer(best);
        }
    }
    let (slope, across) = (best.normal - u * best.normal.dot(u)).length_and_unit();
    let steep = slope.simd_lt(STEEP);
    Some(Deepest {
        found: found & best.distance.simd_lt(within),
        distance: best.distance,
        normal: V3::select(steep, best.normal, across),
        at: best.at,
    })
}

/// Where the segment may be deeper than at `best`, the deepest of three places: between that and the place beside it toward which it falls, where their
/// tangents cross; halfway where that place is not known, or it falls on beyond it.
#[inline(always)]
fn beside<S: Simd>(simd: S, seen: &[Look<S>; 3], best: &Look<S>) -> F<S> {
    let splat = |x: f32| F::<S>::splat(simd, x);
    let toward = best.slope.simd_lt(0.0).select(splat(0.25), splat(-0.25));
    let next = Look::select(toward.simd_gt(0.0), seen[2], seen[0]);
    let next = Look::select(best.at.simd_eq(0.5), next, seen[1]);
    let (f, f_next) = (best.slope * toward, next.slope * toward);
    let known = (best.at + toward - next.at).abs().simd_lt(0.1) & f_next.simd_gt(0.0);
    let cross = (f_next + best.distance - next.distance) / (f_next - f).max(1e-30);
    known.select(cross.max(0.0).min(1.0), splat(0.5)).mul_add(toward, best.at)
}

/// What is seen at a place of eight segments.
#[derive(Clone, Copy)]
struct Look<S: Simd> {
    /// The place: 0 at the segment's beginning, 1 at its end.
    at: F<S>,
    distance: F<S>,
    normal: V3<S>,
    /// By how much the distance grows along the whole segment, by its tangent there [m].
    slope: F<S>,
}

impl<S: Simd> Look<S> {
    #[inline(always)]
    fn select(mask: mask32x8<S>, a: Self, b: Self) -> Self {
        Self {
            at: mask.select(a.at, b.at),
            distance: mask.select(a.distance, b.distance),
            normal: V3::select(mask, a.normal, b.normal),
            slope: mask.select(a.slope, b.slope),
        }
    }

    /// Of the two, what is nearer to the surface.
    #[inline(always)]
    fn nearer(self, other: Self) -> Self {
        Self::select(self.distance.simd_lt(other.distance), self, other)
    }
}
