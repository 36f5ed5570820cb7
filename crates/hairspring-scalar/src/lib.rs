//! Hairspring's library once more, from the same files, built without SIMD: what `hairspring bench --table` compares with.
//!
//! In place of `fearless_simd` stands `hairspring-one-lane`, under its name. Its public items are those of `hairspring`, and are described there.

// Its unit tests are hairspring's, and run there.
#[cfg(not(test))]
#[path = "../../hairspring/src/lib.rs"]
mod library;

#[cfg(not(test))]
pub use library::*;
