//! One strand, one band: forces, the banded solver and the substep, for eight strands at a time.

pub(crate) mod band;
pub(crate) mod bend;
pub(crate) mod interval;
pub(crate) mod lanes;
pub(crate) mod limit;
pub(crate) mod project;
pub(crate) mod rest_shape;
pub(crate) mod root;
pub(crate) mod stretch;
pub(crate) mod substep;
pub(crate) mod tile;
pub(crate) mod twist;

#[cfg(test)]
mod reference;
#[cfg(test)]
mod tests;
