//! Where on a segment a collider is deepest: its ends may be outside while it cuts a corner, or holds a ball smaller than itself.
//!
//! ```text
//!   d ╲                ╱ d'      d along the segment, and its slope n·e, at two places beside each other:
//!      ╲   least d   ╱           for a convex shape it lies above both tangents, and is least near where they cross
//!       ╲╌╌╌╌╌╌╌╌╌╌╱
//! ```

use super::{ColliderPose, ColliderShape, pose::slope};
use crate::simd::lanes::{F, Mask, Simd, V3};
use glam::Vec3;

/// Places of a segment that are looked at where it is measured, its end among them. Not its beginning, which is the end of the one before or goes
/// with the root.
const PLACES: usize = 8;

impl ColliderShape {
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

impl ColliderPose {
    /// [`ColliderShape::least_distance`] in the world at the end of the substep.
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let own = |p: Vec3| self.end.0.transpose() * (p - self.end.1);
        self.shape.least_distance(own(a), own(b))
    }
}

/// The deepest place that was found between the ends of eight segments.
#[derive(Clone, Copy)]
pub(crate) struct DeepestPoint<S: Simd> {
    /// Which of them have one within the distance that was asked for; of the others nothing is told.
    pub found: Mask<S>,
    /// Distance to the surface, negative inside [m].
    pub distance: F<S>,
    /// The way out, a unit vector across the segment: that in which its least distance grows fastest.
    pub normal: V3<S>,
    /// How much that distance grows for each metre along it, where the segment is across walls that face away from each other, else 1 [1].
    pub gain: F<S>,
    /// Where it is: 0 at the segment's beginning, 1 at its end.
    pub at: F<S>,
}

impl<S: Simd> DeepestPoint<S> {
    /// This, but `other` where `mask` is true.
    #[inline(always)]
    pub fn or(self, mask: Mask<S>, other: Self) -> Self {
        Self {
            found: (self.found & !mask) | (other.found & mask),
            distance: mask.select(other.distance, self.distance),
            normal: V3::select(mask, other.normal, self.normal),
            gain: mask.select(other.gain, self.gain),
            at: mask.select(other.at, self.at),
        }
    }

    /// That none was found.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = F::splat(simd, 0.0);
        let found = Mask::splat(simd, false);
        Self { found, distance: zero, normal: V3::zero(simd), gain: zero, at: zero }
    }

    /// The deepest place `best` of segments along `u`, with a place on its `other` side.
    ///
    /// ```text
    ///   ╲ n₁     n₂ ╱     on both sides of a thin wall or an edge: w n₁ + (1 − w) n₂ with nothing in it along the segment. What is deepest moves
    ///    ╲    │    ╱      along as the segment does, so that the depth is less by that for each metre, out over the wall's rim; along one
    ///     ╲___│___╱       side's normal it would be less here and more beyond
    /// ```
    #[inline(always)]
    fn between(simd: S, found: Mask<S>, u: V3<S>, (best, other): (SdfSample<S>, SdfSample<S>)) -> Self {
        let share = best.slope / (best.slope - other.slope);
        // Walls that face away from each other; where an edge is blunter, the nearer side's normal across the segment is enough. (At a right angle, by
        // rounding, a box would be now one and now the other.)
        let thin = opposite(&best, &other) & best.rise.dot(other.rise).simd_lt(APART);
        let share = thin.select(share, F::splat(simd, 0.0));
        let rise = (other.rise - best.rise).mul_add(share, best.rise);
        let (gain, across) = (rise - u * rise.dot(u)).length_and_unit();
        let steep = gain.simd_lt(STEEP);
        let (straight_gain, straight) = best.rise.length_and_unit();
        Self {
            found,
            distance: best.distance,
            normal: V3::select(steep, straight, across),
            gain: thin.select(steep.select(straight_gain, gain), F::splat(simd, 1.0)),
            at: best.at,
        }
    }
}

/// Least growth of the distance across the segment [1]: where there is less, it comes out end first.
pub(crate) const STEEP: f32 = 0.02;

/// Largest product of the rises of two sides that face away from each other [1].
const APART: f32 = -0.1;

/// Pieces between whose ends a segment is looked at: quarters, and no longer than half a cell of a field where that takes no more than the second [1].
/// Between its nodes a field bends within a cell. Both even, so that the middle is one of the places.
const PIECES: [usize; 2] = [4, 12];

/// How fast a field's distance may change with place [1]: by 1 where it is smooth, and by twice that between two nodes on the two sides of a thin wall,
/// as each is told the way to its own.
const STEEPEST: f32 = 2.0;

