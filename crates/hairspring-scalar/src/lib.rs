//! A second build of Hairspring's library without SIMD, from the same source files. `hairspring bench
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
