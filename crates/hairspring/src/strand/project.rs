//! Fast projection: the shortest move, in the metric of mass, onto equal rest lengths.
//!
//! ```text
//!   C = (ℓ²/L − L) / 2,   ∇C = e/L at the outer point, −e/L at the inner;      (∇C M⁻¹ ∇Cᵀ) λ = C,   Δx = −M⁻¹ ∇Cᵀ λ
//! ```
//!
//! Goldenthal et al. 2007, *Efficient Simulation of Inextensible Cloth*, §3 and §4: a scalar tridiagonal system for a strand, solved
//! exactly by one sweep down and one up (Thomas). Their C needs no root and no unit vector. The root and the second point are driven.

use super::{
    lanes::{F, Row, V3, load, store},
    scratch::Scratch,
    tile::{Tile, rest, state, strand},
};
use fearless_simd::{mask32x8, prelude::*};

/// Rows of scratch a segment: the coefficient of the next λ, and λ without it.
const ROWS: usize = 2;
/// The first of them.
const C: usize = 0;
/// The second.
const D: usize = 1;

/// Square of the relative length from which on down the gradient counts as if it were no shorter [1]: C's vanishes with the segment, and the
/// step that it would ask for grows without end.
const SHORT: f32 = 0.25;

/// Relative length error below which no further iteration is made [1], of a strand of [`SHORT_STRAND`] points; less in longer ones, which
/// otherwise tremble with what all of their segments are let off at once.
const ENOUGH: f32 = 1e-4;

/// Points of a strand, see [`ENOUGH`].
const SHORT_STRAND: f32 = 32.0;

/// One iteration over `scratch.edges`, of every `stride`th particle, in the strands that are `asked`; false where all their lengths are
/// right, before it or after. λ times `force` (a/h² of the integrator) goes into the tension.
#[inline(always)]
pub fn project<S: Simd>(
    simd: S,
    stride: usize,
    (force, asked): (F<S>, mask32x8<S>),
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> bool {
    let Scratch { factors, edges, fixed, .. } = scratch;
    let zero = F::<S>::splat(simd, 0.0);
    let points = tile.rest.len();
    let segments = (points - 1) / stride;
    let work = &mut factors.as_chunks_mut::<ROWS>().0[..segments];
    let shorter = (F::splat(simd, SHORT_STRAND) / load(simd, &tile.strand[strand::POINTS])).min(1.0);
    let enough = shorter * -ENOUGH;
    // Error of a segment's length, from the square of its relative length, and by how much it is more than enough. Padding has neither length
    // nor inverse length: all of its row is nought.
    let error = |length: F<S>, size: F<S>, loose: mask32x8<S>| {
        let error = loose.select(length * size.mul_add(0.5, F::splat(simd, -0.5)), zero);
        (error, length.mul_add(enough, error.abs()))
    };
    let mut before = V3::zero(simd);
    let (mut d_before, mut inv_before) = (zero, zero);
    let mut worst = zero;
    let mut w0 = zero;
    for k in 1..segments {
        let i = k * stride;
        let length = load(simd, &tile.rest[i][rest::LENGTH]);
        let w1 = load(simd, &fixed[i + stride].inverse_mass);
        let u = segment(simd, stride, edges, i) * load(simd, &fixed[i].inverse_length);
        let size = u.dot(u);
        // Nothing to do between two points that are held.
        let (error, excess) = error(length, size, (w0 + w1).simd_gt(0.0));
        worst = worst.max(excess);
        // Row i: −w0 (u·u₋) λ₋ + (w0 + w1) u·u λ − w1 (u·u₊) λ₊ = C
        let coupling = w0 * before.dot(u);
        let c_before = coupling * inv_before;
        store(c_before, &mut work[k - 1][C]);
        let inv = F::splat(simd, 1.0) / (-coupling).mul_add(c_before, (w0 + w1) * size.max(SHORT)).max(1e-30);
        let d = coupling.mul_add(d_before, error) * inv;
        store(d, &mut work[k][D]);
        (before, d_before, inv_before, w0) = (u, d, inv, w1);
    }
    // Strands whose lengths are right keep their bits, whatever their neighbours in the tile do.
    let active = asked & worst.simd_gt(0.0);
    if !active.any_true() {
        return false;
    }
    store(zero, &mut work[segments - 1][C]);
    // Up: λ_i = d_i + c_i λ_{i+1};  Δx_{i+1} = −w (u_i λ_i − u_{i+1} λ_{i+1}). A segment has its length once both of its ends have moved.
    let (mut lambda, mut pull) = (zero, V3::zero(simd));
    let mut waiting = V3::zero(simd);
    let mut w_outer = zero;
    worst = zero;
    for k in (1..segments).rev() {
        let i = k * stride;
        let s = segment(simd, stride, edges, i);
        let u = s * load(simd, &fixed[i].inverse_length);
        let d = load(simd, &work[k][D]);
        lambda = load(simd, &work[k][C]).mul_add(lambda, d);
        lambda = active.select(lambda, zero);
        let own = u * lambda;
        let w = load(simd, &fixed[i + stride].inverse_mass);
        let move_outer = (pull - own) * w;
        waiting -= move_outer;
        // The edge into the point that moves, and the one out of it.
        let last = V3::load(simd, &edges[i + stride]) + move_outer;
        last.store(&mut edges[i + stride]);
        let after = i + stride;
        if after + stride < points {
            let first = if stride == 1 { waiting } else { V3::load(simd, &edges[after + 1]) - move_outer };
            first.store(&mut edges[after + 1]);
            // Summed as the next sweep down would, to the bit: where the two differed, it would depend on a strand's neighbours in the tile
            // whether it is asked again.
            let now = if stride == 1 { waiting } else { segment(simd, stride, edges, after) };
            let size = now * load(simd, &fixed[after].inverse_length);
            let loose = (w + w_outer).simd_gt(0.0);
            worst = worst.max(error(load(simd, &tile.rest[after][rest::LENGTH]), size.dot(size), loose).1);
        }
        waiting = s + move_outer;
        w_outer = w;
        let tension = &mut tile.state[i][state::TENSION];
        store(lambda.mul_add(force, load(simd, tension)), tension);
        pull = own;
    }
    let size = segment(simd, stride, edges, stride) * load(simd, &fixed[stride].inverse_length);
    let first = error(load(simd, &tile.rest[stride][rest::LENGTH]), size.dot(size), w_outer.simd_gt(0.0)).1;
    (asked & worst.max(first).simd_gt(0.0)).any_true()
}

/// From particle `i` to the strand's next point.
#[inline(always)]
fn segment<S: Simd>(simd: S, stride: usize, edges: &[[Row; 3]], i: usize) -> V3<S> {
    let last = V3::load(simd, &edges[i + stride]);
    if stride == 1 { last } else { V3::load(simd, &edges[i + 1]) + last }
}