/// Which of the segments from `a` to `a + e` (world) have a place between their ends, for a convex shape no nearer to the beginning than the part `from` of them, that is `within` so much of the surface, less than 0 for places
/// inside [m], and where. The middle is looked at and both quarters, more places where a field is finer than that, and then beside
/// the deepest of them where tangents say that it is deeper.
///
/// `None` where the middle says that none has: for a convex shape distance lies above its tangent, and a field within a cell from the middle bends no
/// other way that counts (five in ten thousand cuts are missed for it, none deeper than others); farther off it is nearer by no more than the way there.
#[inline(always)]
pub(crate) fn find_deepest_point<S: Simd>(
    simd: S,
    pose: &ColliderPose,
    (a, e): (V3<S>, V3<S>),
    (from, within): (F<S>, F<S>),
) -> Option<DeepestPoint<S>> {
    if pose.shape.is_convex_formula() {
        return deepest_convex(simd, pose, (a, e), (from, within));
    }
    let splat = |x: f32| F::<S>::splat(simd, x);
    let (l, u) = e.length_and_unit();
    let spacing = match &pose.shape {
        ColliderShape::Field(grid) => 0.5 * grid.cell(),
        _ => f32::INFINITY,
    };
    let [mut pieces, most] = PIECES;
    while pieces < most && l.simd_gt(splat(pieces as f32 * spacing)).any_true() {
        pieces += 2;
    }
    let apart = 1.0 / pieces as f32;
    let mut seen = SampleBracket::nothing(simd);
    let (mut middle, mut last, mut refined) = (seen.best, seen.best, seen.best);
    let mut found = Mask::splat(simd, false);
    // The middle, all from the first on, and what is beside the deepest: in a loop, so that the code that looks is there once.
    for k in 0..=pieces {
        let at = match k {
            0 => splat(0.5),
            _ if k == pieces => beside(simd, &seen, apart),
            _ => splat(k as f32 * apart),
        };
        let here = if 2 * k == pieces {
            middle
        } else {
            let (distance, rise) = slope(simd, pose, e.mul_add(at, a));
            SdfSample { at, distance, rise, slope: rise.dot(e) }
        };
        if k == 0 {
            let nearer = match &pose.shape {
                ColliderShape::Field(_) if pieces > PIECES[0] => l * (0.5 * STEEPEST),
                // What is farther off than the sheet is thick is not told how far.
                ColliderShape::Sheet(_) => splat(f32::INFINITY),
                _ => here.slope.abs() * 0.5,
            };
            found = (here.distance - nearer).simd_lt(within);
            if !found.any_true() {
                return None;
            }
            middle = here;
        } else if k == pieces {
            refined = here;
        } else {
            seen.see(here, last);
            last = here;
        }
    }
    let (best, other) = seen.sides(refined);
    let found = found & best.distance.simd_lt(within);
    Some(DeepestPoint::between(simd, found, u, (best, other)))
}

/// Most places of a segment that are looked at near a convex shape.
const CONVEX_PLACES: usize = 10;

/// Error of the depth at which the search near a convex shape ends, over the segment's length [1].
const CONVEX_ERROR: f32 = 1e-4;

/// The same for a convex shape, to within [`CONVEX_ERROR`]. Along the segment the distance is then a convex function: it lies above its tangents, so that its minimum is
/// in the bracket between a place where it falls and one where it rises, no lower than where their tangents cross. That is the next place (the cutting-plane method
/// of Kelley 1960, in one dimension). A shape that is much thinner than the segment cannot hide between samples.
#[inline(always)]
fn deepest_convex<S: Simd>(
    simd: S,
    pose: &ColliderPose,
    (a, e): (V3<S>, V3<S>),
    (from, within): (F<S>, F<S>),
) -> Option<DeepestPoint<S>> {
    let splat = |x: f32| F::<S>::splat(simd, x);
    let (zero, one) = (splat(0.0), splat(1.0));
    let (l, u) = e.length_and_unit();
    let nothing = SampleBracket::nothing(simd).best;
    let (mut low, mut high) = (nothing, nothing);
    let (mut at, mut found) = (splat(0.5), Mask::splat(simd, false));
    let mut going = found;
    for k in 0..CONVEX_PLACES {
        let (distance, rise) = slope(simd, pose, e.mul_add(at, a));
        let here = SdfSample { at, distance, rise, slope: rise.dot(e) };
        let falls = here.slope.simd_lt(0.0);
        if k == 0 {
            (low, high) = (here, here);
            found = (here.distance - here.slope.abs() * 0.5).simd_lt(within);
            going = found;
            at = falls.select(one, from);
        } else {
            // The second place is the end toward which the middle falls, whatever the slope is there.
            let is_low = if k == 1 { at.simd_eq(from) } else { falls };
            low = SdfSample::select(going & is_low, here, low);
            high = SdfSample::select(going & !is_low, here, high);
            let width = high.at - low.at;
            let [down, up] = [low.slope * width, high.slope * width];
            let cross = (up + low.distance - high.distance) / (up - down).max(1e-30);
            let cross = cross.max(0.0).min(1.0);
            let cross = up.simd_gt(0.0).select(down.simd_lt(0.0).select(cross, zero), one);
            let bound = cross.mul_add(down, low.distance);
            found &= bound.simd_lt(within);
            let error = low.distance.min(high.distance) - bound;
            going &= found & error.simd_gt(l * CONVEX_ERROR);
            at = cross.mul_add(width, low.at);
        }
        if !going.any_true() {
            break;
        }
    }
    let lower = low.distance.simd_lt(high.distance);
    let sides = (SdfSample::select(lower, low, high), SdfSample::select(lower, high, low));
    found &= sides.0.distance.simd_lt(within);
    found.any_true().then(|| DeepestPoint::between(simd, found, u, sides))
}

