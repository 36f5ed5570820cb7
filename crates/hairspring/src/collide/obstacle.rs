//! Colliders as the kernel sees them: a distance and a normal for eight points at once, in the collider's own space.

use super::Grid;
use crate::strand::{
    lanes::{F, V3, load},
    root::transform,
};
use fearless_simd::{mask32x8, prelude::*};
use glam::{Affine3A, Mat3, Quat, Vec3};
use std::sync::Arc;

/// Rotation and translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Unit rotation.
    pub rotation: Quat,
    /// Translation [m].
    pub translation: Vec3,
}

impl Default for Rigid {
    fn default() -> Self {
        Self { rotation: Quat::IDENTITY, translation: Vec3::ZERO }
    }
}

impl Rigid {
    /// The rotation and translation of a joint's matrix; its scale is dropped.
    pub fn from_affine(m: &Affine3A) -> Self {
        let (_, rotation, translation) = m.to_scale_rotation_translation();
        Self { rotation: rotation.normalize(), translation }
    }

    /// Between `self` (`t` = 0) and `other` (`t` = 1), on the shorter arc; exactly either one at its end.
    pub fn lerp(&self, other: &Rigid, t: f32) -> Rigid {
        if t >= 1.0 || self == other {
            return *other;
        }
        Rigid {
            rotation: self.rotation.slerp(other.rotation, t),
            translation: self.translation.lerp(other.translation, t),
        }
    }

    /// As a matrix and a translation [m].
    pub fn matrix(&self) -> (Mat3, Vec3) {
        (Mat3::from_quat(self.rotation), self.translation)
    }

    /// `first`, then `self`.
    pub fn after(&self, first: &Rigid) -> Rigid {
        Rigid { rotation: self.rotation * first.rotation, translation: self.point(first.translation) }
    }

    /// What undoes it.
    pub fn inverse(&self) -> Rigid {
        let rotation = self.rotation.inverse();
        Rigid { rotation, translation: -(rotation * self.translation) }
    }

    /// A point of this frame in the world [m].
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.rotation * p + self.translation
    }

    /// A world point in this frame [m].
    pub fn inverse_point(&self, p: Vec3) -> Vec3 {
        self.rotation.inverse() * (p - self.translation)
    }
}

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
    /// A ball that holds all of it at every moment of the substep.
    swept: (Vec3, f32),
    /// Into how many parts a substep is cut for strands that it sweeps over; 1: it is too slow to pass through any.
    laps: u32,
}

/// How far a body may move in a substep, over half of its thickness [1]: what it has met is then pushed out on the side that it came from.
const SLOW: f32 = 0.5;

/// The same in one part of a substep: less, as strands are drawn back into it in every part.
const LAP: f32 = 0.25;

/// Most parts that a substep is cut into: a rod of 1 cm may move at 38 m/s with four substeps a frame.
const MOST_LAPS: u32 = 128;

impl ObstaclePose {
    /// A shape that moves from `start` to `end` in a substep that lasts `share` of an interval.
    pub fn new(shape: Obstacle, start: (Mat3, Vec3), end: (Mat3, Vec3), share: f32) -> Self {
        let (center, radius) = shape.bounds();
        let bounds = (end.0 * center + end.1, radius);
        let before = start.0 * center + start.1;
        // No vector of length 1 is moved farther by a rotation than by the Frobenius norm of what it changes, over √2.
        let turned: f32 = (0..3).map(|k| end.0.col(k).distance_squared(start.0.col(k))).sum();
        let turned = (0.5 * turned).sqrt();
        let way = before.distance(bounds.0) + if turned > 0.0 { turned * radius } else { 0.0 };
        let swept = (before.midpoint(bounds.0), radius + 0.5 * way);
        let thin = shape.half_thickness();
        let laps = if way > SLOW * thin { ((way / (LAP * thin)).ceil() as u32).min(MOST_LAPS) } else { 1 };
        Self { shape, start, end, share, bounds, swept, laps }
    }

    /// Into how many parts a substep is cut for strands that it sweeps over, 1 or more.
    pub(crate) fn laps(&self) -> u32 {
        self.laps
    }

    /// Its pose when a `fraction` of the substep is over. Matrices are mixed: in a substep that turns by 10 degrees, that makes it smaller by
    /// half a percent for a moment.
    #[inline(always)]
    pub(crate) fn pose_at(&self, fraction: f32) -> (Mat3, Vec3) {
        let (a, b) = (&self.start, &self.end);
        (a.0 + (b.0 - a.0) * fraction, a.1 + (b.1 - a.1) * fraction)
    }

    /// Which of eight points, `way` from where the substep found them, it may have met on that way although it is not seen where they are: the way
    /// is no longer short for how thin the body is, or leads deep into it, and leads to within `reach` of it.
    #[inline(always)]
    pub(crate) fn may_sweep<S: Simd>(&self, simd: S, (p, way): (V3<S>, V3<S>), reach: F<S>) -> mask32x8<S> {
        let d = p - V3::splat(simd, self.swept.0);
        let radius = reach + self.swept.1;
        let near = d.dot(d).simd_le(radius * radius);
        if !near.any_true() {
            return near;
        }
        let own = |m: &(Mat3, Vec3), p: V3<S>| transform(simd, &m.0.transpose(), p - V3::splat(simd, m.1));
        let (to, from) = (own(&self.end, p), own(&self.start, p - way));
        let (length, _) = (to - from).length_and_unit();
        let distance = self.shape.distance_lanes(simd, to).0;
        let little = 0.25 * self.shape.half_thickness();
        near & (length.simd_gt(little) | distance.simd_lt(-little)) & distance.simd_lt(length + reach)
    }

