//! The elements of a joint, collected by segment and added to the band at once. Every element of bending and
//! twist is a function of the segments e₀ = x₁ − x₀ and e₁ = x₂ − x₁ only.
//!
//! ```text
//!       x₀        x₁        x₂
//!  x₀ [ H₀₀   H₀₁−H₀₀      −H₀₁   ]      H_ab the Gauss–Newton matrix of the segments a, b
//!  x₁ [   ·   H₀₀−H₀₁−H₀₁ᵀ+H₁₁   H₀₁−H₁₁ ]
//!  x₂ [   ·      ·         H₁₁    ]
//! ```

use crate::{
    simd::lanes::{F, M3, Simd, Sym3, V3},
    strand::{band::Band, system::System},
};

/// Forces and stiffness of a joint with respect to its two segments.
pub struct Joint<S: Simd> {
    /// −∂E/∂e of each segment [N].
    pub pull: [V3<S>; 2],
    /// Block (0, 0) [N/m].
    pub h00: Sym3<S>,
    /// Block (0, 1) [N/m].
    pub h01: M3<S>,
    /// Block (1, 1) [N/m].
    pub h11: Sym3<S>,
}

impl<S: Simd> Joint<S> {
    /// Adds an element with one strain. Its gradient in segment k is `along[k]` times `direction`, and
    /// `force` is stiffness times strain.
    #[inline(always)]
    pub fn add_rank_one(&mut self, direction: V3<S>, along: [F<S>; 2], force: F<S>, stiffness: F<S>) {
        let d = Sym3::outer(direction, stiffness);
        let [a, b] = along;
        self.h00 = d.mul_add(a * a, self.h00);
        self.h11 = d.mul_add(b * b, self.h11);
        self.h01 = self.h01 + (d * (a * b)).full();
        self.pull[0] -= direction * (force * a);
        self.pull[1] -= direction * (force * b);
    }

    /// Adds an element with one strain, given its gradient in each segment [1/m]. `force` is stiffness times
    /// strain [N m].
    #[inline(always)]
    pub fn add_strain(&mut self, [a, b]: [V3<S>; 2], force: F<S>, stiffness: F<S>) {
        let stiff = a * stiffness;
        self.h00 = Sym3::outer(a, stiffness) + self.h00;
        self.h11 = Sym3::outer(b, stiffness) + self.h11;
        self.h01 = self.h01 + M3 { rows: [b * stiff.x, b * stiff.y, b * stiff.z] };
        self.pull[0] -= a * force;
        self.pull[1] -= b * force;
    }

    /// Adds the joint to a band whose window begins at its first point.
    #[inline(always)]
    pub fn add_to<const B: usize, const N: usize>(&self, band: &mut Band<S, B, N>) {
        let Self { pull, h00, h01, h11 } = self;
        band.add_diagonal(0, *h00);
        band.add_block(0, 1, &(*h01 - h00.full()));
        band.add_block(0, 2, &-*h01);
        band.add_diagonal(1, *h00 - h01.plus_transposed() + *h11);
        band.add_block(1, 2, &(*h01 - h11.full()));
        band.add_diagonal(2, *h11);
        band.add_force(0, -pull[0]);
        band.add_force(1, pull[0] - pull[1]);
        band.add_force(2, pull[1]);
    }
}
