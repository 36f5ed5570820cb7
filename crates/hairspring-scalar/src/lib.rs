//! Hairspring's library and its bench scene once more, from the same files, built without SIMD: what `hairspring bench --table` compares with.
//!
//! In place of `fearless_simd` stands `hairspring-one-lane`, under its name. Its public items are those of `hairspring`, and are described there.

// Its unit tests are hairspring's, and run there.
#[cfg(not(test))]
#[path = "../../hairspring/src/lib.rs"]
mod library;

#[cfg(not(test))]
pub use library::*;

// The bench scene names the library it steps.
#[cfg(not(test))]
extern crate self as hairspring;

#[cfg(not(test))]
#[path = "../../hairspring-validate/src/bench.rs"]
pub mod bench;