    /// Which of eight points may be inside at the end of the substep; the others are not.
    #[inline(always)]
    pub(crate) fn near<S: Simd>(&self, simd: S, p: V3<S>) -> mask32x8<S> {
        let d = p - V3::splat(simd, self.bounds.0);
        d.dot(d).simd_le(F::splat(simd, self.bounds.1 * self.bounds.1))
    }

    /// The distance from `p` [m] (world) to the surface at the end of the substep, negative inside; one point, for
    /// checks and for follow hairs.
    pub fn distance(&self, p: Vec3) -> f32 {
        self.shape.distance(self.end.0.transpose() * (p - self.end.1))
    }

    /// The least distance on the way from `a` to `b` (world) at the end of the substep [m], see [`Obstacle::least_distance`].
    pub fn least_distance(&self, a: Vec3, b: Vec3) -> f32 {
        let own = |p: Vec3| self.end.0.transpose() * (p - self.end.1);
        self.shape.least_distance(own(a), own(b))
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
        }
    }

    /// Half of what it measures where it is thinnest [m]. A plane is thick; so is a field, of which nothing tells where it is thin: parts of a
    /// substep for every head that moves would cost many times the solve.
    pub(crate) fn half_thickness(&self) -> f32 {
        match self {
            Obstacle::Sphere { radius, .. } | Obstacle::Capsule { radius, .. } => *radius,
            Obstacle::Cuboid { half, .. } => half.min_element(),
            Obstacle::Plane { .. } | Obstacle::Field(_) => f32::INFINITY,
        }
    }

    /// Whether the distance from it is a convex function.
    pub(crate) fn is_convex(&self) -> bool {
        !matches!(self, Obstacle::Field(_))
    }

    /// A ball around all of it: its middle and radius [m].
    fn bounds(&self) -> (Vec3, f32) {
        match self {
            Obstacle::Sphere { center, radius } => (*center, *radius),
            Obstacle::Capsule { a, b, radius } => (a.midpoint(*b), 0.5 * a.distance(*b) + radius),
            Obstacle::Cuboid { center, half, .. } => (*center, half.length()),
            Obstacle::Plane { .. } => (Vec3::ZERO, f32::INFINITY),
            Obstacle::Field(grid) => grid.bounds(),
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
        }
    }
}

/// World distance to the surface, and normal, of eight points at the end of a substep.
#[inline(always)]
pub(crate) fn contact<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> (F<S>, V3<S>) {
    contact_at(simd, pose, &pose.end, p)
}

/// The same when it is at a pose on its way.
#[inline(always)]
pub(crate) fn contact_at<S: Simd>(
    simd: S,
    pose: &ObstaclePose,
    at: &(Mat3, Vec3),
    p: V3<S>,
) -> (F<S>, V3<S>) {
    let local = transform(simd, &at.0.transpose(), p - V3::splat(simd, at.1));
    let (distance, normal) = pose.shape.distance_lanes(simd, local);
    (distance, transform(simd, &at.0, normal))
}

/// How far the surface at `p` (world, end of the substep) moved in the substep [m].
#[inline(always)]
pub(crate) fn surface_displacement<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> V3<S> {
    let local = transform(simd, &pose.end.0.transpose(), p - V3::splat(simd, pose.end.1));
    let before = transform(simd, &pose.start.0, local) + V3::splat(simd, pose.start.1);
    let rigid = p - before;
    match &pose.shape {
        Obstacle::Field(grid) if grid.deforms() => {
            let mut own = [super::super::strand::lanes::Row::default(); 3];
            for lane in 0..crate::strand::lanes::LANES {
                let d =
                    grid.displacement(Vec3::new(local.x[lane], local.y[lane], local.z[lane])) * pose.share;
                let d = pose.end.0 * d;
                (own[0].0[lane], own[1].0[lane], own[2].0[lane]) = (d.x, d.y, d.z);
            }
            rigid + V3 { x: load(simd, &own[0]), y: load(simd, &own[1]), z: load(simd, &own[2]) }
        }
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
        ) {
            let half = half.abs() + 0.01;
            let axes = Mat3::from_quat(Quat::from_scaled_axis(turn));
            let end = center + axes.x_axis * half.x;
            let shapes = [
                Obstacle::Sphere { center, radius: half.x },
                Obstacle::Capsule { a: center, b: end, radius: half.y },
                Obstacle::Cuboid { center, half, axes },
                Obstacle::Plane { point: center, normal: axes.y_axis },
            ];
            for shape in shapes {
                let (distance, normal) = shape.distance_and_normal(p);
                prop_assert!((normal.length() - 1.0).abs() < 1e-5, "{shape:?}: {normal}");
                let on = p - normal * distance;
                prop_assert!(shape.distance(on).abs() < 1e-5, "{shape:?}: {} left at {on}", shape.distance(on));
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
