//! Fast projection: the shortest move, in the metric of mass, onto equal rest lengths.
//!
//! Goldenthal et al. 2007, *Efficient Simulation of Inextensible Cloth*, §4: (∇C M⁻¹ ∇Cᵀ) λ = C, which is a scalar tridiagonal
//! system for a strand; solved exactly by one sweep down and one up (Thomas). The root and the second point are driven.

use super::{
    lanes::{F, Row, V3, load, store},
    tile::{Tile, rest, state},
};
use fearless_simd::prelude::*;

/// Rows of scratch a segment.
pub mod scratch {
    /// Unit vector of the segment, 3 rows.
    pub const U: usize = 0;
    /// Coefficient of the next λ.
    pub const C: usize = 3;
    /// λ without the next.
    pub const D: usize = 4;
    /// Rows a segment.
    pub const ROWS: usize = 5;
}

/// Relative length error below which no further iteration is made [1].
const ENOUGH: f32 = 1e-4;

/// One iteration over `x` of shape `[points]`, of which every `STRIDE`th is the strand's; false once the lengths were already right. λ times
/// `force` (a/h² of the integrator) goes into the tension.
#[inline(always)]
pub fn project<S: Simd, const STRIDE: usize>(
    simd: S,
    force: f32,
    tile: &mut Tile,
    inverse_mass: &[Row],
    x: &mut [[Row; 3]],
    work: &mut [Row],
) -> bool {
    let zero = F::<S>::splat(simd, 0.0);
    // Cut to one length, so that the loops need no checks.
    let points = tile.rest.len();
    let (x, inverse_mass) = (&mut x[..points], &inverse_mass[..points]);
    let (rest, state) = (&tile.rest[..points], &mut tile.state[..points]);
    let segments = (points - 1) / STRIDE;
    let work = &mut work.as_chunks_mut::<{ scratch::ROWS }>().0[..segments];
    let mut here = V3::load(simd, &x[STRIDE]);
    let mut before = V3::zero(simd);
    let (mut d_before, mut inv_before) = (zero, zero);
    let mut worst = zero;
    let mut w0 = zero;
    for k in 1..segments {
        let i = k * STRIDE;
        let next = V3::load(simd, &x[i + STRIDE]);
        let length = load(simd, &rest[i][rest::LENGTH]);
        let real = length.simd_gt(0.0);
        let (l, u) = (next - here).length_and_unit();
        let w1 = load(simd, &inverse_mass[i + STRIDE]);
        // Nothing to do between two points that are held.
        let real = real & (w0 + w1).simd_gt(0.0);
        let u = V3::select(real, u, V3::zero(simd));
        let error = real.select(l - length, zero);
        worst = worst.max(error.abs() - length * ENOUGH);
        // Row i: −w0 (û·û₋) λ₋ + (w0 + w1) λ − w1 (û·û₊) λ₊ = ℓ − L
        let coupling = w0 * before.dot(u);
        let c_before = coupling * inv_before;
        store(c_before, &mut work[k - 1][scratch::C]);
        let inv = F::splat(simd, 1.0) / (-coupling).mul_add(c_before, w0 + w1).max(1e-30);
        let d = coupling.mul_add(d_before, error) * inv;
        let out = &mut work[k];
        u.store(&mut out[scratch::U..]);
        store(d, &mut out[scratch::D]);
        (before, d_before, inv_before, w0, here) = (u, d, inv, w1, next);
    }
    // Strands whose lengths are right keep their bits, whatever their neighbours in the tile do.
    let active = worst.simd_gt(0.0);
    if !active.any_true() {
        return false;
    }
    store(zero, &mut work[segments - 1][scratch::C]);
    // Up: λ_i = d_i + c_i λ_{i+1};  Δx_{i+1} = −w (û_i λ_i − û_{i+1} λ_{i+1})
    let (mut lambda, mut pull) = (zero, V3::zero(simd));
    for k in (1..segments).rev() {
        let i = k * STRIDE;
        let at = &work[k];
        let u = V3::load(simd, &at[scratch::U..]);
        let d = load(simd, &at[scratch::D]);
        lambda = load(simd, &at[scratch::C]).mul_add(lambda, d);
        lambda = active.select(lambda, zero);
        let own = u * lambda;
        let w1 = load(simd, &inverse_mass[i + STRIDE]);
        let p = V3::load(simd, &x[i + STRIDE]);
        (p + (pull - own) * w1).store(&mut x[i + STRIDE]);
        let tension = &mut state[i][state::TENSION];
        store(lambda.mul_add(force, load(simd, tension)), tension);
        pull = own;
    }
    true
}
