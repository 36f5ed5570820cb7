//! Real-time strand hair as mass-spring chains, solved implicitly by a direct banded solver whose cost is
//! linear in the strand's points.
//!
//! SI units throughout: metres, kilograms, seconds, newtons, pascals; right-handed, Y up.

pub mod air;
pub mod body;
pub mod collide;
pub mod follow;
pub mod forces;
pub mod groom;
pub mod material;
pub mod scene;
pub mod simulation;
pub mod stage;
pub(crate) mod strand;
pub(crate) mod strand_contact;
pub(crate) mod timed;
pub mod validate;
pub(crate) mod volume;

// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
