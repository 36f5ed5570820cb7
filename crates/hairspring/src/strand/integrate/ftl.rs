//! Follow the leader and its dynamic form: inextensible by construction, without bending.
//!
//! ```text
//! predict p = x + h v + h² a;  from root to tip  x⁺_{i+1} = x⁺_i + L û(x⁺_i → p_{i+1}),  d_{i+1} the correction;
//! v_i = (x⁺_i − x_i) / h  −  s d_{i+1} / h          s = 0 for follow the leader, 0.9 for its dynamic form
//! ```
//!
//! Müller, Kim, Chentanez 2012, *Fast Simulation of Inextensible Hair and Fur*, §4.2. The velocity correction
//! compensates for the one-sided projection, which acts as if points near the tip had more mass.

use super::outside;
use crate::{
    settings::Integrator,
    simd::lanes::{F, Simd, V3, load},
    strand::{
        assemble::SubstepContext,
        scratch::Scratch,
        tile::{Elastic, Tile, rest, state},
        truss::beside,
    },
};

/// s of the dynamic form [1]. At 1, all of the energy is kept and the method is only just stable.
const KEPT: f32 = 0.9;

/// Stores the new edges in `scratch.edges` and the velocity correction in `scratch.kick`.
#[inline(always)]
pub fn advance<S: Simd>(
    simd: S,
    integrator: Integrator,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let zero = V3::zero(simd);
    let h = F::<S>::splat(simd, step.h);
    let share = if integrator == Integrator::Dftl { -KEPT / step.h } else { 0.0 };
    let stride = tile.model.stride();
    // Displacement of the previous point.
    let mut shift = zero;
    // Old position of the previous point.
    let mut x = V3::load(simd, &scratch.edges[1]);
    if stride == 2 {
        x += V3::load(simd, &scratch.edges[2]);
    }
    for i in (2 * stride..tile.rest.len()).step_by(stride) {
        // From the new position of the previous point.
        let mut extra = V3::load(simd, &scratch.edges[i + 1 - stride]) - shift;
        let old = if stride == 2 { extra + V3::load(simd, &scratch.edges[i]) } else { extra };
        let u = old.length_and_unit().1;
        x += old + shift;
        let v = V3::load(simd, &tile.state[i][state::V..]);
        let p = old + (v + outside(simd, step, tile, i, [u, x]) * h) * h - step.moved;
        let length = load(simd, &tile.rest[i - stride][rest::LENGTH]);
        let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
        let new = V3::select(free, p.length_and_unit().1 * length, old);
        new.store(&mut scratch.edges[i]);
        // The correction of this point changes the velocity of the one before it.
        if i > 2 * stride {
            ((new - p) * F::splat(simd, share)).store(&mut scratch.kick[i - stride]);
        }
        zero.store(&mut scratch.kick[i]);
        if tile.model == Elastic::Springs {
            let inverse = load(simd, &scratch.fixed[i - stride].inverse_length);
            extra = beside(simd, extra, new, [length, inverse]);
            extra.store(&mut scratch.edges[i - 1]);
            (new - extra).store(&mut scratch.edges[i]);
            zero.store(&mut scratch.kick[i - 1]);
        }
        shift = new - old;
    }
}
