//! Colliders as the kernel sees them: a distance and a normal for eight points at once, in the collider's own space.

use super::{Grid, Hull, Sheet};
use crate::strand::{
    lanes::{F, LANES, Row, V3},
    root::transform,
};
use fearless_simd::{mask32x8, prelude::*};
use glam::{Mat3, Vec3};
use std::sync::Arc;

/// Cells between places that a segment is looked at on its way past a field [1]: it cannot cross what is a cell thick unseen.
const LOOK: f32 = 1.5;

/// Most such places [1].
const MOST_LOOKS: u32 = 7;

/// One collider: a shape in its own space, and how that space moves.
#[derive(Clone, Debug)]
pub enum Obstacle {
    /// A ball around `center` [m].
    Sphere {
        /// Middle [m].
        center: Vec3,
        /// Radius [m].
        radius: f32,
    },
    /// All places nearer than `radius` to the segment `a`–`b` [m].
    Capsule {
        /// One end of the axis [m].
        a: Vec3,
        /// The other end [m].
        b: Vec3,
        /// Radius [m].
        radius: f32,
    },
    /// A box.
    Cuboid {
        /// Middle [m].
        center: Vec3,
        /// Half of its edges [m].
        half: Vec3,
        /// Unit vectors along them, orthogonal.
        axes: Mat3,
    },
    /// All of space on the side of a plane that its normal points away from: a floor, a wall, a slope.
    Plane {
        /// A point of the plane [m].
        point: Vec3,
        /// Unit normal, out of the solid.
        normal: Vec3,
    },
    /// The inside of a closed mesh.
    Field(Arc<Grid>),
    /// The convex hull of some points.
    Hull(Arc<Hull>),
    /// All places nearer to an open mesh than its thickness.
    Sheet(Arc<Sheet>),
}

/// An obstacle during one substep.
#[derive(Clone)]
pub struct ObstaclePose {
    /// The shape.
    pub shape: Obstacle,
    /// Pose at the end of the substep.
    pub end: (Mat3, Vec3),
    /// Pose at its start.
    pub start: (Mat3, Vec3),
    /// Fraction of an interval that the substep lasts: a deforming field's displacement is for a whole interval.
    pub share: f32,
    /// A ball that holds all of it at the end: its middle in the world and its radius [m], which is infinite for a plane.
    bounds: (Vec3, f32),
}

impl ObstaclePose {
    /// A shape that moves from `start` to `end` in a substep that lasts `share` of an interval.
    pub fn new(shape: Obstacle, start: (Mat3, Vec3), end: (Mat3, Vec3), share: f32) -> Self {
        let (center, radius) = shape.bounds();
        let bounds = (end.0 * center + end.1, radius);
        Self { shape, start, end, share, bounds }
    }

