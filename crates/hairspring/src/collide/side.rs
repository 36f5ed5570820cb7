//! Keeps a segment on its side of a thin rod or box, however far it moves in a substep.
//!
//! ```text
//!    before   │          n is normal to the segment and to an edge of the shape, and points to the side where the
//!         ◯   │ →n       segment was at the start of the substep. The signed distance along n keeps its sign when the
//!    after │             segment is pulled through, while the distance to the shape itself is positive again there.
//!          │  ◯
//! ```
//!
//! A capsule has one edge, its axis; a box has edges along three axes. This is the separating-axis test of
//! two edges (Gottschalk, Lin & Manocha 1996, *OBBTree*), with the axis and its direction fixed at the start
//! of the substep.

use super::{ColliderShape, DeepestPoint, STEEP};
use crate::simd::lanes::{F, Mask, Simd, V3, transform};
use glam::{Mat3, Vec3};

/// How far outside the segment, relative to its length, the point facing an edge may be at the start of the
/// substep [1].
const BESIDE: f32 = 0.5;

/// Minimum cosine between the normals at the start and the end of a substep [1]. A segment that rotates more
/// has no side.
const TURNED: f32 = 0.5;

/// A capsule or box, represented as a box with rounded edges centered at the origin of its own space.
#[derive(Clone)]
pub(crate) struct Edges {
    half: Vec3,
    radius: f32,
    /// Number of axes along which there are edges.
    axes: usize,
    /// Pose of its own space at the start and at the end of the substep.
    start: (Mat3, Vec3),
    end: (Mat3, Vec3),
}

/// The side of an edge that each of eight segments is on.
pub(crate) struct Side<S: Simd> {
    /// Which segments have a side.
    pub known: Mask<S>,
    /// Direction of the edge and the unit normal toward the segment, in the shape's own space.
    axis: V3<S>,
    normal: V3<S>,
}

impl Edges {
    /// Creates the edges of a shape that moves from `start` to `end`. Returns `None` unless it is a capsule
    /// or a box.
    pub fn new(shape: &ColliderShape, start: (Mat3, Vec3), end: (Mat3, Vec3)) -> Option<Self> {
        let (center, turn, half, radius, axes) = match *shape {
            ColliderShape::Capsule { a, b, radius } => {
                let x = (b - a).normalize_or(Vec3::X);
                let (y, z) = x.any_orthonormal_pair();
                (a.midpoint(b), Mat3::from_cols(x, y, z), Vec3::X * (0.5 * a.distance(b)), radius, 1)
            }
            ColliderShape::Cuboid { center, half, axes } => (center, axes, half, 0.0, 3),
            _ => return None,
        };
        let own = |pose: (Mat3, Vec3)| (pose.0 * turn, pose.0 * center + pose.1);
        Some(Self { half, radius, axes, start: own(start), end: own(end) })
    }

    /// Returns whether the shape is a capsule thinner than `radius` [m].
    pub fn is_rod_within<S: Simd>(&self, radius: F<S>) -> Mask<S> {
        let rod = if self.axes == 1 { self.radius } else { f32::INFINITY };
        radius.simd_gt(rod)
    }

    /// Returns whether the shape is a box.
    pub fn is_box(&self) -> bool {
        self.axes == 3
    }

    /// Returns half of the shape's thickness [m].
    pub fn half_thickness(&self) -> f32 {
        if self.axes == 1 { self.radius } else { self.half.min_element() }
    }

    /// Returns the sides of the segments from `a` to `a + e` (world) at the start of the substep. A segment
    /// deeper than `deep` [m] has no side.
    #[inline(always)]
    pub fn side<S: Simd>(&self, simd: S, segment: (V3<S>, V3<S>), deep: F<S>) -> Side<S> {
        self.side_in(simd, own(simd, &self.start, segment), deep)
    }

    /// Returns which segments from `a` to `a + e` (world) passed through the middle of a box at the start of the substep, more
    /// than its thickness away from its rim. A correction would have to take them around the rim.
    ///
    /// ```text
    ///           ◯───╲
    ///     rim ┃──────╲──────┃ rim      the box, and a segment through it
    ///                 ╲───◯
    /// ```
    #[inline(always)]
    pub fn pierced_by<S: Simd>(&self, simd: S, segment: (V3<S>, V3<S>)) -> Mask<S> {
        let (a, e) = own(simd, &self.start, segment);
        let (a, e) = ([a.x, a.y, a.z], [e.x, e.y, e.z]);
        let thin = (0..3).fold(0, |k, j| if self.half[j] < self.half[k] { j } else { k });
        let before = a[thin];
        let mut pierced = (before * (before + e[thin])).simd_lt(0.0);
        for j in (0..3).filter(|&j| j != thin) {
            let place = a[j] - e[j] * (before / e[thin]);
            pierced &= place.abs().simd_lt(self.half[j] - 2.0 * self.half[thin]);
        }
        pierced
    }

