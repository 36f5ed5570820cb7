//! Settings of a simulation as plain data. The default of each field is the value that a scene file may leave out.
//!
//! Fields may be added in a minor version: write `..Default::default()`, also where all present fields are given.
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
