//! Follow the leader and its dynamic form: inextensible by construction, without bending.
//!
//! ```text
//! predict p = x + h v + h² a;  from root to tip  x⁺_{i+1} = x⁺_i + L û(x⁺_i → p_{i+1}),  d_{i+1} the correction;
//! v_i = (x⁺_i − x_i) / h  −  s d_{i+1} / h          s = 0 for follow the leader, 0.9 for its dynamic form
//! ```
//!
//! Müller, Kim, Chentanez 2012, *Fast Simulation of Inextensible Hair and Fur*, §4.2. The velocity correction
//! compensates for the one-sided projection, which acts as if points near the tip had more mass.

use super::{Method, outside, run_tile};
use crate::{
    settings::Integrator,
    simd::{
        dispatch::dispatch_comparison,
        lanes::{F, Simd, V3, load},
    },
    strand::{
        assemble::SubstepContext,
        frame_context::FrameContext,
        model::{Model, springs::Springs, straight::Straight},
        post_solve::PostSolveParams,
        scratch::{Memory, Scratch},
        tile::{Elastic, Tile, rest, state},
        truss::beside,
    },
};
use fearless_simd::Level;

/// s of the dynamic form [1]. At 1, all of the energy is kept and the method is only just stable.
const KEPT: f32 = 0.9;

/// Follow the leader and its dynamic form.
pub struct FollowTheLeader;

impl<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize> Method<S, M, B, N> for FollowTheLeader {
    /// The velocity correction is in `scratch.kick`.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn advance(
        simd: S,
        frame: &FrameContext,
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> PostSolveParams {
        let zero = V3::zero(simd);
        let h = F::<S>::splat(simd, step.h);
        let share = if frame.integrator == Integrator::Dftl { -KEPT / step.h } else { 0.0 };
        let stride = M::STRIDE;
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
            if tile.layout.model == Elastic::Springs {
                let inverse = load(simd, &scratch.fixed[i - stride].inverse_length);
                extra = beside(simd, extra, new, [length, inverse]);
                extra.store(&mut scratch.edges[i - 1]);
                (new - extra).store(&mut scratch.edges[i]);
                zero.store(&mut scratch.kick[i - 1]);
            }
            shift = new - old;
        }
        PostSolveParams::WITHOUT_LIMIT
    }
}

/// Advances one tile through a frame. Of the elastic model, only the particles count.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    if tile.layout.model == Elastic::Springs {
        dispatch_comparison!(level, tile.layout.double, simd => {
            run_tile::<_, Springs, FollowTheLeader, 3, 12>(simd, frame, tile, memory)
        });
    } else {
        dispatch_comparison!(level, tile.layout.double, simd => {
            run_tile::<_, Straight, FollowTheLeader, 3, 9>(simd, frame, tile, memory)
        });
    }
}
