//! Eight lanes of numbers, vectors and small matrices, and the choice of the instruction set.

pub(crate) mod dispatch;
pub(crate) mod lanes;
pub(crate) mod precision;
