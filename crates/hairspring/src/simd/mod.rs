//! Eight lanes of numbers, vectors and small matrices, and the choice of the instruction set.

// These types are reachable only through traits that no public function names.
#![allow(missing_debug_implementations)]

pub(crate) mod dispatch;
pub(crate) mod lanes;
pub(crate) mod precision;
