//! Settings of a simulation as plain data. [`define_settings!`] defines each parameter once: type, default,
//! unit, range, documentation, and when it has an effect.
//!
//! # Example
//! ```
//! use hairspring::settings::{Integrator, Solver, Validate};
//!
//! let solver = Solver { substeps: 8, integrator: Integrator::Bdf2, ..Default::default() };
//! assert!(solver.validate().is_ok());
//! let refused = Solver { substeps: 0, ..solver }.validate().unwrap_err();
//! assert_eq!(refused.to_string(), "`substeps` must be 1 to 1024");
//! ```

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

pub use check::{Check, OutOfRange, Validate};
// For the expansion of `define_settings!` and the readers of scene files.
#[doc(hidden)]
pub use check::{check, holds, validate_gravity, with_prefix};
pub use define::define_settings;
pub use effects::Effects;
pub use neighbours::Neighbours;
#[doc(hidden)]
pub use parameter::parameter;
pub use parameter::{Fields, Parameter, Setting};
pub use range::Range;
pub use solver::{Integrator, Quality, Response, Solver};
pub use volume::{Volume, VolumeMethod};
pub use when::When;
pub use wind::Wind;