/// Where the segment may be deeper than at the deepest of the places that were looked at, which are `apart`: between that and the place beside it toward
/// which it falls, where their tangents cross; halfway where that place is not known, or it falls on beyond it.
#[inline(always)]
fn beside<S: Simd>(simd: S, seen: &SampleBracket<S>, apart: f32) -> F<S> {
    let splat = |x: f32| F::<S>::splat(simd, x);
    let best = &seen.best;
    let toward = best.slope.simd_lt(0.0).select(splat(apart), splat(-apart));
    let next = seen.next();
    let (f, f_next) = (best.slope * toward, next.slope * toward);
    let cross = (f_next + best.distance - next.distance) / (f_next - f).max(1e-30);
    let cross = f_next.simd_gt(0.0).select(cross.max(0.0).min(1.0), splat(0.5));
    cross.mul_add(toward, best.at)
}

/// The deepest place that was seen on eight segments, and the places before and after it, where those were looked at.
struct SampleBracket<S: Simd> {
    before: SdfSample<S>,
    best: SdfSample<S>,
    after: SdfSample<S>,
}

impl<S: Simd> SampleBracket<S> {
    #[inline(always)]
    fn nothing(simd: S) -> Self {
        let [at, distance, slope] = [-1.0, f32::MAX, 0.0].map(|x| F::splat(simd, x));
        let nothing = SdfSample { at, distance, rise: V3::zero(simd), slope };
        Self { before: nothing, best: nothing, after: nothing }
    }

    /// Takes up the place after `last`.
    #[inline(always)]
    fn see(&mut self, here: SdfSample<S>, last: SdfSample<S>) {
        self.after = SdfSample::select(self.best.at.simd_eq(last.at), here, self.after);
        let nearer = here.distance.simd_lt(self.best.distance);
        self.before = SdfSample::select(nearer, last, self.before);
        self.best = SdfSample::select(nearer, here, self.best);
        // Until the next place is seen.
        self.after = SdfSample::select(nearer, Self::nothing(here.at.simd).after, self.after);
    }

    /// The place beside the deepest toward which that falls.
    #[inline(always)]
    fn next(&self) -> SdfSample<S> {
        SdfSample::select(self.best.slope.simd_lt(0.0), self.after, self.before)
    }

    /// The deepest place, with what was seen in a place `refined` between the deepest and the next, and the place on the other side of it.
    #[inline(always)]
    fn sides(&self, refined: SdfSample<S>) -> (SdfSample<S>, SdfSample<S>) {
        let deeper = refined.distance.simd_lt(self.best.distance);
        let best = SdfSample::select(deeper, refined, self.best);
        // The two sides of a place between are that which it falls from and that which it falls to.
        let beyond = SdfSample::select(opposite(&self.best, &refined), self.best, self.next());
        (best, SdfSample::select(deeper, beyond, refined))
    }
}

/// Whether the distance falls at one of the places and rises at the other.
#[inline(always)]
fn opposite<S: Simd>(a: &SdfSample<S>, b: &SdfSample<S>) -> Mask<S> {
    (a.slope * b.slope).simd_lt(0.0)
}

/// What is seen at a place of eight segments.
#[derive(Clone, Copy)]
struct SdfSample<S: Simd> {
    /// The place: 0 at the segment's beginning, 1 at its end.
    at: F<S>,
    distance: F<S>,
    /// How fast the distance changes with place [1].
    rise: V3<S>,
    /// By how much the distance grows along the whole segment, by its tangent there [m].
    slope: F<S>,
}

