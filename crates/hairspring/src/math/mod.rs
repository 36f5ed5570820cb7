//! Rigid transforms, angles between rotations, and interpolation between keys in time.
//!
//! # Example
//! ```
//! use glam::{Quat, Vec3};
//! use hairspring::math::RigidTransform;
//!
//! let turn = RigidTransform::from_rotation(Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
//! let shift = RigidTransform::from_translation(Vec3::X);
//! // First the shift, then the rotation.
//! assert!((turn * shift).transform_point(Vec3::ZERO).distance(Vec3::Y) < 1e-6);
//! ```

mod angle_between;
mod interpolate;
mod nearer_start;
mod rigid_transform;

pub use angle_between::angle_between;
pub use interpolate::find_keys;
pub(crate) use nearer_start::nearer_start;
pub use rigid_transform::RigidTransform;
