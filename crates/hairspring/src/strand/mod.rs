//! The strand solver: forces, the banded direct solver and the substep, for eight strands at a time.

#[macro_use]
mod each;

pub(crate) mod assemble;
pub(crate) mod band;
pub(crate) mod bordered;
pub(crate) mod colliders;
pub(crate) mod contact;
pub(crate) mod drag;
pub(crate) mod elements;
pub(crate) mod external;
pub(crate) mod frame_context;
pub(crate) mod friction;
pub(crate) mod integrate;
pub(crate) mod mass;
pub(crate) mod model;
pub(crate) mod post_solve;
pub(crate) mod precomputed;
pub(crate) mod prefetch;
pub(crate) mod profile;
pub(crate) mod project;
pub(crate) mod relax;
pub(crate) mod rest_shape;
pub(crate) mod root;
pub(crate) mod scratch;
pub(crate) mod section;
pub(crate) mod segment;
pub(crate) mod segment_contact;
pub(crate) mod substitute;
pub(crate) mod system;
pub(crate) mod tether;
pub(crate) mod tile;
pub(crate) mod tile_arrays;
pub(crate) mod truss;

#[cfg(test)]
mod momentum;
#[cfg(test)]
mod reference;
#[cfg(test)]
mod tests;
