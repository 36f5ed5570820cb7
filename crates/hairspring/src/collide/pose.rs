//! Collider poses: a collider shape during a substep, with the broad-phase tests and surface motion for eight
//! world-space points at once.

use super::{ColliderShape, SignedDistanceField, shape::ball_lanes, side::Edges};
use crate::simd::lanes::{F, LANES, Mask, Row, Simd, V3, transform};
use glam::{Mat3, Vec3};

/// Distance between the samples of a segment longer than [`LONG`], in cells of a field [1]; the outer samples
/// are half of that from its ends. A segment therefore cannot cross a feature one cell thick unnoticed.
const SAMPLE_SPACING: f32 = 1.5;

/// Maximum number of samples [1].
const MAX_SAMPLES: u32 = 8;

/// Length up to which a segment is sampled only at its middle, in cells [1].
const LONG: f32 = 2.0;

/// A collider during one substep.
///
/// ```
/// use glam::{Mat3, Vec3};
/// use hairspring::collide::{ColliderPose, ColliderShape};
///
/// let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.1 };
/// let (start, end) = ((Mat3::IDENTITY, Vec3::ZERO), (Mat3::IDENTITY, Vec3::X));
/// assert!(ColliderPose::new(ball, start, end, 1.0).distance(Vec3::X) < 0.0);
/// ```
#[derive(Clone)]
pub struct ColliderPose {
    /// The shape.
    pub(crate) shape: ColliderShape,
    /// Pose at the end of the substep.
    pub(crate) end: (Mat3, Vec3),
    /// Pose at the start of the substep.
    pub(crate) start: (Mat3, Vec3),
    /// Duration of the substep as a fraction of the interval that the displacement of a deforming shape
    /// refers to.
    interval_fraction: f32,
    /// Bounding sphere at the end of the substep: center in world space and radius [m], which is infinite for
    /// a plane.
    bounds: (Vec3, f32),
    /// Displacement of its points in the substep: a matrix, applied to the offset from the end pose's
    /// translation, and a constant vector [m].
    motion: (Mat3, Vec3),
    /// Its edges, if it is a capsule or a box.
    pub(crate) edges: Option<Edges>,
}

impl std::fmt::Debug for ColliderPose {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ColliderPose")
            .field("shape", &self.shape)
            .field("start", &self.start)
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}

impl ColliderPose {
    /// Creates the pose of a shape that moves from `start` to `end` in a substep. Both are the rotation and the
    /// translation [m] from the shape to the world. `interval_fraction` (0 to 1) is the duration of the substep over
    /// that of the interval of a deforming shape's displacements; it has no effect on rigid shapes.
    pub fn new(shape: ColliderShape, start: (Mat3, Vec3), end: (Mat3, Vec3), interval_fraction: f32) -> Self {
        let (center, radius) = shape.bounds();
        let bounds = (end.0 * center + end.1, radius);
        // Without rotation the matrix is exactly zero; a rotation times its inverse would not be.
        let turned = if start.0 == end.0 { Mat3::ZERO } else { Mat3::IDENTITY - start.0 * end.0.transpose() };
        let edges = Edges::new(&shape, start, end);
        Self { shape, start, end, interval_fraction, bounds, motion: (turned, end.1 - start.1), edges }
    }

    /// Returns the shape.
    pub fn shape(&self) -> &ColliderShape {
        &self.shape
    }

    /// Returns the rotation matrix and the translation [m] at the start of the substep.
    pub fn start(&self) -> (Mat3, Vec3) {
        self.start
    }

    /// Returns the rotation matrix and the translation [m] at the end of the substep.
    pub fn end(&self) -> (Mat3, Vec3) {
        self.end
    }

