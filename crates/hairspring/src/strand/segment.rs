//! Segments stay outside of colliders as points do: where one cuts a corner that its ends stay out of, its outer end swings out until it is
//! clear, and the next solve presses it there (`span`).
//!
//! ```text
//!        a ●━━━╲━━━━┓           depth d at the place s of the segment: the outer end swings about a by d/s
//!      ────────┐╲   ┃ b
//!      collider│ ╲━━●
//! ```

use super::{
    assemble::Step,
    lanes::{F, V3, load, store},
    limit::{Finish, Particle, Tether},
    root::Root,
    scratch::Scratch,
    tile::{Tile, rest, state},
};
use crate::collide::{ObstaclePose, contact, deepest, may_cut, surface_displacement};
use fearless_simd::prelude::*;

/// How deep a segment may be between its ends, over its length [1]. On a smooth body it is always a little inside: by L/8R of its length over a
/// radius of R. That is no contact: points alone hold it, and a head with segments of a centimetre is a smooth body.
const SAG: f32 = 0.02;

/// Nearest place to the inner end whose depth the outer end answers wholly, as a part of the segment [1]. What is nearer is for the inner
/// end, in the next solve: a lever that short would throw the outer one.
const NEAREST: f32 = 0.25;

/// Times that a segment swings out; a curved surface leaves a little the first time.
const CORRECTIONS: usize = 2;

/// Least distance that a place of the segment to point `i` may have [m].
#[inline(always)]
pub fn clear_of_segment<S: Simd>(simd: S, tile: &Tile, i: usize) -> F<S> {
    let sag = match i.checked_sub(tile.model.stride()) {
        Some(inner) => load(simd, &tile.rest[inner][rest::LENGTH]) * -SAG,
        None => F::splat(simd, 0.0),
    };
    tile.sunk.get(i).map_or(sag, |sunk| sag + load(simd, sunk))
}

/// Where point `i` may be, which is at `e` from the strand's point before, so that the segment between them is outside of `pose`.
#[inline(always)]
pub fn clear_segment<S: Simd>(
    simd: S,
    (step, pose, finish): (&Step<S>, &ObstaclePose, &Finish),
    tile: &mut Tile,
    scratch: &Scratch,
    (i, old, e): (usize, V3<S>, V3<S>),
    (inner, tether): (&Particle<S>, &Tether<S>),
) -> V3<S> {
    let zero = F::<S>::splat(simd, 0.0);
    let stride = tile.model.stride();
    let a = step.root.position + inner.x;
    let clear = clear_of_segment(simd, tile, i);
    let mut ends = [contact(simd, pose, a), contact(simd, pose, a + e)];
    // Padding has no length.
    let cuts = may_cut(pose, e, &ends, clear) & tether.length.simd_gt(0.0);
    if !cuts.any_true() {
        return e;
    }
    let place = deepest(simd, pose, &pose.end, (a, e), &ends);
    let depth = cuts.select((clear - place.distance).max(0.0), zero);
    if !depth.simd_gt(0.0).any_true() {
        return e;
    }

    // What of the depth did not stop an approach presses on in the next solve, as of points; the place rubs at most μ times as hard.
    let there = a + e * place.at;
    let carried = surface_displacement(simd, pose, there);
    let inner_v = V3::load(simd, &tile.state[i - stride][state::V..]);
    let v = V3::load(simd, &tile.state[i][state::V..]);
    let v = inner_v + (v - inner_v) * place.at;
    let approach = place.normal.dot(carried - v * F::splat(simd, step.h)).max(0.0);
    let approach = if finish.moves { approach } else { zero };
    let push = (depth - approach).max(0.0) * finish.press;
    let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
    let row = &mut tile.state[i - stride][state::SPAN];
    store(load(simd, row) + free.select(load(simd, &tile.rest[i][rest::MASS]) * push, zero), row);
    if !finish.moves {
        return e;
    }

    let mut q = e;
    let mut out = (place, depth);
    for k in 0..CORRECTIONS {
        if k > 0 {
            ends[1] = contact(simd, pose, a + q);
            let place = deepest(simd, pose, &pose.end, (a, q), &ends);
            let depth = (clear - place.distance).max(0.0);
            out = (place, depth);
        }
        let (place, depth) = &out;
        q = tether.clamp(tether.swing_out(q, place.normal, *depth / place.at.max(NEAREST)));
    }
    let place = &out.0;
    let friction = Root::<S>::fibre(simd, tile.strand).2;
    let slide = inner.way + (q - old) * place.at - carried;
    let tangent = slide - place.normal * place.normal.dot(slide);
    let hold = friction * depth / tangent.dot(tangent).max(1e-30).sqrt();
    q = tether.clamp(q - tangent * hold.min(1.0));
    V3::select(depth.simd_gt(0.0), q, e)
}
