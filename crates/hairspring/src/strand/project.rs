//! Fast projection: the shortest move, in the metric of mass, onto equal rest lengths.
//!
//! ```text
//!   C = (ℓ²/L − L) / 2,   ∇C = e/L at the outer point, −e/L at the inner;      (∇C M⁻¹ ∇Cᵀ) λ = C,   Δx = −M⁻¹ ∇Cᵀ λ
//! ```
//!
//! Goldenthal et al. 2007, *Efficient Simulation of Inextensible Cloth*, §3 and §4: a scalar tridiagonal system for a strand, solved
//! exactly by one sweep up and one down (Thomas), of which the first goes along with that of the solve. Their C needs no root and no unit vector.
//! The root and the second point are driven.

use super::{
    precomputed::Precomputed,
    scratch::Scratch,
    tile::{Tile, rest, state, strand},
};
use crate::simd::lanes::{F, Mask, Simd, V3, Work, load, store};
use scratch::{C, D};

/// Rows of scratch a segment: the coefficient of the λ before it, and λ without that.
pub mod scratch {
    /// The first of them.
    pub const C: usize = 0;
    /// The second.
    pub const D: usize = 1;
    /// Rows a segment.
    pub const ROWS: usize = 2;
}

/// Square of the relative length from which on down the gradient counts as if it were no shorter [1]: C's vanishes with the segment, and the
/// step that it would ask for grows without end.
const SHORT: f32 = 0.25;

/// Relative length error below which no further iteration is made [1], of a strand of [`SHORT_STRAND`] points; less in longer ones, which
/// otherwise tremble with what all of their segments are let off at once.
const ENOUGH: f32 = 1e-4;

/// Points of a strand, see [`ENOUGH`].
const SHORT_STRAND: f32 = 32.0;

/// An iteration on its way: what is known of the segments from one on to the tip.
pub struct Projection<S: Simd> {
    /// The segment's vector over its rest length [1].
    u: V3<S>,
    /// Inverse mass of its inner point [1/kg].
    inner: F<S>,
    /// Inverse of its row's pivot.
    inverse: F<S>,
    /// Its λ without what the λ before it adds.
    d: F<S>,
    /// By how much the most wrong of the lengths is more than is enough [m]; not positive where all are right.
    worst: F<S>,
    /// What is enough.
    enough: Enough<S>,
}

impl<S: Simd> Projection<S> {
    /// Past the tip.
    #[inline(always)]
    pub fn begin(simd: S, tile: &Tile, fixed: &[Precomputed]) -> Self {
        let zero = F::<S>::splat(simd, 0.0);
        let tip = load(simd, &fixed[tile.rest.len() - 1].inverse_mass);
        let (u, enough) = (V3::zero(simd), Enough::of(simd, tile));
        Self { u, inner: tip, inverse: zero, d: zero, worst: zero, enough }
    }

    /// Meets the segment from point `i` to the strand's next, as it is in `scratch.edges`. The first, which the root drives, is not met.
    #[inline(always)]
    pub fn meet(&mut self, simd: S, (stride, i): (usize, usize), tile: &Tile, scratch: &mut Scratch) {
        let Scratch { pulls, edges, fixed, .. } = scratch;
        let length = load(simd, &tile.rest[i][rest::LENGTH]);
        let [inner, inverse_length] =
            [&fixed[i].inverse_mass, &fixed[i].inverse_length].map(|r| load(simd, r));
        let (outer, u) = (self.inner, segment(simd, stride, edges, i) * inverse_length);
        let size = u.dot(u);
        // Nothing to do between two points that are held.
        let (error, excess) = self.enough.error(length, size, (inner + outer).simd_gt(0.0));
        self.worst = self.worst.max(excess);
        // Row i: −w0 (u·u₋) λ₋ + (w0 + w1) u·u λ − w1 (u·u₊) λ₊ = C
        let coupling = outer * u.dot(self.u);
        let c = coupling * self.inverse;
        store(c, &mut pulls[i + stride][C]);
        let pivot = (-coupling).mul_add(c, (inner + outer) * size.max(SHORT));
        let inverse = F::splat(simd, 1.0) / pivot.max(1e-30);
        let d = coupling.mul_add(self.d, error) * inverse;
        store(d, &mut pulls[i][D]);
        (self.u, self.inner, self.inverse, self.d) = (u, inner, inverse, d);
    }

    /// Meets all segments of `scratch.edges`.
    #[inline(always)]
    pub fn meet_all(simd: S, stride: usize, tile: &Tile, scratch: &mut Scratch) -> Self {
        let mut projection = Self::begin(simd, tile, scratch.fixed);
        for k in (1..(tile.rest.len() - 1) / stride).rev() {
            projection.meet(simd, (stride, k * stride), tile, scratch);
        }
        projection
    }

    /// Moves the points, in the strands that are `asked`, once all segments are met; false where all their lengths are right, before it or after.
    /// λ times `force` (a/h² of the integrator) goes into the tension.
    #[inline(always)]
    pub fn settle(
        self,
        simd: S,
        stride: usize,
        (force, asked): (F<S>, Mask<S>),
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> bool {
        // Strands whose lengths are right keep their bits, whatever their neighbours in the tile do.
        let active = asked & self.worst.simd_gt(0.0);
        if !active.any_true() {
            return false;
        }
        let n = tile.rest.len();
        // Cut to one length that is known here: the loop needs no checks.
        let (rest, state) = (&tile.rest[..n], &mut tile.state[..n]);
        let (pulls, fixed, edges) = (&mut scratch.pulls[..n], &scratch.fixed[..n], &mut *scratch.edges);
        let zero = F::<S>::splat(simd, 0.0);
        store(zero, &mut pulls[stride][C]);
        // No segment begins at the tip.
        pulls[n - 1] = Default::default();
        // Down: λ_i = d_i + c_i λ_{i−1};  Δx_i = w (u_i λ_i − u_{i−1} λ_{i−1}). A segment has its length once both of its ends have moved.
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
            // The edge into the point that moves, and the one out of it.
            let arriving = if stride == 1 { waiting } else { V3::load(simd, &edges[i]) } + moved;
            arriving.store(&mut edges[i]);
            if stride == 2 && i + 1 < n {
                (V3::load(simd, &edges[i + 1]) - moved).store(&mut edges[i + 1]);
            }
            waiting = s - moved;
            // Summed as the next sweep up would, to the bit: where the two differed, it would depend on a strand's neighbours in the tile whether it
            // is asked again.
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
        (asked & worst.simd_gt(0.0)).any_true()
    }
}

/// What error of a length is enough, over the length [1].
struct Enough<S: Simd>(F<S>);

impl<S: Simd> Enough<S> {
    /// Of the strands of a tile.
    #[inline(always)]
    fn of(simd: S, tile: &Tile) -> Self {
        let shorter = F::splat(simd, SHORT_STRAND) / load(simd, &tile.strand[strand::POINTS]);
        Self(shorter.min(1.0) * ENOUGH)
    }

    /// Error of a segment's length, from the square of its relative length, and by how much it is more than enough; none where it is not `loose`. Padding
    /// has neither length nor inverse length: all of its row is nought.
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
