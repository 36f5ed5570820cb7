//! Backward Euler and BDF2: one banded solve, linearized at the start of the substep (Baraff & Witkin 1998),
//! then fast projection. For high quality, Newton iterations with a line search.

use super::Method;
use crate::{
    settings::Response,
    simd::lanes::{F, Simd, V3, load, store},
    strand::{
        assemble::{Linearization, SubstepContext, assemble},
        frame_context::FrameContext,
        model::Model,
        post_solve::{LIMIT, PostSolveParams},
        project::Projection,
        scratch::Scratch,
        substitute::substitute,
        tile::{Tile, rest, state, strand},
    },
};

/// Backward Euler and BDF2.
pub struct Implicit;

impl<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize> Method<S, M, B, N> for Implicit {
    const PRODUCTION: bool = true;

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn advance(
        simd: S,
        frame: &FrameContext,
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> PostSolveParams {
        let mut projection = solve::<S, M, B, N>(simd, frame, step, tile, scratch);
        // Stiffer springs take more of a load in the solve; what projection adds to their tension is then mostly
        // noise, so it is scaled down.
        let stiffening = load(simd, &tile.strand[strand::STIFFENING]);
        let per_mass = step.inertia() / (step.h * step.h);
        let force = F::splat(simd, per_mass) / stiffening;
        let limit = iteration_limit(simd, frame.projection_iterations, tile);
        for iteration in 1.. {
            let active = limit.simd_ge(iteration as f32);
            if !active.any_true() || !projection.move_points(simd, M::STRIDE, (force, active), tile, scratch)
            {
                break;
            }
            projection = Projection::eliminate_all(simd, M::STRIDE, tile, scratch);
        }
        PostSolveParams {
            limit: LIMIT,
            press: if frame.response == Response::Projection { 0.0 } else { per_mass },
            relaxation: step.relaxation,
            project: frame.response != Response::Penalty,
            kicks: false,
        }
    }
}

/// Points of a strand per permitted iteration of projection.
const POINTS_AN_ITERATION: f32 = 32.0;

/// Returns how many iterations of projection each strand may take, at least `setting` unless that is 0. The
/// springs of the solve carry a change of load along some 60 points in a substep (see `stiffening`); a longer
/// strand leaves more to projection. Iteration ends as soon as all lengths are within tolerance.
#[inline(always)]
fn iteration_limit<S: Simd>(simd: S, setting: u32, tile: &Tile) -> F<S> {
    let points = load(simd, &tile.strand[strand::POINTS]) * (1.0 / POINTS_AN_ITERATION);
    if setting == 0 { F::splat(simd, 0.0) } else { points.max(setting as f32) }
}

/// Newton convergence tolerance: largest correction over the longest segment [1], about the resolution of
/// f32.
const NEWTON_TOLERANCE: f32 = 1e-5;

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn solve<S, M, const B: usize, const N: usize>(
    simd: S,
    frame: &FrameContext,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> Projection<S>
where
    S: Simd,
    M: Model<S, B, N>,
{
    let newton = frame.iterations > 1;
    store_tensions(simd, newton, &tile.reborrow(), &mut scratch.reborrow());
    // The iterations add up to the tension; `refine` keeps the share of it.
    let carried = step.carried.max(if newton { 1.0 } else { 0.0 });
    assemble::<S, M, B, N>(simd, Linearization::Initial, step, tile, scratch);
    let projection = substitute::<S, M, B, N>(simd, (Linearization::Initial, carried), step, tile, scratch);
    if newton { refine::<S, M, B, N>(simd, frame, step, tile, scratch) } else { projection }
}

/// Stores the tensions in `scratch.change` if they are `needed`.
///
/// Not inlined: with this branch in it, the compiler makes two copies of the kernel, one for each outcome.
#[inline(never)]
fn store_tensions<S: Simd>(simd: S, needed: bool, tile: &Tile, scratch: &mut Scratch) {
    if needed {
        simd.vectorize(
            #[inline(always)]
            || {
                for (rows, before) in tile.state.iter().zip(&mut *scratch.change) {
                    store(load(simd, &rows[state::TENSION]), &mut before[0]);
                }
            },
        );
    }
}

/// Newton's iterations after the first solve. The tensions before it are in `scratch.change`.
///
/// Not inlined, so that the kernel of the default quality stays small.
#[inline(never)]
fn refine<S, M, const B: usize, const N: usize>(
    simd: S,
    frame: &FrameContext,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> Projection<S>
where
    S: Simd,
    M: Model<S, B, N>,
{
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || iterate::<S, M, B, N>(simd, frame, step, tile, scratch),
    )
}

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn iterate<S, M, const B: usize, const N: usize>(
    simd: S,
    frame: &FrameContext,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> Projection<S>
where
    S: Simd,
    M: Model<S, B, N>,
{
    let whole = F::<S>::splat(simd, 1.0);
    // Newton: linearize again at the last iterate. A correction larger than the previous one shows that the
    // step was too long, so the next one is halved (the natural monotonicity test of Deuflhard 2004, *Newton
    // Methods*, §3.3).
    let mut share = whole;
    let mut last = F::<S>::splat(simd, f32::INFINITY);
    let points = tile.rest.len();
    for _ in 1..frame.iterations {
        scratch.kick[..points].copy_from_slice(&scratch.edges[..points]);
        assemble::<S, M, B, N>(simd, Linearization::Newton, step, tile, scratch);
        substitute::<S, M, B, N>(simd, (Linearization::Newton, whole), step, tile, scratch);
        let (mut size, mut length) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 0.0));
        let mut change = V3::zero(simd);
        for i in M::DRIVEN..points {
            change += V3::load(simd, &scratch.edges[i]) - V3::load(simd, &scratch.kick[i]);
            size = size.max(change.dot(change));
            length = length.max(load(simd, &tile.rest[i - 1][rest::LENGTH]));
        }
        let grew = size.simd_gt(last);
        share = grew.select(share * 0.5, (share + share).min(1.0));
        // Converged strands are not changed, so that their result does not depend on their neighbors in the
        // tile.
        let enough = length * NEWTON_TOLERANCE;
        let going = size.simd_gt(enough * enough);
        let share_now = going.select(share, F::splat(simd, 0.0));
        for i in M::DRIVEN..points {
            let from = V3::load(simd, &scratch.kick[i]);
            let change = V3::load(simd, &scratch.edges[i]) - from;
            change.mul_add(share_now, from).store(&mut scratch.edges[i]);
        }
        if !going.any_true() {
            break;
        }
        last = size;
    }
    for (rows, before) in tile.state.iter_mut().zip(&*scratch.change) {
        let (before, row) = (load(simd, &before[0]), &mut rows[state::TENSION]);
        let now = load(simd, row);
        let less = step.carried.simd_lt(1.0);
        store(less.select((now - before).mul_add(step.carried, before), now), row);
    }
    // After a damped step, the segments are not where the upward sweep evaluated them.
    Projection::eliminate_all(simd, M::STRIDE, tile, scratch)
}
