//! Rotation and translation: how a collider, a root or a joint is placed.

use glam::{Affine3A, Mat3, Quat, Vec3};

/// Rotation and translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidTransform {
    /// Unit rotation.
    pub rotation: Quat,
    /// Translation [m].
    pub translation: Vec3,
}

impl Default for RigidTransform {
    fn default() -> Self {
        Self { rotation: Quat::IDENTITY, translation: Vec3::ZERO }
    }
}

impl RigidTransform {
    /// The rotation and translation of a joint's matrix; its scale is dropped.
    pub fn from_affine(m: &Affine3A) -> Self {
        let (_, rotation, translation) = m.to_scale_rotation_translation();
        Self { rotation: rotation.normalize(), translation }
    }

    /// Between `self` (`t` = 0) and `other` (`t` = 1), on the shorter arc; exactly either one at its end.
    pub fn lerp(&self, other: &RigidTransform, t: f32) -> RigidTransform {
        if t >= 1.0 || self == other {
            return *other;
        }
        RigidTransform {
            rotation: self.rotation.slerp(other.rotation, t),
            translation: self.translation.lerp(other.translation, t),
        }
    }

    /// As a matrix and a translation [m].
    pub fn matrix(&self) -> (Mat3, Vec3) {
        (Mat3::from_quat(self.rotation), self.translation)
    }

    /// `first`, then `self`.
    pub fn after(&self, first: &RigidTransform) -> RigidTransform {
        RigidTransform {
            rotation: self.rotation * first.rotation,
            translation: self.point(first.translation),
        }
    }

    /// What undoes it.
    pub fn inverse(&self) -> RigidTransform {
        let rotation = self.rotation.inverse();
        RigidTransform { rotation, translation: -(rotation * self.translation) }
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