    /// Which of eight points may be inside at the end of the substep; the others are not.
    #[inline(always)]
    pub(crate) fn near<S: Simd>(&self, simd: S, p: V3<S>) -> mask32x8<S> {
        let d = p - V3::splat(simd, self.bounds.0);
        let near = d.dot(d).simd_le(F::splat(simd, self.bounds.1 * self.bounds.1));
        if !near.any_true() {
            return near;
        }
        match &self.shape {
            Obstacle::Field(grid) => near & grid.may_be_inside(simd, self.local(simd, p)),
            Obstacle::Hull(hull) => near & hull.may_be_inside(simd, self.local(simd, p), V3::zero(simd)),
            Obstacle::Sheet(sheet) => near & sheet.may_be_inside(simd, self.local(simd, p)),
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
    pub(crate) fn may_cut<S: Simd>(&self, simd: S, (p, e): (V3<S>, V3<S>), sag: F<S>) -> mask32x8<S> {
        let none = mask32x8::splat(simd, false);
        let size = e.dot(e);
        let rounded = match &self.shape {
            Obstacle::Plane { .. } => return none,
            Obstacle::Sphere { radius, .. } | Obstacle::Capsule { radius, .. } => *radius,
            _ => 0.0,
        };
        let mut may = size.simd_gt(sag * (8.0 * rounded));
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
            Obstacle::Hull(hull) => {
                let turned = transform(simd, &self.end.0.transpose(), e);
                may & hull.may_be_inside(simd, self.local(simd, p), turned)
            }
            Obstacle::Field(grid) => {
                let spacing = LOOK * grid.cell;
                self.between(
                    simd,
                    (p, e),
                    (size, spacing),
                    may,
                    #[inline(always)]
                    |at| grid.may_be_inside(simd, at),
                )
            }
            Obstacle::Sheet(sheet) => {
                let spacing = LOOK * sheet.cell();
                self.between(
                    simd,
                    (p, e),
                    (size, spacing),
                    may,
                    #[inline(always)]
                    |at| sheet.may_be_inside(simd, at),
                )
            }
            _ => may,
        }
    }

    /// Of the segments in `may`, those with a place between their ends for which `holds` is true, of places that are no farther than `spacing` [m] from each
    /// other.
    #[inline(always)]
    fn between<S: Simd>(
        &self,
        simd: S,
        (p, e): (V3<S>, V3<S>),
        (size, spacing): (F<S>, f32),
        may: mask32x8<S>,
        holds: impl Fn(V3<S>) -> mask32x8<S>,
    ) -> mask32x8<S> {
        // As many places as the longest of the eight needs.
        let mut pieces = 2;
        while pieces <= MOST_LOOKS
            && size.simd_gt(F::splat(simd, (pieces as f32 * spacing).powi(2))).any_true()
        {
            pieces += 1;
        }
        let (p, e) = (self.local(simd, p), transform(simd, &self.end.0.transpose(), e));
        let mut held = mask32x8::splat(simd, false);
        for k in 1..pieces {
            held |= holds(e.mul_add(F::splat(simd, -(k as f32) / pieces as f32), p));
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

impl Obstacle {
    /// The distance from `p` [m] in the collider's own space, negative inside.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.distance_and_normal(p).0
    }

    /// Distance [m] and outward unit normal at `p` [m] in the collider's own space.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let ball = |d: Vec3, radius: f32| (d.length() - radius, d.normalize_or(Vec3::Y));
        match self {
            Obstacle::Sphere { center, radius } => ball(p - *center, *radius),
            Obstacle::Capsule { a, b, radius } => {
                let axis = *b - *a;
                let t = ((p - *a).dot(axis) / axis.length_squared().max(1e-12)).clamp(0.0, 1.0);
                ball(p - (*a + axis * t), *radius)
            }
            Obstacle::Cuboid { center, half, axes } => {
                let l = axes.transpose() * (p - *center);
                let q = l.abs() - *half;
                let most = q.max_element();
                let (distance, normal) = if most <= 0.0 {
                    // Out through the nearest face.
                    let face = [Vec3::X, Vec3::Y, Vec3::Z]
                        [usize::from(q.x < most) + usize::from(q.x < most && q.y < most)];
                    (most, face)
                } else {
                    let out = q.max(Vec3::ZERO);
                    (out.length(), out.normalize())
                };
                (distance, *axes * Vec3::select(l.cmplt(Vec3::ZERO), -normal, normal))
            }
            Obstacle::Plane { point, normal } => ((p - *point).dot(*normal), *normal),
            Obstacle::Field(grid) => grid.distance_and_normal(p),
            Obstacle::Hull(hull) => hull.distance_and_normal(p),
            Obstacle::Sheet(sheet) => sheet.distance_and_normal(p),
        }
    }

    /// Half of how thick it is where it is thickest [m]: how far its deepest place is from the surface, about; infinite for a plane.
    pub(crate) fn half_thickness(&self) -> f32 {
        match self {
            Obstacle::Sphere { radius, .. } | Obstacle::Capsule { radius, .. } => *radius,
            Obstacle::Cuboid { half, .. } => half.min_element(),
            Obstacle::Plane { .. } => f32::INFINITY,
            Obstacle::Field(grid) => -grid.distances.iter().copied().fold(0.0, f32::min),
            Obstacle::Hull(hull) => -hull.distance_and_normal(hull.bounds().0).0,
            Obstacle::Sheet(sheet) => sheet.thickness(),
        }
    }

    /// A ball around all of it: its middle and radius [m].
    pub(crate) fn bounds(&self) -> (Vec3, f32) {
        match self {
            Obstacle::Sphere { center, radius } => (*center, *radius),
            Obstacle::Capsule { a, b, radius } => (a.midpoint(*b), 0.5 * a.distance(*b) + radius),
            Obstacle::Cuboid { center, half, .. } => (*center, half.length()),
            Obstacle::Plane { .. } => (Vec3::ZERO, f32::INFINITY),
            Obstacle::Field(grid) => grid.bounds(),
            Obstacle::Hull(hull) => hull.bounds(),
            Obstacle::Sheet(sheet) => sheet.bounds(),
        }
    }

    #[inline(always)]
    fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        match self {
            Obstacle::Sphere { center, radius } => ball_lanes(p - V3::splat(simd, *center), *radius),
            Obstacle::Capsule { a, b, radius } => {
                let axis = *b - *a;
                let from = p - V3::splat(simd, *a);
                let t = from.dot(V3::splat(simd, axis)) * (1.0 / axis.length_squared().max(1e-12));
                let t = t.max(0.0).min(1.0);
                ball_lanes(from - V3::splat(simd, axis) * t, *radius)
            }
            Obstacle::Cuboid { center, half, axes } => {
                let local = transform(simd, &axes.transpose(), p - V3::splat(simd, *center));
                let (distance, normal) = cuboid_lanes(simd, local, *half);
                (distance, transform(simd, axes, normal))
            }
            Obstacle::Plane { point, normal } => {
                let normal = V3::splat(simd, *normal);
                ((p - V3::splat(simd, *point)).dot(normal), normal)
            }
            Obstacle::Field(grid) => grid.distance_lanes(simd, p),
            Obstacle::Hull(hull) => hull.distance_lanes(simd, p),
            Obstacle::Sheet(sheet) => sheet.distance_lanes(simd, p),
        }
    }
}

/// World distance to the surface, and normal, of eight points at the end of a substep.
#[inline(always)]
pub(crate) fn contact<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> (F<S>, V3<S>) {
    let (distance, normal) = pose.shape.distance_lanes(simd, pose.local(simd, p));
    (distance, transform(simd, &pose.end.0, normal))
}

/// How far the surface at `p` (world, end of the substep) moved in the substep [m].
#[inline(always)]
pub(crate) fn surface_displacement<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> V3<S> {
    let local = pose.local(simd, p);
    let before = transform(simd, &pose.start.0, local) + V3::splat(simd, pose.start.1);
    let rigid = p - before;
    let own = |displacement: &dyn Fn(Vec3) -> Vec3| {
        let mut rows = [Row::default(); 3];
        for lane in 0..LANES {
            let at = Vec3::new(local.x[lane], local.y[lane], local.z[lane]);
            let d = pose.end.0 * (displacement(at) * pose.share);
            for (row, d) in rows.iter_mut().zip(d.to_array()) {
                row.0[lane] = d;
            }
        }
        V3::load(simd, &rows)
    };
    match &pose.shape {
        Obstacle::Field(grid) if grid.deforms() => rigid + own(&|at| grid.displacement(at)),
        Obstacle::Sheet(sheet) if sheet.deforms() => rigid + own(&|at| sheet.displacement(at)),
        _ => rigid,
    }
}

/// Distance and normal of a ball of `radius`, `d` from its middle.
#[inline(always)]
fn ball_lanes<S: Simd>(d: V3<S>, radius: f32) -> (F<S>, V3<S>) {
    let (length, normal) = d.length_and_unit();
    (length - radius, normal)
}

/// Distance and normal of a box around the origin: from its faces, edges and corners outside, out through the nearest face inside.
#[inline(always)]
fn cuboid_lanes<S: Simd>(simd: S, l: V3<S>, half: Vec3) -> (F<S>, V3<S>) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let q = V3 { x: l.x.abs() - half.x, y: l.y.abs() - half.y, z: l.z.abs() - half.z };
    let (length, out) = V3 { x: q.x.max(zero), y: q.y.max(zero), z: q.z.max(zero) }.length_and_unit();
    let most = q.x.max(q.y).max(q.z);
    let inside = most.simd_le(0.0);
    let [x, y] = [q.x.simd_ge(most), q.y.simd_ge(most)];
    let face = V3 {
        x: x.select(one, zero),
        y: x.select(zero, y.select(one, zero)),
        z: x.select(zero, y.select(zero, one)),
    };
    let normal = V3::select(inside, face, out);
    let toward = |l: F<S>, n: F<S>| l.simd_lt(0.0).select(-n, n);
    let normal = V3 { x: toward(l.x, normal.x), y: toward(l.y, normal.y), z: toward(l.z, normal.z) };
    (inside.select(most, length), normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strand::lanes::{LANES, Row};
    use fearless_simd::{Level, dispatch};
    use glam::Quat;
    use proptest::prelude::*;

    fn vector(size: f32) -> impl Strategy<Value = Vec3> {
        (-size..size, -size..size, -size..size).prop_map(Vec3::from)
    }

    proptest! {
        /// Every shape's distance is that to the nearest place of its surface, its normal the way there or from there, and eight points get
        /// what one gets.
        #[test]
        fn a_step_along_the_normal_leads_to_the_surface(
            center in vector(0.2), half in vector(0.1), turn in vector(3.0), p in vector(0.4),
            points in prop::collection::vec(vector(0.2), 6..20),
        ) {
            let half = half.abs() + 0.01;
            // Random points span a volume; what they are shrunk to need not.
            let hull = Hull::new(&points);
            prop_assume!(hull.is_some());
            let axes = Mat3::from_quat(Quat::from_scaled_axis(turn));
            let end = center + axes.x_axis * half.x;
            let shapes = [
                Obstacle::Sphere { center, radius: half.x },
                Obstacle::Capsule { a: center, b: end, radius: half.y },
                Obstacle::Cuboid { center, half, axes },
                Obstacle::Plane { point: center, normal: axes.y_axis },
                Obstacle::Hull(Arc::new(hull.unwrap())),
                Obstacle::Sheet(Arc::new(Sheet::new(&points, &[[0, 1, 2]], half.x))),
            ];
            for shape in shapes {
                let (distance, normal) = shape.distance_and_normal(p);
                prop_assert!((normal.length() - 1.0).abs() < 1e-5, "{shape:?}: {normal}");
                let on = p - normal * distance;
                // A sheet that is farther off than its thickness only says that it is at least as far.
                let exact = !matches!(shape, Obstacle::Sheet(_)) || distance < 0.999 * half.x;
                prop_assert!(!exact || shape.distance(on).abs() < 1e-5, "{shape:?}: {} left at {on}", shape.distance(on));
                // Nothing of the surface is nearer: a ball of that size around p has no place on the other side.
                for k in 0..64 {
                    let way = Quat::from_euler(glam::EulerRot::XYZ, k as f32, 1.7 * k as f32, 0.3) * Vec3::X;
                    let other = shape.distance(p + way * (0.98 * distance.abs()));
                    prop_assert!(other * distance >= -1e-9, "{shape:?}: {other} near {distance}");
                }
                let pose = ObstaclePose::new(shape.clone(), (Mat3::IDENTITY, Vec3::ZERO), (Mat3::IDENTITY, Vec3::ZERO), 1.0);
                let (lanes, normals, near) = dispatch!(Level::new(), simd => {
                    let at = V3::splat(simd, p);
                    let (d, n) = contact(simd, &pose, at);
                    let mut rows = [Row([0.0; LANES]); 3];
                    n.store(&mut rows);
                    (d[3], Vec3::from(rows.map(|r| r.0[3])), pose.near(simd, at).any_true())
                });
                prop_assert!((lanes - distance).abs() < 1e-6, "{shape:?}: {lanes}, alone {distance}");
                prop_assert!(normals.distance(normal) < 1e-3, "{shape:?}: {normals}, alone {normal}");
                prop_assert!(near || distance > 0.0, "{shape:?}: inside, and not near");
            }
        }
    }
}
