//! Rigid transforms, and interpolation between keys in time.
//!
//! # Example
//! ```
//! use glam::{Quat, Vec3};
//! use hairspring::math::RigidTransform;
//!
//! let turn = RigidTransform { rotation: Quat::from_rotation_z(std::f32::consts::FRAC_PI_2), ..Default::default() };
//! let shift = RigidTransform { translation: Vec3::X, ..Default::default() };
//! assert!(turn.after(&shift).point(Vec3::ZERO).distance(Vec3::Y) < 1e-6);
//! ```

mod interpolate;
mod rigid_transform;

pub use interpolate::find_keys;
pub use rigid_transform::RigidTransform;
