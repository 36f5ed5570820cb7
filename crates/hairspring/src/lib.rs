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
pub mod math;
pub mod settings;
pub(crate) mod simd;
pub mod simulation;
pub(crate) mod strand;
pub(crate) mod strand_contact;
pub(crate) mod volume;