    /// Returns which of eight points may be inside at the end of the substep. The others are not.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub(crate) fn broadphase_test<S: Simd>(&self, simd: S, p: V3<S>) -> Mask<S> {
        let d = p - V3::splat(simd, self.bounds.0);
        let near = d.dot(d).simd_le(F::splat(simd, self.bounds.1 * self.bounds.1));
        if !near.any_true() {
            return near;
        }
        match &self.shape {
            ColliderShape::Field(grid) => near & grid.may_be_inside(simd, self.local(simd, p)),
            ColliderShape::Hull(hull) => near & hull.may_be_inside(simd, self.local(simd, p), V3::zero(simd)),
            ColliderShape::Sheet(sheet) => near & sheet.may_be_inside(simd, self.local(simd, p)),
            _ => near,
        }
    }

    /// Returns which of eight segments may have an interior point that is deeper than `tolerance` [m] and than both
    /// ends. The segments end at `p` (world) and have the edge vector `e`. The others have no such point that
    /// matters.
    ///
    /// ```text
    ///   ●─────────●    on a round shape of radius R, a segment of length L is deeper between its ends by at most L²/8R:
    ///  ╱  sag ↕    ╲   if that is less than the tolerance, nothing has to be sampled
    /// ```
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub(crate) fn segment_may_intersect<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        tolerance: F<S>,
    ) -> Mask<S> {
        let none = Mask::splat(simd, false);
        let size = e.dot(e);
        let mut may = size.simd_gt(tolerance * (8.0 * self.shape.roundness()));
        if !may.any_true() {
            return none;
        }
        let half = F::splat(simd, -0.5);
        let d = e.mul_add(half, p) - V3::splat(simd, self.bounds.0);
        // Slightly more than half of its length.
        let reach = size.sqrt().mul_add(0.5001, F::splat(simd, self.bounds.1));
        may &= d.dot(d).simd_le(reach * reach);
        if !may.any_true() {
            return none;
        }
        match &self.shape {
            ColliderShape::Hull(hull) => {
                let turned = transform(simd, &self.end.0.transpose(), e);
                may & hull.may_be_inside(simd, self.local(simd, p), turned)
            }
            ColliderShape::Field(grid) => {
                let may = self.between(
                    simd,
                    (p, e),
                    (size, grid.cell()),
                    may,
                    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
                    |at| grid.may_be_inside(simd, at),
                );
                if may.any_true() && !is_long(simd, grid, e) {
                    may & self.sdf_segment_test(simd, grid, (p, e), tolerance)
                } else {
                    may
                }
            }
            ColliderShape::Sheet(sheet) => {
                let e = transform(simd, &self.end.0.transpose(), e);
                sheet.segments_may_be_inside(simd, (self.local(simd, p) - e, e), may)
            }
            _ => may,
        }
    }

    /// [`Self::segment_may_intersect`] for segments that end near the surface. Most of these pass a cell that
    /// contains a point inside, so that test is skipped. Not inlined: all kernels share one copy.
    #[inline(never)]
    pub(crate) fn segment_may_penetrate<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        tolerance: F<S>,
    ) -> Mask<S> {
        simd.vectorize(
            #[cfg_attr(not(any(test, unoptimized)), inline(always))]
            || match &self.shape {
                ColliderShape::Field(grid) if !is_long(simd, grid, e) => {
                    self.sdf_segment_test(simd, grid, (p, e), tolerance)
                }
                _ => self.segment_may_intersect(simd, (p, e), tolerance),
            },
        )
    }

    /// Returns which of eight segments may be deeper than `tolerance` [m] in a field. The segments end at `p`
    /// (world) and have the edge vector `e`. The test uses distance and slope at both thirds: for a convex
    /// shape, the distance along the segment lies above its tangents. (The ends are outside, or handled by
    /// the contacts of points.) On a smooth body this rejects most segments that lie on the surface, since
    /// the tangents go no deeper than 10/9 of the depth at the middle.
    ///
    /// ```text
    ///   d ●                 ●
    ///      ╲_             _╱
    ///        ●╌_       _╌●
    ///        ⅓   ╌╌_╌╌    ⅔
    /// ```
    ///
    /// Not inlined: all kernels share one copy.
    #[inline(never)]
    fn sdf_segment_test<S: Simd>(
        &self,
        simd: S,
        grid: &SignedDistanceField,
        segments: (V3<S>, V3<S>),
        tolerance: F<S>,
    ) -> Mask<S> {
        simd.vectorize(
            #[cfg_attr(not(any(test, unoptimized)), inline(always))]
            || self.sample_thirds(simd, grid, segments, tolerance),
        )
    }

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn sample_thirds<S: Simd>(
        &self,
        simd: S,
        grid: &SignedDistanceField,
        (p, e): (V3<S>, V3<S>),
        tolerance: F<S>,
    ) -> Mask<S> {
        let (p, e) = (self.local(simd, p), transform(simd, &self.end.0.transpose(), e));
        let [third, two] = [1.0 / 3.0, 2.0 / 3.0].map(|part| F::<S>::splat(simd, part));
        let (inner, rise) = grid.slope_lanes(simd, p - e * two);
        let down = rise.dot(e);
        let (outer, rise) = grid.slope_lanes(simd, p - e * third);
        let up = rise.dot(e);
        let [first, last] = [inner - down * third, outer + up * third];
        let ends = first.min(inner).min(outer).min(last).simd_lt(-tolerance);
        // Depth where the tangents cross; both sides are multiplied by the change of slope.
        let crossing = first * up - (outer - up * two) * down;
        let between = down.simd_lt(0.0) & up.simd_gt(0.0) & crossing.simd_lt((down - up) * tolerance);
        ends | between
    }

    /// Returns the segments in `may` for which `holds` is true at one of the samples. The samples are at most
    /// [`SAMPLE_SPACING`] cells of edge `cell` [m] apart.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn between<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        (size, cell): (F<S>, f32),
        may: Mask<S>,
        holds: impl Fn(V3<S>) -> Mask<S>,
    ) -> Mask<S> {
        // Use as many samples as the longest of the eight segments needs.
        let mut samples = 1;
        while samples < MAX_SAMPLES
            && size
                .simd_gt(F::splat(simd, (cell * LONG.max(samples as f32 * SAMPLE_SPACING)).powi(2)))
                .any_true()
        {
            samples += 1;
        }
        let (p, e) = (self.local(simd, p), transform(simd, &self.end.0.transpose(), e));
        let mut held = Mask::splat(simd, false);
        for k in 0..samples {
            held |= holds(e.mul_add(F::splat(simd, -(k as f32 + 0.5) / samples as f32), p));
        }
        may & held
    }

    /// Transforms eight world points to the shape's own space at the end of the substep.
    #[inline(always)]
    fn local<S: Simd>(&self, simd: S, p: V3<S>) -> V3<S> {
        transform(simd, &self.end.0.transpose(), p - V3::splat(simd, self.end.1))
    }

    /// Returns the distance from `p` [m] (world) to the surface at the end of the substep, negative inside.
    /// For a single point, used by checks and for follow hairs.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.shape.distance(self.end.0.transpose() * (p - self.end.1))
    }
}

