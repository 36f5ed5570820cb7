//! Settings of a simulation as plain data. The default of each field is the value that a scene file may leave out.

mod check;
mod effects;
mod neighbours;
mod solver;
mod volume;
mod wind;

pub use check::{Check, OutOfRange, Validate, above_0, check, from_0};
pub use effects::Effects;
pub use neighbours::Neighbours;
pub use solver::{Integrator, Quality, Response, Solver};
pub use volume::{Volume, VolumeMethod};
pub use wind::Wind;
pub(crate) use wind::gusts;