    /// Returns the nearest edge of the segments from `a` to `a + e` (world) at the end of the substep,
    /// whichever side they started on.
    #[inline(always)]
    pub fn nearest<S: Simd>(&self, simd: S, segment: (V3<S>, V3<S>)) -> DeepestPoint<S> {
        let any = F::splat(simd, f32::MAX);
        let side = self.side_in(simd, own(simd, &self.end, segment), any);
        self.past(simd, &side, segment, (F::splat(simd, 0.0), any))
    }

    /// Returns the sides of segments in the shape's own space.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn side_in<S: Simd>(&self, simd: S, (a, e): (V3<S>, V3<S>), deep: F<S>) -> Side<S> {
        let least = e.dot(e).sqrt() * STEEP;
        let mut widest = -deep;
        let (mut axis, mut normal) = (V3::zero(simd), V3::zero(simd));
        let mut known = Mask::splat(simd, false);
        for edge in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().take(self.axes) {
            let edge = V3::splat(simd, edge);
            let (size, across) = e.cross(edge).length_and_unit();
            let along = across.dot(a);
            let across = V3::select(along.simd_lt(0.0), -across, across);
            let gap = along.abs() - self.reach(across);
            let at = self.facing((a, e), edge, across);
            let faces = at.simd_ge(-BESIDE) & at.simd_le(1.0 + BESIDE);
            let better = faces & size.simd_gt(least) & gap.simd_ge(widest);
            widest = better.select(gap, widest);
            axis = V3::select(better, edge, axis);
            normal = V3::select(better, across, normal);
            known |= better;
        }
        Side { known, axis, normal }
    }

    /// Finds the segments from `a` to `a + e` (world) that, at the end of the substep, have passed their edge
    /// coming from `side`, or are nearer to it than `within` [m].
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn past<S: Simd>(
        &self,
        simd: S,
        side: &Side<S>,
        (a, e): (V3<S>, V3<S>),
        (from, within): (F<S>, F<S>),
    ) -> DeepestPoint<S> {
        let (a, e) = own(simd, &self.end, (a, e));
        let (size, across) = e.cross(side.axis).length_and_unit();
        let turned = across.dot(side.normal);
        let normal = V3::select(turned.simd_lt(0.0), -across, across);
        let at = self.facing((a, e), side.axis, normal);
        let distance = normal.dot(a) - self.reach(normal);
        let half = V3::splat(simd, self.half).dot(side.axis);
        let on_edge = e.mul_add(at, a).dot(side.axis).abs().simd_le(half);
        let faces = at.simd_ge(from) & at.simd_le(1.0) & on_edge;
        let clear = size.simd_gt(e.dot(e).sqrt() * STEEP) & turned.abs().simd_gt(TURNED);
        DeepestPoint {
            found: side.known & faces & clear & distance.simd_lt(within),
            distance,
            normal: transform(simd, &self.end.0, normal),
            gain: F::splat(simd, 1.0),
            at,
        }
    }

    /// Returns the extent of the shape along a unit vector across its edges [m].
    #[inline(always)]
    fn reach<S: Simd>(&self, n: V3<S>) -> F<S> {
        n.x.abs() * self.half.x + n.y.abs() * self.half.y + n.z.abs() * self.half.z + self.radius
    }

    /// Returns the point of a segment that faces the edge along `axis` farthest along `n`: 0 at its
    /// beginning, 1 at its end.
    #[inline(always)]
    fn facing<S: Simd>(&self, (a, e): (V3<S>, V3<S>), axis: V3<S>, n: V3<S>) -> F<S> {
        let m = axis.cross(n);
        let toward = |n: F<S>, m: F<S>| n.simd_lt(0.0).select(-m, m);
        let corner =
            toward(n.x, m.x) * self.half.x + toward(n.y, m.y) * self.half.y + toward(n.z, m.z) * self.half.z;
        (corner - a.dot(m)) / e.dot(m)
    }
}

/// Transforms a world-space segment to the space of `pose`.
#[inline(always)]
fn own<S: Simd>(simd: S, pose: &(Mat3, Vec3), (a, e): (V3<S>, V3<S>)) -> (V3<S>, V3<S>) {
    let inverse = pose.0.transpose();
    (transform(simd, &inverse, a - V3::splat(simd, pose.1)), transform(simd, &inverse, e))
}