impl<S: Simd> SdfSample<S> {
    #[inline(always)]
    fn select(mask: Mask<S>, a: Self, b: Self) -> Self {
        Self {
            at: mask.select(a.at, b.at),
            distance: mask.select(a.distance, b.distance),
            rise: V3::select(mask, a.rise, b.rise),
            slope: mask.select(a.slope, b.slope),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        collide::{sdf::tests::balls, voxelize},
        simd::dispatch::dispatch,
    };
    use fearless_simd::Level;
    use glam::{Mat3, Quat};
    use std::sync::Arc;

    const CELL: f32 = 0.005;

    /// Three numbers from 0 to 1 by chance (SplitMix64; Steele, Lea & Flood 2014).
    fn vector(bits: &mut u64) -> Vec3 {
        let mut next = || {
            *bits = bits.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (*bits ^ (*bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
        };
        Vec3::new(next(), next(), next())
    }

    /// Boxes that run through each other, turned, some of them thinner than a cell and a half.
    fn boxes(bits: &mut u64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for first in (0..12).map(|k| 8 * k) {
            let [middle, size, turn] = [(); 3].map(|()| vector(bits));
            let turn = Quat::from_scaled_axis((turn - 0.5) * 6.0);
            let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) - 0.5;
            positions.extend(
                (0..8).map(|k| (10.0 * middle + turn * (corner(k) * (1.0 + 5.0 * size * size))) * CELL),
            );
            let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
            let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(|i| i + first));
            triangles.extend(quads.into_iter().flat_map(halves));
        }
        (positions, triangles)
    }

    /// The few looks find what looks all along find, but for what only grazes: bodies that are round, and walls, ridges and creases of every angle.
    #[test]
    fn what_cuts_between_two_ends_that_are_outside_is_found() {
        let (mut cuts, mut missed, mut worst) = (0, 0, [0f32; 2]);
        for seed in 0..24u32 {
            let mut bits = u64::from(seed);
            let (positions, triangles) = if seed % 2 == 0 { balls(seed, true) } else { boxes(&mut bits) };
            let grid = voxelize(&positions, &triangles, CELL);
            let (still, top) = ((Mat3::IDENTITY, Vec3::ZERO), (grid.size() - 1).as_vec3() * CELL);
            let pose = ColliderPose::new(ColliderShape::Field(Arc::new(grid.clone())), still, still, 1.0);
            for turn in 0..100_000 {
                let [at, way, far] = [(); 3].map(|()| vector(&mut bits));
                let p = grid.origin() + at * top;
                let (distance, normal) = grid.distance_and_normal(p);
                // The middle from a little inside to a cell outside, up to two cells from end to end; or another place, up to five.
                let place = p - normal * (distance - CELL * (far.x * far.x - 0.05));
                let (longest, part) = if turn % 2 == 0 { (2.0, 0.5) } else { (5.0, far.z) };
                let e = (way - 0.5).normalize_or(Vec3::X) * (CELL * (0.5 + (longest - 0.5) * far.y));
                let (a, b) = (place - e * part, place + e * (1.0 - part));
                if pose.distance(a) < 0.0 || pose.distance(b) < 0.0 {
                    continue;
                }
                let clear = -0.015 * a.distance(b);
                let least = (1..64).map(|k| pose.distance(a.lerp(b, k as f32 / 64.0))).fold(0.0, f32::min);
                if least >= clear {
                    continue;
                }
                let found = dispatch!(Level::new(), simd => {
                    let (a, b) = (V3::splat(simd, a), V3::splat(simd, b));
                    let clear = F::splat(simd, clear);
                    pose.segment_may_intersect(simd, (b, b - a), -clear).any_true()
                        && find_deepest_point(simd, &pose, (a, b - a), (F::splat(simd, 0.0), clear)).is_some_and(|place| place.found.any_true())
                });
                cuts += 1;
                if !found {
                    missed += 1;
                    worst[turn % 2] = worst[turn % 2].max(clear - least);
                }
            }
        }
        let [middle, any] = worst.map(|depth| depth / CELL);
        println!(
            "{missed} of {cuts} cuts are missed, at most {middle:.3} of a cell deep in the middle and {any:.3} elsewhere"
        );
        // As with all four looks at each: what they pass over only grazes.
        assert!(cuts > 1000 && middle < 0.05 && any < 0.06, "of {cuts}: {middle} and {any} of a cell");
    }
}
