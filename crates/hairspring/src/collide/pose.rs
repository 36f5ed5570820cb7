//! A collider as the kernel sees it during a substep: where its shape is, who is near it, and how its surface moves, for eight points in the world at once.

use super::{ColliderShape, SignedDistanceField, shape::ball_lanes, side::Edges};
use crate::simd::lanes::{F, LANES, Mask, Row, Simd, V3, transform};
use glam::{Mat3, Vec3};

/// Cells between places that a segment longer than [`LONG`] is looked at on its way past a field [1], and from the outer ones to its ends half of that: it
/// cannot cross what is a cell thick unseen.
const LOOK: f32 = 1.5;

/// Most such places [1].
const MOST_LOOKS: u32 = 8;

/// Cells up to which a segment is looked at in its middle alone [1].
const LONG: f32 = 2.0;

/// An obstacle during one substep.
#[derive(Clone)]
pub struct ColliderPose {
    /// The shape.
    pub shape: ColliderShape,
    /// Pose at the end of the substep.
    pub end: (Mat3, Vec3),
    /// Pose at its start.
    pub start: (Mat3, Vec3),
    /// Fraction of an interval that the substep lasts: a deforming field's displacement is for a whole interval.
    pub share: f32,
    /// A ball that holds all of it at the end: its middle in the world and its radius [m], which is infinite for a plane.
    bounds: (Vec3, f32),
    /// How far its places move in the substep: a matrix, by where each is from the pose's end, and what is the same for all [m].
    motion: (Mat3, Vec3),
    /// Its edges, where it is a capsule or a box.
    pub(crate) edges: Option<Edges>,
}

impl ColliderPose {
    /// A shape that moves from `start` to `end` in a substep that lasts `share` of an interval.
    pub fn new(shape: ColliderShape, start: (Mat3, Vec3), end: (Mat3, Vec3), share: f32) -> Self {
        let (center, radius) = shape.bounds();
        let bounds = (end.0 * center + end.1, radius);
        // What does not move does so to the last bit, which a rotation and its inverse do not.
        let turned = if start.0 == end.0 { Mat3::ZERO } else { Mat3::IDENTITY - start.0 * end.0.transpose() };
        let edges = Edges::new(&shape, start, end);
        Self { shape, start, end, share, bounds, motion: (turned, end.1 - start.1), edges }
    }

    /// Which of eight points may be inside at the end of the substep; the others are not.
    #[inline(always)]
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

