//! Settings of a simulation as plain data. The default of each field is the value that a scene file may leave out.

mod effects;
mod neighbours;
mod solver;
mod volume;
mod wind;

pub use effects::Effects;
pub use neighbours::Neighbours;
pub use solver::{Integrator, Quality, Response, Solver};
pub use volume::{Volume, VolumeMethod};
pub use wind::Wind;
