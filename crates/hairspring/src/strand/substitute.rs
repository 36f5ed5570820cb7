//! The upward sweep: back-substitutes the solution point by point and adds it to the edges.

use super::{
    assemble::{Linearization, SubstepContext, first_in_loop},
    band::back_substitute,
    contact::update_contact_multiplier,
    model::{Model, Solved},
    profile::Profile,
    project::Projection,
    scratch::Scratch,
    segment_contact::update_segment_contact_multiplier,
    tile::{Tile, rest, state},
};
use crate::simd::lanes::{F, Simd, V3, load, store};

/// The upward sweep. Adds the solution to `scratch.edges`, adds the forces of the stretch springs to the
/// tensions, and eliminates the new segments for projection.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn substitute<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, carried): (Linearization, F<S>),
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> Projection<S>
where
    S: Simd,
    M: Model<S, B, N>,
{
    let zero = V3::zero(simd);
    let n = tile.rest.len();
    let mut up = BackSubstitution {
        root_velocity: V3::load(simd, &tile.state[0][state::V..]),
        solved: Solved {
            i: n,
            phase: 0,
            edges: [zero; 2],
            moved: [zero; 3],
            unknowns: [F::<S>::splat(simd, 0.0); N],
            along: F::splat(simd, 0.0),
            length_error_share: sweep.length_error_share(),
            carried,
        },
        projection: Projection::begin(simd, tile, scratch.fixed),
    };
    // The tip and the points next to the root are handled outside the loop, so that the loop has no special
    // cases.
    let first = first_in_loop::<S, M, B, N>();
    up.pass_point::<M, B>(simd, (sweep, n - 1, 0, true), step, tile, scratch);
    let mut i = n - 1;
    while i > first {
        if M::STRIDE == 2 {
            up.pass_point::<M, B>(simd, (sweep, i - 1, 1, false), step, tile, scratch);
        }
        i -= M::STRIDE;
        up.pass_point::<M, B>(simd, (sweep, i, 0, false), step, tile, scratch);
    }
    // A copy: the compiler would keep the original in memory at every point.
    pass_driven_points::<S, M, B, N>(
        simd,
        sweep,
        step,
        &mut tile.reborrow(),
        &mut scratch.reborrow(),
        BackSubstitution { ..up },
    )
    .in_registers()
}

/// Passes the points that the root drives, which are the last ones.
///
/// Not inlined: it runs once a strand, so the call is cheap. Inlined, these few points would be a large part of the kernel's
/// code.
#[inline(never)]
fn pass_driven_points<S, M, const B: usize, const N: usize>(
    simd: S,
    sweep: Linearization,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
    mut up: BackSubstitution<S, N>,
) -> Projection<S>
where
    S: Simd,
    M: Model<S, B, N>,
{
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || {
            for i in (1..first_in_loop::<S, M, B, N>().min(tile.rest.len() - 1)).rev() {
                up.pass_point::<M, B>(simd, (sweep, i, i % M::STRIDE, false), step, tile, scratch);
            }
            up.projection
        },
    )
}

/// The state of the upward sweep.
struct BackSubstitution<S: Simd, const N: usize> {
    /// Velocity of the root in the last substep [m/s].
    root_velocity: V3<S>,
    /// The solution at the previous point.
    solved: Solved<S, N>,
    projection: Projection<S>,
}

impl<S: Simd, const N: usize> BackSubstitution<S, N> {
    /// Solves for point i. `phase` is i modulo the model's stride, and `tip` is set for the last point.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn pass_point<M: Model<S, B, N>, const B: usize>(
        &mut self,
        simd: S,
        (sweep, i, phase, tip): (Linearization, usize, usize, bool),
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) {
        let Self { root_velocity, solved, projection } = self;
        let mut delta = V3::zero(simd);
        if i >= M::DRIVEN || B > 3 {
            if M::PROFILE.is_far()
                && let Some(spring) = scratch.altitude_springs.pop_if(|spring| spring.point == i)
            {
                spring.back_substitute(simd, M::PROFILE, &solved.unknowns, scratch.factors);
            }
            let factors = &scratch.factors[(i + Profile::<B, N>::REACH) * M::PROFILE.rows()..];
            back_substitute(simd, M::PROFILE, factors, &mut solved.unknowns);
        }
        if i >= M::DRIVEN {
            let unknowns = &solved.unknowns;
            let drift = V3::load(simd, &tile.state[i][state::V..]) - *root_velocity;
            delta = V3 { x: unknowns[0], y: unknowns[1], z: unknowns[2] };
            delta = drift.mul_add(F::splat(simd, sweep.prediction_time(step.h)), delta);
            if phase == 0 {
                update_contact_multiplier(simd, step, tile, (i, delta), &scratch.contacts[i]);
            }
        }
        if phase == 0 && !tip {
            // Called before this point's displacement is added: `solved.moved` holds those of the points
            // after it.
            update_segment_contact_multiplier(
                simd,
                step,
                tile,
                (i, [delta, solved.moved[M::STRIDE - 1]]),
                scratch.contacts,
            );
        }
        (solved.i, solved.phase) = (i, phase);
        let fixed = &scratch.fixed[i - phase];
        solved.along = load(simd, &fixed.along);
        solved.moved = [delta, solved.moved[0], solved.moved[1]];
        if tip {
            return;
        }
        let edge = V3::load(simd, &scratch.edges[i + 1]);
        solved.edges = [edge, solved.edges[0]];
        (edge + (solved.moved[1] - delta)).store(&mut scratch.edges[i + 1]);
        M::take(simd, solved, tile, scratch.fixed);
        if phase == 0 {
            // Padding has no stiffness, so its tension stays 0.
            let length = [load(simd, &tile.rest[i][rest::LENGTH]), load(simd, &fixed.inverse_length)];
            let row = &mut tile.state[i][state::TENSION];
            store(load(simd, row) + solved.taken(M::STRIDE, length, solved.along), row);
            projection.eliminate(simd, (M::STRIDE, i), tile, scratch);
        }
    }
}
