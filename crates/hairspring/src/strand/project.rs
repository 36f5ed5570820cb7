//! Fast projection: the smallest displacement, in the mass metric, that restores all segments to their rest
//! lengths.
//!
//! ```text
//!   C = (ℓ²/L − L) / 2,   ∇C = e/L at the outer point, −e/L at the inner;      (∇C M⁻¹ ∇Cᵀ) λ = C,   Δx = −M⁻¹ ∇Cᵀ λ
//! ```
//!
//! Goldenthal et al. 2007, *Efficient Simulation of Inextensible Cloth*, §3 and §4. The constraints of a
//! strand form a scalar tridiagonal system, which one upward and one downward sweep solve exactly (Thomas
//! algorithm). The upward sweep runs together with that of the solve. This form of C needs no square root and
//! no unit vector. The root and the second point are driven.

use super::{
    precomputed::Precomputed,
    scratch::Scratch,
    tile::{Tile, rest, state, strand},
};
use crate::simd::lanes::{F, Mask, Simd, V3, Work, load, store};
use scratch::{C, D};

/// Rows of scratch a segment: the coefficient of the previous λ, and the part of λ that is independent of it.
pub mod scratch {
    /// Coefficient of the previous λ.
    pub const C: usize = 0;
    /// Independent part of λ.
    pub const D: usize = 1;
    /// Rows a segment.
    pub const ROWS: usize = 2;
}

/// Lower bound of the squared relative length in the gradient [1]. The gradient of C vanishes with the
/// segment's length, and without a bound the step would become arbitrarily large.
const MIN_SQUARED_LENGTH: f32 = 0.25;

/// Relative length error below which projection stops [1], for a strand of [`SHORT_STRAND`] points. The
/// tolerance is smaller for longer strands, which otherwise vibrate when all of their segments are corrected
/// at once.
const LENGTH_TOLERANCE: f32 = 1e-4;

/// Number of points up to which [`LENGTH_TOLERANCE`] applies.
const SHORT_STRAND: f32 = 32.0;

/// The state of an iteration in its upward sweep, from the tip to the current segment.
pub struct Projection<S: Simd> {
    /// The segment's vector over its rest length [1].
    u: V3<S>,
    /// Inverse mass of the segment's inner point [1/kg].
    inner: F<S>,
    /// Inverse pivot of its row.
    inverse: F<S>,
    /// The part of its λ that is independent of the previous λ.
    d: F<S>,
    /// Largest excess of a length error over the tolerance [m]; not positive if all lengths are within
    /// tolerance.
    worst: F<S>,
    /// The tolerance.
    enough: Enough<S>,
}

impl<S: Simd> Projection<S> {
    /// Starts beyond the tip.
    #[inline(always)]
    pub fn begin(simd: S, tile: &Tile, fixed: &[Precomputed]) -> Self {
        let zero = F::<S>::splat(simd, 0.0);
        let tip = load(simd, &fixed[tile.rest.len() - 1].inverse_mass);
        let (u, enough) = (V3::zero(simd), Enough::of(simd, tile));
        Self { u, inner: tip, inverse: zero, d: zero, worst: zero, enough }
    }

    /// Returns a copy that the compiler can keep in registers. It keeps what a function returned that is not inlined in
    /// memory.
    #[inline(always)]
    pub fn in_registers(self) -> Self {
        let Self { u, inner, inverse, d, worst, enough } = self;
        Self { u, inner, inverse, d, worst, enough }
    }

