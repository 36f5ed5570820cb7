//! Colliders: spheres, capsules, boxes, planes, convex hulls, thin shells of open meshes, and signed distance
//! fields of closed meshes. Each moves as a rigid body; shells and fields may also deform.
//!
//! # Example
//! ```
//! use glam::{Mat3, Vec3};
//! use hairspring::collide::{ColliderShape, Hull, ThinShell, voxelize};
//! use std::sync::Arc;
//!
//! let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let shapes = [
//!     ColliderShape::Cuboid { center: Vec3::splat(0.2), half: Vec3::splat(0.1), axes: Mat3::IDENTITY },
//!     ColliderShape::Hull(Arc::new(Hull::new(&corners).expect("the points span a volume"))),
//!     ColliderShape::Field(Arc::new(voxelize(&corners, &triangles, 0.05))),
//! ];
//! assert!(shapes.iter().all(|shape| shape.distance(Vec3::splat(0.2)) < 0.0));
//! let cloth = ColliderShape::Sheet(Arc::new(ThinShell::new(&corners, &triangles[..1], 0.01)));
//! assert!(cloth.distance(Vec3::new(0.2, 0.2, 0.0)) < 0.0);
//! ```

mod crossing;
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

pub use crossing::Crossing;
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
pub use voxelize::{Voxelizer, VoxelizerInput, voxelize};
