//! A second build of Hairspring's library and its bench scene without SIMD, from the same source files. `hairspring bench
//! --table` compares with it.
//!
//! `hairspring-one-lane` replaces `fearless_simd` under its name. The public items are those of `hairspring`
//! and are documented there.

// The unit tests run in `hairspring`.
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