    /// Eliminates the segment from point `i` to the strand's next, as in `scratch.edges`. The first segment
    /// is driven by the root and must not be passed.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn eliminate(&mut self, simd: S, (stride, i): (usize, usize), tile: &Tile, scratch: &mut Scratch) {
        let Scratch { pulls, edges, fixed, .. } = scratch;
        let length = load(simd, &tile.rest[i][rest::LENGTH]);
        let [inner, inverse_length] =
            [&fixed[i].inverse_mass, &fixed[i].inverse_length].map(|r| load(simd, r));
        let (outer, u) = (self.inner, segment(simd, stride, edges, i) * inverse_length);
        let size = u.dot(u);
        // No constraint between two fixed points.
        let (error, excess) = self.enough.error(length, size, (inner + outer).simd_gt(0.0));
        self.worst = self.worst.max(excess);
        // Row i: −w0 (u·u₋) λ₋ + (w0 + w1) u·u λ − w1 (u·u₊) λ₊ = C
        let coupling = outer * u.dot(self.u);
        let c = coupling * self.inverse;
        store(c, &mut pulls[i + stride][C]);
        let pivot = (-coupling).mul_add(c, (inner + outer) * size.max(MIN_SQUARED_LENGTH));
        let inverse = F::splat(simd, 1.0) / pivot.max(1e-30);
        let d = coupling.mul_add(self.d, error) * inverse;
        store(d, &mut pulls[i][D]);
        (self.u, self.inner, self.inverse, self.d) = (u, inner, inverse, d);
    }

    /// Eliminates all segments of `scratch.edges`.
    #[inline(always)]
    pub fn eliminate_all(simd: S, stride: usize, tile: &Tile, scratch: &mut Scratch) -> Self {
        let mut projection = Self::begin(simd, tile, scratch.fixed);
        for k in (1..(tile.rest.len() - 1) / stride).rev() {
            projection.eliminate(simd, (stride, k * stride), tile, scratch);
        }
        projection
    }

    /// Moves the points of the strands in `selected` after all segments have been eliminated, and adds λ times
    /// `force` (a/h² of the integrator) to the tensions. Returns false if all lengths were within tolerance
    /// before, or are now.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn move_points(
        self,
        simd: S,
        stride: usize,
        (force, selected): (F<S>, Mask<S>),
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> bool {
        // Strands within tolerance are not changed, so that their result does not depend on their neighbors
        // in the tile.
        let active = selected & self.worst.simd_gt(0.0);
        if !active.any_true() {
            return false;
        }
        let n = tile.rest.len();
        // Slices of a common length, so that the loop needs no bounds checks.
        let (rest, state) = (&tile.rest[..n], &mut tile.state[..n]);
        let (pulls, fixed, edges) = (&mut scratch.pulls[..n], &scratch.fixed[..n], &mut *scratch.edges);
        let zero = F::<S>::splat(simd, 0.0);
        store(zero, &mut pulls[stride][C]);
        // No segment begins at the tip.
        pulls[n - 1] = Default::default();
        // Downward sweep: λ_i = d_i + c_i λ_{i−1};  Δx_i = w (u_i λ_i − u_{i−1} λ_{i−1}). The final length of
        // a segment is known after both of its ends have moved.
        let (mut lambda, mut pull, mut worst) = (zero, V3::zero(simd), zero);
        let (mut before, mut waiting) = (0, segment(simd, stride, edges, 0));
        let mut i = stride;
        while i < n {
            let s = segment(simd, stride, edges, i);
            let d = load(simd, &pulls[i][D]);
            lambda = active.select(load(simd, &pulls[i][C]).mul_add(lambda, d), zero);
            let own = s * load(simd, &fixed[i].inverse_length) * lambda;
            let w = load(simd, &fixed[i].inverse_mass);
            let moved = (own - pull) * w;
            // The edge that ends at the moved point, and the one that begins there.
            let arriving = if stride == 1 { waiting } else { V3::load(simd, &edges[i]) } + moved;
            arriving.store(&mut edges[i]);
            if stride == 2 && i + 1 < n {
                (V3::load(simd, &edges[i + 1]) - moved).store(&mut edges[i + 1]);
            }
            waiting = s - moved;
            // Computed bitwise as in the next upward sweep. Otherwise, whether a strand is iterated again
            // could depend on its neighbors in the tile.
            let now = if stride == 1 { arriving } else { segment(simd, stride, edges, before) };
            let size = now * load(simd, &fixed[before].inverse_length);
            let loose = (load(simd, &fixed[before].inverse_mass) + w).simd_gt(0.0);
            let length = load(simd, &rest[before][rest::LENGTH]);
            worst = worst.max(self.enough.error(length, size.dot(size), loose).1);
            let tension = &mut state[i][state::TENSION];
            store(lambda.mul_add(force, load(simd, tension)), tension);
            pull = own;
            before = i;
            i += stride;
        }
        (selected & worst.simd_gt(0.0)).any_true()
    }
}

/// Relative tolerance of a length [1].
struct Enough<S: Simd>(F<S>);

impl<S: Simd> Enough<S> {
    /// For the strands of a tile.
    #[inline(always)]
    fn of(simd: S, tile: &Tile) -> Self {
        let shorter = F::splat(simd, SHORT_STRAND) / load(simd, &tile.strand[strand::POINTS]);
        Self(shorter.min(1.0) * LENGTH_TOLERANCE)
    }

    /// Returns the length error of a segment, from the square of its relative length, and the excess of the
    /// error over the tolerance. The error is 0 where the segment is not `loose`. For padding, which has
    /// neither length nor inverse length, both are 0.
    #[inline(always)]
    fn error(&self, length: F<S>, size: F<S>, loose: Mask<S>) -> (F<S>, F<S>) {
        let half = F::splat(length.simd, -0.5);
        let error = loose.select(length * size.mul_add(0.5, half), F::splat(length.simd, 0.0));
        (error, length.mul_add(-self.0, error.abs()))
    }
}

/// From particle `i` to the strand's next point.
#[inline(always)]
fn segment<S: Simd>(simd: S, stride: usize, edges: &[[Work; 3]], i: usize) -> V3<S> {
    let last = V3::load(simd, &edges[i + stride]);
    if stride == 1 { last } else { V3::load(simd, &edges[i + 1]) + last }
}
