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
pub mod springs;
pub mod stretch;

pub use curvature::Curvature;
pub use rod::Rod;
pub use springs::Springs;
pub use stretch::Stretching;

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
    /// What holds the segments' lengths.
    pub stretching: Stretching,
}

/// What is known of a point once its solve is done, root-ward from the tip.
pub struct Solved<S: Simd, const N: usize> {
    /// The point.
    pub i: usize,
    /// It and the two after it before the solve, relative to the root [m].
    pub x: [V3<S>; 3],
    /// Their displacements [m].
    pub moved: [V3<S>; 3],
    /// The unknowns from this point on.
    pub unknowns: [F<S>; N],
    /// Length of the substep [s].
    pub h: f32,
    /// What holds the segments' lengths.
    pub stretching: Stretching,
}

impl<S: Simd, const N: usize> Solved<S, N> {
    /// The tension that the spring to the point `far` after this one, of rest length `length` and stiffness `k`, took in the
    /// solve: k (ℓ − L + û·(δ_far − δ)) [N].
    #[inline(always)]
    pub fn taken(&self, far: usize, length: F<S>, k: F<S>) -> F<S> {
        let (l, u) = (self.x[far] - self.x[0]).length_and_unit();
        k * (l - length + u.dot(self.moved[far] - self.moved[0]))
    }
}

/// An elastic model: what it adds to the band of `B` unknowns a point in a window of `N`, point after point.
pub trait Model<S: Simd, const B: usize, const N: usize>: Sized {
    /// Simulated points from one point of the strand to the next.
    const STRIDE: usize = 1;

    /// Points at the root that are driven: its first segment.
    const DRIVEN: usize = Self::STRIDE + 1;

    /// Starts at the root of a strand.
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self;

    /// Stiffness of the spring along the strand's segment from `point` in a substep of `h` [s]; 0 for padding [N/m].
    #[inline(always)]
    fn along(simd: S, stretching: Stretching, h: f32, tile: &Tile, point: usize) -> F<S> {
        stretching.stiffness(simd, h, tile, point)
    }

    /// Adds all elements whose first point is `at.i`, which is the band's first.
    fn add(&mut self, simd: S, at: &At<S>, x: &[[Row; 3]], tile: &mut Tile, band: &mut Band<S, B, N>);

    /// Takes what the solve found besides displacements.
    fn take(simd: S, solved: &Solved<S, N>, tile: &mut Tile);
}
