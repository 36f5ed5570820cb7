//! The banded direct solver: block LDLᵀ without pivoting, 3×3 blocks, half-bandwidth 2, one sweep down, one up.
//!
//! ```text
//!        i   i+1  i+2
//!   i  [ D0   U1   U2 ]        D symmetric, A positive definite
//!  i+1 [ ·    D1   V1 ]        eliminating i:  D1 −= U1ᵀD0⁻¹U1   V1 −= U1ᵀD0⁻¹U2   D2 −= U2ᵀD0⁻¹U2
//!  i+2 [ ·    ·    D2 ]        and on the right: b1 −= U1ᵀD0⁻¹b0,  b2 −= U2ᵀD0⁻¹b0
//! ```
//!
//! Right-looking, so that the rows below the one being eliminated can still be assembled while it goes: the matrix
//! is never stored, only the factors `W1 = D0⁻¹U1`, `W2 = D0⁻¹U2` and `y = D0⁻¹b0`, 21 rows a point.
//! Golub & Van Loan, *Matrix Computations*, 4th ed., §4.5.1 (block LDLᵀ).

use super::lanes::{M3, Row, Sym3, V3};
use fearless_simd::prelude::*;

/// Rows of factors that [`Band::eliminate`] writes for a point: W1, W2, y.
pub const FACTOR_ROWS: usize = 21;

/// Factors of one point.
pub type Factors = [Row; FACTOR_ROWS];

/// The part of the matrix that is being worked on: points i, i+1 and i+2, of eight strands.
pub struct Band<S: Simd> {
    /// Diagonal blocks of i, i+1, i+2.
    pub diag: [Sym3<S>; 3],
    /// Blocks (i, i+1) and (i+1, i+2).
    pub upper: [M3<S>; 2],
    /// Block (i, i+2).
    pub far: M3<S>,
    /// Right-hand sides of i, i+1, i+2.
    pub rhs: [V3<S>; 3],
}

impl<S: Simd> Band<S> {
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let zero = Sym3::scaled_identity(super::lanes::F::<S>::splat(simd, 0.0));
        Self { diag: [zero; 3], upper: [M3::zero(simd); 2], far: M3::zero(simd), rhs: [V3::zero(simd); 3] }
    }

    /// Eliminates point i and writes its factors.
    #[inline(always)]
    pub fn eliminate(&mut self, factors: &mut Factors) {
        let inverse = self.diag[0].inverse();
        let w1 = inverse.mul_mat(&self.upper[0]);
        let w2 = inverse.mul_mat(&self.far);
        let y = inverse.mul_vec(self.rhs[0]);
        w1.store(&mut factors[0..9]);
        w2.store(&mut factors[9..18]);
        y.store(&mut factors[18..21]);
        self.diag[1] = self.diag[1].minus_transposed_product(&self.upper[0], &w1);
        self.diag[2] = self.diag[2].minus_transposed_product(&self.far, &w2);
        self.upper[1] = self.upper[1].minus_transposed_product(&self.upper[0], &w2);
        self.rhs[1] = self.upper[0].transposed_mul_sub_from(y, self.rhs[1]);
        self.rhs[2] = self.far.transposed_mul_sub_from(y, self.rhs[2]);
    }

    /// Moves on to the next point; the new i+2 and (i, i+2) start at zero.
    #[inline(always)]
    pub fn shift(&mut self, simd: S) {
        let fresh = Self::new(simd);
        self.diag = [self.diag[1], self.diag[2], fresh.diag[2]];
        self.upper = [self.upper[1], fresh.upper[1]];
        self.far = fresh.far;
        self.rhs = [self.rhs[1], self.rhs[2], fresh.rhs[2]];
    }
}

/// The sweep up: Δx of a point from its factors and the two points below it.
#[inline(always)]
pub fn back_substitute<S: Simd>(simd: S, factors: &Factors, next: V3<S>, after: V3<S>) -> V3<S> {
    let w1 = M3::load(simd, &factors[0..9]);
    let w2 = M3::load(simd, &factors[9..18]);
    V3::load(simd, &factors[18..21]) - w1.mul_vec(next) - w2.mul_vec(after)
}
