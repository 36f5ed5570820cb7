//! What hair meets: spheres, capsules and the signed distance field of a closed mesh, each moving as a rigid piece.

mod grid;
mod obstacle;
mod voxelize;

pub use grid::Grid;
pub use obstacle::{Obstacle, ObstaclePose, Rigid};
pub(crate) use obstacle::{contact, surface_displacement};
pub use voxelize::{Voxelizer, voxelize};
