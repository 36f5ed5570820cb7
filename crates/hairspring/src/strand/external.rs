//! External forces that act on few points: position springs, anisotropic drag, holds, tethers and collider
//! contact.
//!
//! Each is a term on the point's own diagonal block (for a segment contact, on the blocks of its two ends)
//! and one on the right-hand side. They are added in memory, before the sweep reaches the point (see
//! [`PendingRows`]), by a function that is not inlined, because most points have none of them.

use super::{
    assemble::{Linearization, SubstepContext},
    contact::assemble_contact,
    elements::PredictedState,
    model::Model,
    scratch::Scratch,
    segment_contact::assemble_segment_contact,
    system::{PendingRows, System},
    tether,
    tile::{Tile, anisotropic_drag, hold, position_spring, rest, segment_contact, state},
};
use crate::simd::lanes::{F, Simd, Sym3, V3, load};

/// Stiffness of a hold in the matrix relative to the mass term [1]. A held point moves by a millionth of its
/// free displacement.
const HOLD_STIFFNESS: f32 = 1e6;

/// Torsional stiffness of a held frame [N m]: far above that of any hair, which is about 1e-6.
const HOLD_FRAME: f32 = 1.0;

/// The point whose elements the sweep adds next.
pub struct Place<S: Simd> {
    /// Index of the point.
    pub i: usize,
    /// Position relative to the root [m].
    pub x: V3<S>,
    /// Displacement since the start of the substep [m]; only used by Newton iterations.
    pub displacement: V3<S>,
    /// Velocity of the root in the last substep [m/s].
    pub root_velocity: V3<S>,
}

/// Returns whether the tile has any external forces that are stored for whole tiles.
pub fn any(tile: &Tile) -> bool {
    let Tile { position_spring, anisotropic_drag, holds, tether_lengths: tethers, .. } = tile;
    !(position_spring.is_empty() && anisotropic_drag.is_empty() && holds.is_empty() && tethers.is_empty())
}

/// Returns whether the point after the `i`th, or the segment from that point, is in contact, in a model with
/// this `stride`.
#[inline(always)]
pub fn pressed<S: Simd>(simd: S, stride: usize, i: usize, tile: &Tile) -> bool {
    let mut force = load(simd, &tile.state[i + 1][state::NORMAL_FORCE]);
    if let Some(rows) = tile.segment_contacts.get(i + stride) {
        force = force.max(load(simd, &rows[segment_contact::FORCE]));
    }
    force.simd_gt(0.0).any_true()
}

/// Adds the external forces on the point after `place` and the contact of the segment from `place`.
#[inline(never)]
pub fn add<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Linearization, &SubstepContext<S>),
    place: &Place<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || act::<S, M, B, N>(simd, (sweep, step), place, tile, scratch),
    )
}

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn act<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Linearization, &SubstepContext<S>),
    &Place { i, x, displacement, root_velocity }: &Place<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let Scratch { factors, edges, contacts, .. } = scratch;
    let pending = &mut PendingRows::<B, N>::new(M::PROFILE, i, factors);
    let (next, share) = (i + 1, sweep.prediction_time(step.h));
    let velocity = |tile: &Tile, i: usize| V3::load(simd, &tile.state[i][state::V..]) - root_velocity;
    if i.is_multiple_of(M::STRIDE) && i > 0 && i + M::STRIDE < tile.rest.len() {
        let predicted = PredictedState { sweep, faster: velocity(tile, i), share, displacement };
        let inner = (i, x, predicted.drift(simd), predicted.displacement(simd));
        assemble_segment_contact(simd, (sweep, step, M::STRIDE), tile, inner, pending, (edges, contacts));
    }
    let edge = V3::load(simd, &edges[next]);
    let x = x + edge;
    let displacement = if sweep == Linearization::Newton {
        displacement + (edge - V3::load(simd, &tile.state[next][state::EDGE..]))
    } else {
        displacement
    };
    let predicted = PredictedState { sweep, faster: velocity(tile, next), share, displacement };
    let (drift, displacement) = (predicted.drift(simd), predicted.displacement(simd));
    let mass = load(simd, &tile.rest[next][rest::MASS]);
    let inv_h = 1.0 / step.h;

    if let Some(rows) = tile.position_spring.get(next) {
        let stiffness = load(simd, &rows[position_spring::STIFFNESS]);
        let brake = load(simd, &rows[position_spring::BRAKE]) * inv_h;
        let late = V3::load(simd, &rows[position_spring::DISPLACEMENT..]) * F::splat(simd, step.left);
        pending.add_force(1, (late + (x + drift) * stiffness + (displacement + step.moved) * brake) * -mass);
        pending.add_identity(1, mass * (stiffness + brake));
    }
    let on_strand = next.is_multiple_of(M::STRIDE);
    if let Some(rows) = tile.anisotropic_drag.get(next).filter(|_| on_strand) {
        let far = next + M::STRIDE;
        let mut after = V3::load(simd, &edges[far]);
        if M::STRIDE == 2 {
            after += V3::load(simd, &edges[far - 1]);
        }
        let u = after.length_and_unit().1;
        let brake = load(simd, &rows[anisotropic_drag::BRAKE]) * inv_h;
        let slip =
            V3::load(simd, &rows[anisotropic_drag::ACCELERATION..]) - (displacement + step.moved) * brake;
        pending.add_force(1, (slip - u * u.dot(slip)) * mass);
        let across = brake * mass;
        pending.add_diagonal(1, Sym3::outer(u, -across).add_identity(across));
    }
    for at in tile.holds {
        if B > 3 && at.point as usize == i {
            pending.add((0, 3), (0, 3), load(simd, &at.rows[hold::CLAMPED]) * HOLD_FRAME);
        }
        if at.point as usize == next {
            let pinned = load(simd, &at.rows[hold::PINNED]);
            let to_go = V3::load(simd, &at.rows[hold::DISPLACEMENT..]) * F::splat(simd, step.left);
            let target = V3::load(simd, &at.rows[hold::TARGET..]) - to_go - step.root.position;
            let m_h2 = mass * (step.inertia() * inv_h * inv_h);
            let k = (pinned * HOLD_STIFFNESS).mul_add(m_h2, load(simd, &at.rows[hold::STIFFNESS]));
            pending.add_identity(1, k);
            pending.add_force(1, (target - x - drift) * k + V3::load(simd, &at.rows[hold::FORCE..]));
        }
    }
    if on_strand {
        tether::pull(simd, step, tile, (next, x, drift), pending);
        assemble_contact(
            simd,
            (sweep, step),
            tile,
            (next, x, drift, displacement),
            pending,
            &mut contacts[next],
        );
    }
}
