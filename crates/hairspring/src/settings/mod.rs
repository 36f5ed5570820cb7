//! Settings of a simulation as plain data. [`define_settings!`] defines each parameter once: type, default,
//! unit, range, documentation, and when it has an effect.

mod check;
mod define;
mod effects;
mod neighbours;
mod parameter;
mod range;
mod solver;
mod volume;
mod when;
mod wind;

pub use check::{Check, OutOfRange, Validate, check, holds, with_prefix};
pub use define::define_settings;
pub use effects::Effects;
pub use neighbours::Neighbours;
pub use parameter::{Fields, Parameter, Setting, parameter};
pub use range::Range;
pub use solver::{Integrator, Quality, Response, Solver};
pub use volume::{Volume, VolumeMethod};
pub use when::When;
pub use wind::Wind;
