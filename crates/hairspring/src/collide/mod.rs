//! What hair meets: spheres, capsules and the signed distance field of a closed mesh, each moving as a rigid piece.

mod along;
mod grid;
mod obstacle;
mod voxelize;

pub(crate) use along::{deepest, may_cut};
pub use grid::Grid;
pub use obstacle::{Obstacle, ObstaclePose, Rigid};
pub(crate) use obstacle::{contact, contact_at, surface_displacement};
pub use voxelize::{Voxelizer, voxelize};
