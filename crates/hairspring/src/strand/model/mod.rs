//! What holds a strand together: elastic models, each a sweep's worth of elements for the band.
//!
//! | model | unknowns a point | half-bandwidth | |
//! | --- | --: | --: | --- |
//! | [`Springs`] | 3 | 3 | stretch, bend, torsion and altitude springs (Selle et al. 2008) |
//! | [`Curvature`] | 3 | 2 | stretch and the curvature vector, in a frame carried from the root |
//! | [`Rod`] | 4 | 2 | curvature in a frame that twists (discrete elastic rod) |
//!
//! Stretch of the segments is the same in all (see `stretch`).

pub mod bend;
pub mod curvature;
mod rod;
pub mod stretch;

pub use curvature::Curvature;
pub use rod::Rod;

use super::{
    band::Band,
    lanes::{F, Row, V3},
    root::Root,
    tile::Tile,
};
use fearless_simd::prelude::*;

/// What is known where the elements that begin at point `i` are added: segments i and i+1 around joint i+1.
#[derive(Clone, Copy)]
pub struct At<S: Simd> {
    /// The window's first point.
    pub i: usize,
    /// Segments i and i+1 [m].
    pub e: [V3<S>; 2],
    /// Their unit vectors; zero for padding.
    pub u: [V3<S>; 2],
    /// Their inverse rest lengths [1/m]; zero for padding.
    pub inverse_length: [F<S>; 2],
    /// 1 + τ/h: how much stiffer bending is in the matrix, for its damping τ.
    pub damped: F<S>,
    /// Length of the substep [s].
    pub h: f32,
}

/// An elastic model: what it adds to the band of `B` unknowns a point in a window of `N`, point after point.
pub trait Model<S: Simd, const B: usize, const N: usize>: Sized {
    /// Starts at the root of a strand.
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self;

    /// Adds all elements whose first point is `at.i`, which is the band's first.
    fn add(&mut self, simd: S, at: &At<S>, x: &[[Row; 3]], tile: &mut Tile, band: &mut Band<S, B, N>);

    /// Takes the solved unknowns of point `i` that are no displacement; `u` is the segment from it before the solve.
    fn take(simd: S, i: usize, u: V3<S>, unknowns: &[F<S>; N], tile: &mut Tile);
}