    /// Which of eight segments that end at `p` (world) and are `e` long may have a place between their ends that is deeper than `sag` [m] and than
    /// both of them; the others have none that counts.
    ///
    /// ```text
    ///   ●─────────●    on a round shape of radius R a segment of length L is deeper between its ends by L²/8R at most:
    ///  ╱  sag ↕    ╲   where that is below what it may, nothing need be looked at
    /// ```
    #[inline(always)]
    pub(crate) fn segment_may_intersect<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        sag: F<S>,
    ) -> Mask<S> {
        let none = Mask::splat(simd, false);
        let size = e.dot(e);
        let mut may = size.simd_gt(sag * (8.0 * self.shape.roundness()));
        if !may.any_true() {
            return none;
        }
        let half = F::splat(simd, -0.5);
        let d = e.mul_add(half, p) - V3::splat(simd, self.bounds.0);
        // A little over half of its length.
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
                    #[inline(always)]
                    |at| grid.may_be_inside(simd, at),
                );
                if may.any_true() && !is_long(simd, grid, e) {
                    may & self.sdf_segment_test(simd, grid, (p, e), sag)
                } else {
                    may
                }
            }
            ColliderShape::Sheet(sheet) => self.between(
                simd,
                (p, e),
                (size, sheet.cell()),
                may,
                #[inline(always)]
                |at| sheet.may_be_inside(simd, at),
            ),
            _ => may,
        }
    }

    /// The same of segments that end beside the surface, as most of those have a place in a cell that holds one inside: it is not asked first.
    #[inline(always)]
    pub(crate) fn segment_may_penetrate<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        sag: F<S>,
    ) -> Mask<S> {
        match &self.shape {
            ColliderShape::Field(grid) if !is_long(simd, grid, e) => {
                self.sdf_segment_test(simd, grid, (p, e), sag)
            }
            _ => self.segment_may_intersect(simd, (p, e), sag),
        }
    }

    /// Which of eight segments that end at `p` (world) and are `e` long may be deeper than `sag` [m] in a field, as distance and slope at both thirds tell: that
    /// of a convex shape lies above its tangents. (Where they end they are outside, or a point's contact sees to it.) On a smooth body most of what lies on
    /// it is done with here: no tangent is deeper than 10/9 of its middle.
    ///
    /// ```text
    ///   d ●                 ●
    ///      ╲_             _╱
    ///        ●╌_       _╌●
    ///        ⅓   ╌╌_╌╌    ⅔
    /// ```
    #[inline(always)]
    fn sdf_segment_test<S: Simd>(
        &self,
        simd: S,
        grid: &SignedDistanceField,
        (p, e): (V3<S>, V3<S>),
        sag: F<S>,
    ) -> Mask<S> {
        let (p, e) = (self.local(simd, p), transform(simd, &self.end.0.transpose(), e));
        let [third, two] = [1.0 / 3.0, 2.0 / 3.0].map(|part| F::<S>::splat(simd, part));
        let (inner, rise) = grid.slope_lanes(simd, p - e * two);
        let down = rise.dot(e);
        let (outer, rise) = grid.slope_lanes(simd, p - e * third);
        let up = rise.dot(e);
        let [first, last] = [inner - down * third, outer + up * third];
        let ends = first.min(inner).min(outer).min(last).simd_lt(-sag);
        // Where they cross, both times how far they turn there.
        let crossing = first * up - (outer - up * two) * down;
        let between = down.simd_lt(0.0) & up.simd_gt(0.0) & crossing.simd_lt((down - up) * sag);
        ends | between
    }

    /// Of the segments in `may`, those with a place between their ends for which `holds` is true, of places that are no farther than [`LOOK`] cells of edge
    /// `cell` [m] from each other.
    #[inline(always)]
    fn between<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        (size, cell): (F<S>, f32),
        may: Mask<S>,
        holds: impl Fn(V3<S>) -> Mask<S>,
    ) -> Mask<S> {
        // As many places as the longest of the eight needs.
        let mut looks = 1;
        while looks < MOST_LOOKS
            && size.simd_gt(F::splat(simd, (cell * LONG.max(looks as f32 * LOOK)).powi(2))).any_true()
        {
            looks += 1;
        }
        let (p, e) = (self.local(simd, p), transform(simd, &self.end.0.transpose(), e));
        let mut held = Mask::splat(simd, false);
        for k in 0..looks {
            held |= holds(e.mul_add(F::splat(simd, -(k as f32 + 0.5) / looks as f32), p));
        }
        may & held
    }

    /// Eight world points in the shape's own space at the end of the substep.
    #[inline(always)]
    fn local<S: Simd>(&self, simd: S, p: V3<S>) -> V3<S> {
        transform(simd, &self.end.0.transpose(), p - V3::splat(simd, self.end.1))
    }

    /// The distance from `p` [m] (world) to the surface at the end of the substep, negative inside; one point, for
    /// checks and for follow hairs.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.shape.distance(self.end.0.transpose() * (p - self.end.1))
    }
}

/// Whether any of the segments is longer than [`LONG`] of the field's cells: those are looked at in more places, by `find_deepest_point`.
#[inline(always)]
fn is_long<S: Simd>(simd: S, grid: &SignedDistanceField, e: V3<S>) -> bool {
    e.dot(e).simd_gt(F::splat(simd, (LONG * grid.cell()).powi(2))).any_true()
}

/// World distance to the surface, and normal, of eight points at the end of a substep.
#[inline(always)]
pub(crate) fn contact<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> (F<S>, V3<S>) {
    if let ColliderShape::Sphere { radius, .. } = pose.shape {
        // However it is turned.
        return ball_lanes(p - V3::splat(simd, pose.bounds.0), radius);
    }
    let (distance, normal) = pose.shape.distance_lanes(simd, pose.local(simd, p));
    (distance, transform(simd, &pose.end.0, normal))
}

/// The same, and in place of the normal how fast the distance changes with place [1].
#[inline(always)]
pub(crate) fn slope<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> (F<S>, V3<S>) {
    let (distance, slope) = pose.shape.slope_lanes(simd, pose.local(simd, p));
    (distance, transform(simd, &pose.end.0, slope))
}

/// How far the surface at `p` (world, end of the substep) moved in the substep [m].
#[inline(always)]
pub(crate) fn surface_displacement<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> V3<S> {
    let (turned, moved) = &pose.motion;
    let rigid = transform(simd, turned, p - V3::splat(simd, pose.end.1)) + V3::splat(simd, *moved);
    let own = |displacement: &dyn Fn(Vec3) -> Vec3| {
        let local = pose.local(simd, p);
        let mut rows = [Row::default(); 3];
        for lane in 0..LANES {
            let at = Vec3::new(local.x.lane(lane), local.y.lane(lane), local.z.lane(lane));
            let d = pose.end.0 * (displacement(at) * pose.share);
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
