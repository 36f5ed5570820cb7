//! Backward Euler and BDF2: one banded solve, linearised at the start of the substep (Baraff & Witkin 1998), then fast projection;
//! or, for high quality, Newton iterations with a line search.

use crate::strand::{
    assemble::{Step, Sweep, assemble, substitute},
    interval::Interval,
    lanes::{F, V3, load},
    model::Model,
    project::project,
    scratch::Scratch,
    tile::{Tile, rest},
};
use fearless_simd::prelude::*;

/// Leaves the new positions in `scratch.x`.
#[inline(always)]
pub fn advance<S, M, const B: usize, const N: usize>(
    simd: S,
    interval: &Interval,
    step: &Step<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    if M::needs_guard(simd, tile, &scratch.x) {
        solve::<S, M::Guarded, B, N>(simd, interval, step, tile, scratch);
    } else {
        solve::<S, M, B, N>(simd, interval, step, tile, scratch);
    }
    let force = step.inertia() / (step.h * step.h);
    for _ in 0..projections(interval.projections, tile.rest.len()) {
        if !project(simd, M::STRIDE, force, tile, scratch) {
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
    // Newton: the linearisation again where the last one led. A correction that is larger than the one before tells of a step that went
    // too far, and the next goes half as far (the natural monotonicity test of Deuflhard 2004, *Newton Methods*, §3.3).
    let mut share = F::<S>::splat(simd, 1.0);
    let mut last = F::<S>::splat(simd, f32::INFINITY);
    for iteration in 0..interval.iterations {
        let sweep = if iteration == 0 { Sweep::First } else { Sweep::Again };
        if sweep == Sweep::Again {
            scratch.kick.copy_from_slice(&scratch.x);
        }
        assemble::<S, M, B, N>(simd, sweep, step, tile, scratch);
        substitute::<S, M, B, N>(simd, step, tile, scratch);
        if sweep == Sweep::First {
            continue;
        }
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
