//! A spring across all four points of a window. Its force is an unknown of its own, eliminated right after
//! the window's first point.
//!
//! ```text
//! [ A     g  ] [ x ]   [  b ]   g  gradient of its length at each point    s  its extension beyond the rest length
//! [ gᵀ  −1/k ] [ λ ] = [ −s ]   λ  its force, k (s + g·x)
//!
//! downward, with u, y, d and w uᵀ of the first point:    q = L⁻¹ g₀    h_p = g_p − u_pᵀ D⁻¹ q    h₃ = g₃ + u wᵀ D⁻¹ q
//!   which leaves κ h hᵀ and −κ ρ h on the three after it:    1/κ = 1/k + qᵀ D⁻¹ q             ρ = s + qᵀ D⁻¹ y
//! upward:    λ = κ (ρ + h·x)    and then y − λ q replaces y
//! (w uᵀ is the long-range spring's block, see `LongRangeSpring` in `band`)
//! ```
//!
//! Added to the matrix directly, the spring would be the dense block k g gᵀ. Between the first point and the
//! last, however, a [far](Profile::far) profile has room for a single spring, and that place is taken.
//!
//! As an unknown of its own, the force adds entries to the three points after it and stores a few numbers for
//! the first point. Only points that have such a spring store them. The solution is the same. The pivots of
//! such a matrix have known signs in any order: Vanderbei 1995, *Symmetric Quasidefinite Matrices*.

use super::{
    profile::Profile,
    system::{PendingRows, System},
};
use crate::simd::lanes::{F, M3, Simd, Sym3, V3, Work, load, store};

/// A spring across all points of a window of four points.
#[derive(Clone, Copy)]
pub struct BorderedConstraint<S: Simd> {
    /// Gradient of the spring's length at each point [1].
    pub gradient: [V3<S>; 4],
    /// Extension beyond the rest length at the starting point of the solve [m].
    pub extension: F<S>,
    /// Stiffness [N/m].
    pub stiffness: F<S>,
}

/// What back substitution needs of a spring whose force was eliminated.
#[derive(Clone, Copy)]
pub struct Eliminated {
    /// The point after which it was eliminated.
    pub point: usize,
    /// κ, ρ, q, and h of the three points after it; see the module documentation.
    pivot: Work,
    right: Work,
    q: [Work; 3],
    h: [[Work; 3]; 3],
}

impl<S: Simd> BorderedConstraint<S> {
    /// A spring without stiffness.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = F::splat(simd, 0.0);
        Self { gradient: [V3::zero(simd); 4], extension: zero, stiffness: zero }
    }

    /// The force on each point [N].
    #[inline(always)]
    pub fn forces(&self) -> [V3<S>; 4] {
        let pull = -(self.stiffness * self.extension);
        let [a, b, c, d] = self.gradient;
        [a * pull, b * pull, c * pull, d * pull]
    }

    /// Eliminates the spring's force. Point `i`, the first of the four, must have been
    /// [eliminated](super::band::Band::eliminate) or [skipped](super::band::Band::skip_row).
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn eliminate<const B: usize, const N: usize>(
        &self,
        simd: S,
        profile: Profile<B, N>,
        i: usize,
        factors: &mut [Work],
    ) -> Eliminated {
        let &Self { gradient: [g0, mut h1, mut h2, h3], extension, stiffness } = self;
        let point = &factors[(i + Profile::<B, N>::REACH) * profile.rows()..][..profile.rows()];
        let mut q = [g0.x, g0.y, g0.z];
        let zero = F::<S>::splat(simd, 0.0);
        let (mut squares, mut right, mut long_range) = (zero, extension, zero);
        for k in 0..3 {
            // The factors from unknown k+1 of the window on.
            let u = &point[profile.row(k)..];
            // For a pivot d, −1/d is stored.
            let l = q[k] * load(simd, &point[profile.pivot(k)]);
            for r in k + 1..3 {
                q[r] = l.mul_add(load(simd, &u[r - k - 1]), q[r]);
            }
            h1 = V3::load(simd, &u[B - k - 1..]).mul_add(l, h1);
            h2 = V3::load(simd, &u[2 * B - k - 1..]).mul_add(l, h2);
            long_range = l.mul_add(load(simd, &point[profile.far_row(k)]), long_range);
            squares = (-l).mul_add(q[k], squares);
            right = (-l).mul_add(load(simd, &u[profile.last(k) - k]), right);
        }
        let h = [h1, h2, h3 - V3::load(simd, &point[profile.far_row(B)..]) * long_range];
        let pivot = stiffness / stiffness.mul_add(squares, F::splat(simd, 1.0));
        let pending = &mut PendingRows::<B, N>::new(profile, i + 1, factors);
        for p in 0..3 {
            let scaled = h[p] * pivot;
            pending.add_force(p, -(scaled * right));
            pending.add_diagonal(p, Sym3::outer(h[p], pivot));
            for (q, h) in h.into_iter().enumerate().skip(p + 1) {
                pending.add_block(p, q, &M3 { rows: [h * scaled.x, h * scaled.y, h * scaled.z] });
            }
        }
        let mut rows = [Work::default(); 5];
        for (row, value) in rows.iter_mut().zip([pivot, right, q[0], q[1], q[2]]) {
            store(value, row);
        }
        let [pivot, right, q @ ..] = rows;
        let mut kept = [[Work::default(); 3]; 3];
        for (rows, h) in kept.iter_mut().zip(h) {
            h.store(rows);
        }
        Eliminated { point: i, pivot, right, q, h: kept }
    }
}

impl Eliminated {
    /// Computes the spring's force from the unknowns of the three points after it, and subtracts its effect
    /// from the right-hand side of its own point.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn back_substitute<S: Simd, const B: usize, const N: usize>(
        &self,
        simd: S,
        profile: Profile<B, N>,
        after: &[F<S>; N],
        factors: &mut [Work],
    ) {
        let mut length = load(simd, &self.right);
        for (p, h) in self.h.iter().enumerate() {
            let x = V3 { x: after[p * B], y: after[p * B + 1], z: after[p * B + 2] };
            length += V3::load(simd, h).dot(x);
        }
        let force = length * load(simd, &self.pivot);
        let point = &mut factors[(self.point + Profile::<B, N>::REACH) * profile.rows()..][..profile.rows()];
        for (k, q) in self.q.iter().enumerate() {
            let right = &mut point[profile.row(k) + profile.last(k) - k];
            store((-force).mul_add(load(simd, q), load(simd, right)), right);
        }
    }
}
