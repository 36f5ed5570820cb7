//! Rigid transforms: the poses of colliders, roots and joints.

use glam::{Affine3A, Mat3, Quat, Vec3};
use std::ops::Mul;

/// A rotation followed by a translation.
///
/// For an example, see [`math`](crate::math).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidTransform {
    /// Unit rotation.
    pub rotation: Quat,
    /// Translation [m].
    pub translation: Vec3,
}

impl Default for RigidTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// `a * b` applies `b`, then `a`.
impl Mul for RigidTransform {
    type Output = Self;

    fn mul(self, first: Self) -> Self {
        Self {
            rotation: self.rotation * first.rotation,
            translation: self.transform_point(first.translation),
        }
    }
}

impl RigidTransform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self::new(Vec3::ZERO, Quat::IDENTITY);

    /// Creates the transform that rotates by a unit quaternion and then translates [m].
    pub const fn new(translation: Vec3, rotation: Quat) -> Self {
        Self { rotation, translation }
    }

    /// Creates a translation [m].
    pub const fn from_translation(translation: Vec3) -> Self {
        Self::new(translation, Quat::IDENTITY)
    }

    /// Creates a rotation about the origin by a unit quaternion.
    pub const fn from_rotation(rotation: Quat) -> Self {
        Self::new(Vec3::ZERO, rotation)
    }

    /// Returns the rotation and translation of a joint's matrix, without its scale.
    pub fn from_affine(m: &Affine3A) -> Self {
        let (_, rotation, translation) = m.to_scale_rotation_translation();
        Self { rotation: rotation.normalize(), translation }
    }

    /// Interpolates between `self` (`t` = 0) and `other` (`t` = 1) along the shorter arc. The result is exact
    /// at both ends.
    pub fn lerp(&self, other: &RigidTransform, t: f32) -> RigidTransform {
        if t >= 1.0 || self == other {
            return *other;
        }
        RigidTransform {
            rotation: self.rotation.slerp(other.rotation, t),
            translation: self.translation.lerp(other.translation, t),
        }
    }

    /// Returns the transform as a rotation matrix and a translation [m].
    pub fn matrix(&self) -> (Mat3, Vec3) {
        (Mat3::from_quat(self.rotation), self.translation)
    }

    /// Returns the inverse transform.
    pub fn inverse(&self) -> RigidTransform {
        let rotation = self.rotation.inverse();
        RigidTransform { rotation, translation: -(rotation * self.translation) }
    }

    /// Transforms a point from local to world space [m].
    pub fn transform_point(&self, p: Vec3) -> Vec3 {
        self.rotation * p + self.translation
    }

    /// Transforms a point from world to local space [m].
    pub fn inverse_transform_point(&self, p: Vec3) -> Vec3 {
        self.rotation.inverse() * (p - self.translation)
    }
}