/// Returns whether any of the segments is longer than [`LONG`] cells of the field. `find_deepest_point`
/// samples those more densely.
#[inline(always)]
fn is_long<S: Simd>(simd: S, grid: &SignedDistanceField, e: V3<S>) -> bool {
    e.dot(e).simd_gt(F::splat(simd, (LONG * grid.cell()).powi(2))).any_true()
}

/// Returns the distance to the surface and the normal in world space, for eight points at the end of a
/// substep.
#[inline(always)]
pub(crate) fn contact<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> (F<S>, V3<S>) {
    if let ColliderShape::Sphere { radius, .. } = pose.shape {
        // A sphere does not depend on the rotation.
        return ball_lanes(p - V3::splat(simd, pose.bounds.0), radius);
    }
    let (distance, normal) = pose.shape.distance_lanes(simd, pose.local(simd, p));
    (distance, transform(simd, &pose.end.0, normal))
}

/// Like [`contact`], but returns the gradient of the distance [1] instead of the normal.
#[inline(always)]
pub(crate) fn slope<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> (F<S>, V3<S>) {
    let (distance, slope) = pose.shape.slope_lanes(simd, pose.local(simd, p));
    (distance, transform(simd, &pose.end.0, slope))
}

/// Returns how far the surface at `p` (world, end of the substep) moved in the substep [m].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub(crate) fn surface_displacement<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> V3<S> {
    let (turned, moved) = &pose.motion;
    let rigid = transform(simd, turned, p - V3::splat(simd, pose.end.1)) + V3::splat(simd, *moved);
    let own = |displacement: &dyn Fn(Vec3) -> Vec3| {
        let local = pose.local(simd, p);
        let mut rows = [Row::default(); 3];
        for lane in 0..LANES {
            let at = Vec3::new(local.x.lane(lane), local.y.lane(lane), local.z.lane(lane));
            let d = pose.end.0 * (displacement(at) * pose.interval_fraction);
            for (row, d) in rows.iter_mut().zip(d.to_array()) {
                row.0[lane] = d;
            }
        }
        V3::load(simd, &rows)
    };
    match &pose.shape {
        ColliderShape::Field(grid) if grid.deforms() => rigid + own(&|at| grid.displacement(at)),
        ColliderShape::Sheet(sheet) if sheet.deforms() => rigid + own(&|at| sheet.displacement(at)),
        _ => rigid,
    }
}
