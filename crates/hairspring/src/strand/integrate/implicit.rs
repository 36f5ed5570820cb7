//! Backward Euler and BDF2: one banded solve, linearised at the start of the substep (Baraff & Witkin 1998), then fast projection;
//! or, for high quality, Newton iterations with a line search.

use crate::strand::{
    assemble::{Step, Sweep, assemble, substitute},
    interval::Interval,
    lanes::{F, V3, load},
    model::{Curvature, Model, Rod, Springs},
    project::project,
    scratch::Scratch,
    tile::{Elastic, Tile, rest},
};
use fearless_simd::prelude::*;

/// Leaves the new positions in `scratch.x`.
#[inline(always)]
pub fn advance<S: Simd>(
    simd: S,
    interval: &Interval,
    step: &Step<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    match tile.model {
        Elastic::Curvature => solve::<S, Curvature<S>, 3, 9>(simd, interval, step, tile, scratch),
        Elastic::Rod => solve::<S, Rod<S>, 4, 12>(simd, interval, step, tile, scratch),
        Elastic::Springs => solve::<S, Springs, 3, 12>(simd, interval, step, tile, scratch),
    }
    for _ in 0..projections(interval.projections, tile.rest.len()) {
        let Scratch { factors, x, inverse_mass, .. } = &mut *scratch;
        let force = step.inertia() / (step.h * step.h);
        let moved = match tile.model {
            Elastic::Springs => project::<S, 2>(simd, force, tile, inverse_mass, x, factors),
            Elastic::Curvature | Elastic::Rod => project::<S, 1>(simd, force, tile, inverse_mass, x, factors),
        };
        if !moved {
            break;
        }
    }
}

/// Points of a strand for which one more iteration of projection is granted.
const POINTS_AN_ITERATION: usize = 32;

/// Iterations of projection that a strand of `points` may take where `setting` of them are asked for: the springs of the solve carry a
/// change of load along some 30 points in a substep, and the longer the strand, the more is left to projection. (A strand of 2 m in
/// 1,024 points begins to swing by itself with 3, and rests with 8.) It ends as soon as lengths are right.
fn projections(setting: u32, points: usize) -> u32 {
    if setting == 0 { 0 } else { setting.max((points / POINTS_AN_ITERATION) as u32) }
}

/// Largest correction over the longest segment below which Newton is done [1]: what f32 can tell apart.
const CONVERGED: f32 = 1e-5;

#[inline(always)]
fn solve<S, M, const B: usize, const N: usize>(
    simd: S,
    interval: &Interval,
    step: &Step<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    assemble::<S, M, B, N>(simd, Sweep::First, step, tile, scratch);
    substitute::<S, M, B, N>(simd, step, tile, scratch);
    // Newton: the linearisation again where the last one led. A correction that is larger than the one before tells of a step that went
    // too far, and the next goes half as far (the natural monotonicity test of Deuflhard 2004, *Newton Methods*, §3.3).
    let mut share = F::<S>::splat(simd, 1.0);
    let mut last = F::<S>::splat(simd, f32::INFINITY);
    for _ in 1..interval.iterations {
        scratch.kick.copy_from_slice(&scratch.x);
        assemble::<S, M, B, N>(simd, Sweep::Again, step, tile, scratch);
        substitute::<S, M, B, N>(simd, step, tile, scratch);
        let (mut size, mut length) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 0.0));
        for i in M::DRIVEN..tile.rest.len() {
            let change = V3::load(simd, &scratch.x[i]) - V3::load(simd, &scratch.kick[i]);
            size = size.max(change.dot(change));
            length = length.max(load(simd, &tile.rest[i - 1][rest::LENGTH]));
        }
        let grew = size.simd_gt(last);
        share = grew.select(share * 0.5, (share + share).min(1.0));
        // Strands that are done keep their bits, whatever their neighbours in the tile do.
        let enough = length * CONVERGED;
        let going = size.simd_gt(enough * enough);
        let share_now = going.select(share, F::splat(simd, 0.0));
        for i in M::DRIVEN..tile.rest.len() {
            let from = V3::load(simd, &scratch.kick[i]);
            let change = V3::load(simd, &scratch.x[i]) - from;
            change.mul_add(share_now, from).store(&mut scratch.x[i]);
        }
        if !going.any_true() {
            break;
        }
        last = size;
    }
}
