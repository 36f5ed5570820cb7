//! Rigid transforms, and interpolation between keys in time.

mod interpolate;
mod rigid_transform;

pub use interpolate::find_keys;
pub use rigid_transform::RigidTransform;
