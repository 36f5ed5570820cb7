//! Strands: from points in space to shaded pieces on the screen.

pub(crate) mod blend;
pub(crate) mod color;
pub(crate) mod order;
pub(crate) mod project;
pub(crate) mod ribbon;
pub(crate) mod segment;
pub(crate) mod shade;
pub(crate) mod wisp;
