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
        d.dot(d).simd_le(F::splat(simd, self.bounds.1 * self.bounds.1))
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
            Obstacle::Plane { point, normal } => ((p - *point).dot(*normal), *normal),
            Obstacle::Field(grid) => grid.distance_and_normal(p),
        }
    }

    /// A ball around all of it: its middle and radius [m].
    fn bounds(&self) -> (Vec3, f32) {
        match self {
            Obstacle::Sphere { center, radius } => (*center, *radius),
            Obstacle::Capsule { a, b, radius } => (a.midpoint(*b), 0.5 * a.distance(*b) + radius),
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
    let local = transform(simd, &pose.end.0.transpose(), p - V3::splat(simd, pose.end.1));
    let (distance, normal) = pose.shape.distance_lanes(simd, local);
    (distance, transform(simd, &pose.end.0, normal))
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
