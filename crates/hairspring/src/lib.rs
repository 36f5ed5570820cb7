//! Real-time simulation of strand hair. Strands are mass-spring chains, integrated implicitly by a direct
//! banded solver whose cost is linear in the number of points of a strand.
//!
//! All quantities are in SI units: meters, kilograms, seconds, newtons, pascals. Coordinates are
//! right-handed, with Y up.

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
