//! Colliders: spheres, capsules, boxes, planes, convex hulls, thin shells of open meshes, and signed distance
//! fields of closed meshes. Each moves as a rigid body; shells and fields may also deform.

mod custom;
mod deep_interior;
mod frame_colliders;
mod holes;
mod hull;
mod lattice;
mod mesh_distance;
mod moving_collider;
mod pose;
mod samples;
mod sdf;
mod segment_depth;
mod shape;
mod side;
mod thin_shell;
mod voxelize;

pub use custom::Collider;
pub(crate) use frame_colliders::FrameColliders;
pub use hull::Hull;
pub use moving_collider::MovingCollider;
pub use pose::ColliderPose;
pub(crate) use pose::{contact, surface_displacement};
pub use samples::FieldError;
pub use sdf::SignedDistanceField;
pub(crate) use segment_depth::{DeepestPoint, STEEP, find_deepest_point};
pub use shape::ColliderShape;
pub(crate) use side::{Edges, Side};
pub use thin_shell::ThinShell;
pub use voxelize::{Voxelizer, voxelize};
