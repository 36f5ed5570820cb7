//! Local–global solver: each spring is projected onto its rest state separately, then one constant linear
//! system combines the results.
//!
//! ```text
//! local    d = L û for a segment,  d = the rest turn in the carried frame for a joint
//! global   (M/h² + Σ k AᵀA) x = M/h² x̂ + Σ k Aᵀ d,     x̂ = x + h v + h² a
//! ```
//!
//! Liu et al. 2013, *Fast Simulation of Mass-Spring Systems*. A takes differences of points, so the matrix is
//! scalar, has half-bandwidth 2 and is constant for a whole frame: it is factored once. The unknown is the
//! change of x, which preserves precision in f32.

use super::{Method, outside, run_tile};
use crate::{
    simd::{
        dispatch::dispatch_comparison,
        lanes::{F, Simd, V3, Work, load},
    },
    strand::{
        assemble::SubstepContext,
        band::Band,
        frame_context::FrameContext,
        model::{
            bend::transport,
            curvature::{Curvature, turn_in_frame},
            stretch::STRETCH,
        },
        post_solve::PostSolveParams,
        profile::Profile,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, rest, state},
    },
};
use fearless_simd::Level;

/// All unknowns of a window are coupled.
const PROFILE: Profile<1, 3> = Profile::within(2);

/// Rows of factors a point: u of the next two points, the point's own right-hand side, which is unused, and
/// −1/d.
const ROWS: usize = PROFILE.rows();
/// The row with −1/d, the last of them.
const MINUS_INVERSE: usize = ROWS - 1;

/// Points of padding before the first point's factors.
const BEFORE: usize = Profile::<1, 3>::REACH;

/// The local-global solver, with the bending of the curvature model.
pub struct LocalGlobal;

impl<S: Simd> Method<S, Curvature<S>, 3, 9> for LocalGlobal {
    #[inline(always)]
    fn begin(simd: S, frame: &FrameContext, tile: &Tile, scratch: &mut Scratch) {
        factor(simd, frame.h, tile, scratch);
    }

    #[inline(always)]
    fn advance(
        simd: S,
        frame: &FrameContext,
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> PostSolveParams {
        iterate(simd, frame.iterations, step, tile, scratch);
        PostSolveParams { kicks: false, ..PostSolveParams::WITHOUT_LIMIT }
    }
}

/// Advances one tile through a frame.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    dispatch_comparison!(level, tile.layout.double, simd => {
        run_tile::<_, Curvature<_>, LocalGlobal, 3, 9>(simd, frame, tile, memory)
    });
}

/// Factors the constant matrix into `scratch.factors`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn factor<S: Simd>(simd: S, h: f32, tile: &Tile, scratch: &mut Scratch) {
    let n = tile.rest.len();
    scratch.factors[..2 * BEFORE * ROWS].fill(Work::default());
    for i in 0..n {
        let mut band = Band::<S, 1, 3>::new(simd);
        band.load_pending(simd, PROFILE, i, scratch.factors);
        if i + 1 < n {
            let [alpha, beta, stretch, bend] = weights(simd, h, tile, i);
            let mass = load(simd, &tile.rest[i + 1][rest::MASS]);
            let c = [alpha, -(alpha + beta), beta];
            for p in 0..3 {
                for q in p..3 {
                    band.add((p, 0), (q, 0), bend * c[p] * c[q]);
                }
            }
            band.add((1, 0), (1, 0), stretch + mass * (1.0 / (h * h)));
            band.add((1, 0), (2, 0), -stretch);
            band.add((2, 0), (2, 0), stretch);
        }
        // Points that do not move are decoupled.
        let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
        band.decouple_first(simd, free);
        band.eliminate(simd, PROFILE, i, scratch.factors);
    }
}

