//! Explicit Euler and position Verlet, with the true stretching stiffness of the fiber. A baseline for
//! comparisons, unstable at practical time steps.
//!
//! ```text
//! explicit Euler   x⁺ = x + h v,   v⁺ = v + h a        Verlet   x⁺ = x + (x − x⁻) + h² a,   v⁺ = (x⁺ − x) / h
//! ```
//!
//! Müller et al. 2008, *Real Time Physics*, §3.3. A segment of hair oscillates at some 10⁵ rad/s, so both
//! need time steps of microseconds.

use super::{Method, outside, run_tile};
use crate::{
    settings::Integrator,
    simd::{
        dispatch::dispatch_comparison,
        lanes::{F, Simd, V3, load},
    },
    strand::{
        assemble::{SubstepContext, forces},
        frame_context::FrameContext,
        model::{Model, Stretching, curvature::Curvature, rod::Rod, springs::Springs, straight::Straight},
        post_solve::PostSolveParams,
        scratch::{Memory, Scratch},
        tile::{Elastic, Tile, state},
    },
};
use fearless_simd::Level;

/// Explicit Euler and Verlet.
pub struct Explicit;

impl<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize> Method<S, M, B, N> for Explicit {
    const STRETCHING: Stretching = Stretching::Fiber;

    /// Additional velocity changes are in `scratch.kick`.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn advance(
        simd: S,
        frame: &FrameContext,
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> PostSolveParams {
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
            let (now, later) =
                if frame.integrator == Integrator::Verlet { (gain, zero) } else { (zero, gain) };
            let change = V3::select(free, (v + now) * h - step.moved, zero);
            let edge = &mut scratch.edges[i];
            (V3::load(simd, edge) + (change - before)).store(edge);
            before = change;
            later.store(&mut scratch.kick[i]);
        }
        PostSolveParams::WITHOUT_LIMIT
    }
}

/// Advances one tile through a frame.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    macro_rules! kernel {
        ($model:ty, $b:literal, $n:literal) => {
            dispatch_comparison!(level, tile.layout.double, simd => {
                run_tile::<_, $model, Explicit, $b, $n>(simd, frame, tile, memory)
            })
        };
    }
    match tile.layout.model {
        Elastic::Straight => kernel!(Straight, 3, 9),
        Elastic::Curvature => kernel!(Curvature<_>, 3, 9),
        Elastic::Rod => kernel!(Rod<_>, 4, 11),
        Elastic::Springs => kernel!(Springs, 3, 12),
    }
}
