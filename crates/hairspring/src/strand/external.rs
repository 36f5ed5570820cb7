//! What acts on few points from outside in the solve: a hand's grip and comb, holds, tethers, and what presses from a
//! collider. Each is a term on the point's own diagonal (a segment's contact: of its two ends) and one on the right.
//!
//! It is added in memory, before the walk comes to the point (see [`PendingRows`]), by a function by itself: most points meet none of it.

use super::{
    assemble::{Linearization, SubstepContext},
    contact::assemble_contact,
    elements::PredictedState,
    model::Model,
    scratch::Scratch,
    segment::assemble_segment_contact,
    system::{PendingRows, System},
    tether,
    tile::{Tile, anisotropic_drag, hold, position_spring, rest, segment_contact, state},
};
use crate::simd::lanes::{F, Simd, Sym3, V3, load};

/// Stiffness of a hold in the matrix, over the mass in it [1]: a held point gives way by a millionth of what it would move.
const HOLD: f32 = 1e6;

/// Stiffness of a held frame [N m]: far above any hair's, about 1e-6.
const HOLD_FRAME: f32 = 1.0;

/// Where the walk is before it adds what begins at a point.
pub struct Place<S: Simd> {
    /// The point.
    pub i: usize,
    /// Where it is, from the root [m].
    pub x: V3<S>,
    /// How far it has gone since the start of the substep, of a sweep again [m].
    pub way: V3<S>,
    /// Velocity of the root in the last substep [m/s].
    pub root_velocity: V3<S>,
}

/// Whether any point of the tile may be acted on by what is given for whole tiles.
pub fn any(tile: &Tile) -> bool {
    let Tile { position_spring, anisotropic_drag, holds, tether_lengths: tethers, .. } = tile;
    !(position_spring.is_empty() && anisotropic_drag.is_empty() && holds.is_empty() && tethers.is_empty())
}

/// Whether anything is pressed of the point after the `i`th and of the segment from that, in a model of this `stride`.
#[inline(always)]
pub fn pressed<S: Simd>(simd: S, stride: usize, i: usize, tile: &Tile) -> bool {
    let mut force = load(simd, &tile.state[i + 1][state::NORMAL_FORCE]);
    if let Some(rows) = tile.segment_contacts.get(i + stride) {
        force = force.max(load(simd, &rows[segment_contact::FORCE]));
    }
    force.simd_gt(0.0).any_true()
}

/// Adds what acts on the point after `place`, and on the segment from `place`.
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
        #[inline(always)]
        || act::<S, M, B, N>(simd, (sweep, step), place, tile, scratch),
    )
}

#[inline(always)]
fn act<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Linearization, &SubstepContext<S>),
    &Place { i, x, way, root_velocity }: &Place<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let Scratch { factors, edges, contacts, .. } = scratch;
    let said = &mut PendingRows::<B, N>::new(M::PROFILE, i, factors);
    let (next, share) = (i + 1, sweep.predicted_displacement(step.h));
    let velocity = |tile: &Tile, i: usize| V3::load(simd, &tile.state[i][state::V..]) - root_velocity;
    if i.is_multiple_of(M::STRIDE) && i > 0 && i + M::STRIDE < tile.rest.len() {
        let outset = PredictedState { sweep, faster: velocity(tile, i), share, way };
        let inner = (i, x, outset.drift(simd), outset.way(simd));
        assemble_segment_contact(simd, (sweep, step, M::STRIDE), tile, inner, said, (edges, contacts));
    }
    let edge = V3::load(simd, &edges[next]);
    let x = x + edge;
    let way = if sweep == Linearization::Newton {
        way + (edge - V3::load(simd, &tile.state[next][state::EDGE..]))
    } else {
        way
    };
    let outset = PredictedState { sweep, faster: velocity(tile, next), share, way };
    let (drift, way) = (outset.drift(simd), outset.way(simd));
    let mass = load(simd, &tile.rest[next][rest::MASS]);
    let inv_h = 1.0 / step.h;

    if let Some(rows) = tile.position_spring.get(next) {
        let stiffness = load(simd, &rows[position_spring::STIFFNESS]);
        let brake = load(simd, &rows[position_spring::BRAKE]) * inv_h;
        let late = V3::load(simd, &rows[position_spring::WAY..]) * F::splat(simd, step.left);
        said.add_force(1, (late + (x + drift) * stiffness + (way + step.moved) * brake) * -mass);
        said.add_identity(1, mass * (stiffness + brake));
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
        let slip = V3::load(simd, &rows[anisotropic_drag::ACCELERATION..]) - (way + step.moved) * brake;
        said.add_force(1, (slip - u * u.dot(slip)) * mass);
        let across = brake * mass;
        said.add_diagonal(1, Sym3::outer(u, -across).add_identity(across));
    }
    for at in tile.holds {
        if B > 3 && at.point as usize == i {
            said.add((0, 3), (0, 3), load(simd, &at.rows[hold::CLAMPED]) * HOLD_FRAME);
        }
        if at.point as usize == next {
            let pinned = load(simd, &at.rows[hold::PINNED]);
            let to_go = V3::load(simd, &at.rows[hold::WAY..]) * F::splat(simd, step.left);
            let target = V3::load(simd, &at.rows[hold::TARGET..]) - to_go - step.root.position;
            let m_h2 = mass * (step.inertia() * inv_h * inv_h);
            let k = (pinned * HOLD).mul_add(m_h2, load(simd, &at.rows[hold::STIFFNESS]));
            said.add_identity(1, k);
            said.add_force(1, (target - x - drift) * k + V3::load(simd, &at.rows[hold::FORCE..]));
        }
    }
    if on_strand {
        tether::pull(simd, step, tile, (next, x, drift), said);
        assemble_contact(simd, step, tile, (next, x, drift, way), said, &mut contacts[next]);
    }
}
