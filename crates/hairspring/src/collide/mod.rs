//! What hair meets: spheres, capsules, boxes, planes, convex hulls, open sheets and the signed distance field of a closed mesh, each moving as
//! a rigid piece; sheets and fields may deform besides.

mod along;
mod deep;
mod grid;
mod holes;
mod hull;
mod lattice;
mod obstacle;
mod pose;
mod rigid;
mod sheet;
mod side;
mod to_mesh;
mod voxelize;

pub(crate) use along::{Deepest, STEEP, deepest};
pub use grid::Grid;
pub use hull::Hull;
pub use obstacle::Obstacle;
pub use pose::ObstaclePose;
pub(crate) use pose::{contact, surface_displacement};
pub use rigid::Rigid;
pub use sheet::Sheet;
pub(crate) use side::{Edges, Side};
pub use voxelize::{Voxelizer, voxelize};
