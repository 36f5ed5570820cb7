//! Explicit Euler and position Verlet, with the true stretching stiffness of the fiber. A baseline for
//! comparisons, unstable at practical time steps.
//!
//! ```text
//! explicit Euler   x⁺ = x + h v,   v⁺ = v + h a        Verlet   x⁺ = x + (x − x⁻) + h² a,   v⁺ = (x⁺ − x) / h
//! ```
//!
//! Müller et al. 2008, *Real Time Physics*, §3.3. A segment of hair oscillates at some 10⁵ rad/s, so both
//! need time steps of microseconds.

use super::outside;
use crate::{
    settings::Integrator,
    simd::lanes::{F, Simd, V3, load},
    strand::{
        assemble::{SubstepContext, forces},
        model::Model,
        scratch::Scratch,
        tile::{Tile, state},
    },
};

/// Stores the new edges in `scratch.edges` and additional velocity changes in `scratch.kick`.
#[inline(always)]
pub fn advance<S, M, const B: usize, const N: usize>(
    simd: S,
    integrator: Integrator,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    forces::<S, M, B, N>(simd, step, tile, scratch);
    let zero = V3::zero(simd);
    let h = F::<S>::splat(simd, step.h);
    let (mut tip, mut before) = (zero, zero);
    let mut x = V3::load(simd, &scratch.edges[1]);
    for i in 2..tile.rest.len() {
        if i + 1 < tile.rest.len() {
            tip = V3::load(simd, &scratch.edges[i + 1]).length_and_unit().1;
        }
        x += V3::load(simd, &scratch.edges[i]);
        let v = V3::load(simd, &tile.state[i][state::V..]);
        let inverse = load(simd, &scratch.fixed[i].inverse_mass);
        let a = outside(simd, step, tile, i, [tip, x]) + V3::load(simd, &scratch.kick[i]) * inverse;
        let free = inverse.simd_gt(0.0);
        let gain = V3::select(free, a * h, zero);
        let (now, later) = if integrator == Integrator::Verlet { (gain, zero) } else { (zero, gain) };
        let change = V3::select(free, (v + now) * h - step.moved, zero);
        let edge = &mut scratch.edges[i];
        (V3::load(simd, edge) + (change - before)).store(edge);
        before = change;
        later.store(&mut scratch.kick[i]);
    }
}