/// Returns 1/L of segments i and i+1, the stretch stiffness of segment i+1, and the bending stiffness of the
/// joint between them.
#[inline(always)]
fn weights<S: Simd>(simd: S, h: f32, tile: &Tile, i: usize) -> [F<S>; 4] {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let inverse = |length: F<S>| length.simd_gt(0.0).select(one / length.max(1e-12), zero);
    let length = load(simd, &tile.rest[i + 1][rest::LENGTH]);
    let mass = load(simd, &tile.rest[i + 1][rest::MASS]);
    [
        inverse(load(simd, &tile.rest[i][rest::LENGTH])),
        inverse(length),
        length.simd_gt(0.0).select(mass * (STRETCH / (h * h)), zero),
        load(simd, &tile.rest[i + 1][rest::BEND]),
    ]
}

/// Runs `iterations` iterations and stores the new edges in `scratch.edges`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn iterate<S: Simd>(
    simd: S,
    iterations: u32,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let zero = V3::zero(simd);
    let n = tile.rest.len();
    let h = F::<S>::splat(simd, step.h);
    let inv_h2 = 1.0 / (step.h * step.h);
    // x̂ − x
    let mut x = V3::load(simd, &scratch.edges[1]);
    for i in 2..n {
        let edge = V3::load(simd, &scratch.edges[i]);
        x += edge;
        let u = edge.length_and_unit().1;
        let v = V3::load(simd, &tile.state[i][state::V..]);
        ((v + outside(simd, step, tile, i, [u, x]) * h) * h - step.moved).store(&mut scratch.kick[i]);
    }
    for _ in 0..iterations {
        // Right-hand sides and downward sweep in one pass: z_i = b_i − l z of the two points before.
        let mut e0 = V3::load(simd, &scratch.edges[1]);
        let mut u0 = e0.length_and_unit().1;
        // Displacement of the point since the start of the substep.
        let mut displacement = zero;
        let mut normal = step.root.normal;
        let mut b = [zero; 3];
        for i in 0..n {
            if i + 1 < n {
                let [alpha, beta, stretch, bend] = weights(simd, step.h, tile, i);
                let e1 = if i + 2 < n { V3::load(simd, &scratch.edges[i + 2]) } else { zero };
                displacement += e0 - V3::load(simd, &tile.state[i + 1][state::EDGE..]);
                let u1 = e1.length_and_unit().1;
                let turn = V3::load(simd, &tile.rest[i + 1][rest::TURN..]);
                let d = turn_in_frame(turn, normal, u0);
                let pull = (d + e0 * alpha - e1 * beta) * bend;
                b[0] += pull * alpha;
                b[1] -= pull * (alpha + beta);
                b[2] += pull * beta;
                let tension = load(simd, &tile.state[i + 1][state::TENSION]);
                let length = load(simd, &tile.rest[i + 1][rest::LENGTH]);
                let real = length.simd_gt(0.0);
                let pull = V3::select(real, (e1 - u1 * length) * stretch + u1 * tension, zero);
                b[1] += pull;
                b[2] -= pull;
                if i >= 1 {
                    let mass = load(simd, &tile.rest[i + 1][rest::MASS]);
                    b[1] += (V3::load(simd, &scratch.kick[i + 1]) - displacement) * (mass * inv_h2);
                }
                normal = V3::select(real, transport(normal, u0, u1), normal);
                (e0, u0) = (e1, V3::select(real, u1, u0));
            }
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            let z = V3::select(free, b[0], zero);
            let row = &scratch.factors[(i + BEFORE) * ROWS..][..ROWS];
            let z = z * -load(simd, &row[MINUS_INVERSE]);
            b = [b[1] - z * load(simd, &row[0]), b[2] - z * load(simd, &row[1]), zero];
            z.store(&mut scratch.change[i]);
        }
        let mut after = [zero; 2];
        for i in (0..n).rev() {
            let row = &scratch.factors[(i + BEFORE) * ROWS..][..ROWS];
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            let inverse = -load(simd, &row[MINUS_INVERSE]);
            let change = V3::load(simd, &scratch.change[i])
                - (after[0] * load(simd, &row[0]) + after[1] * load(simd, &row[1])) * inverse;
            let change = V3::select(free, change, zero);
            for (edge, change) in scratch.edges[i..n].iter_mut().zip([change, -change]) {
                (V3::load(simd, edge) + change).store(edge);
            }
            after = [change, after[0]];
        }
    }
}
