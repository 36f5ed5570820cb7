//! Segments stay outside of colliders as points do: where one cuts a corner that its ends stay out of, its outer end swings out until it is
//! clear, and the next solve presses it there (`press`).
//!
//! ```text
//!        a ●━━━╲━━━━┓           gap −d at the place s of the segment: the outer end swings about a by d/s
//!      ────────┐╲   ┃ b
//!      collider│ ╲━━●
//! ```
//!
//! # Missing
//! A place near the inner end is for the next solve: a strand that is caught, or that lands at 30 m/s, cuts in for a moment.

use super::{
    assemble::Step,
    lanes::{F, V3, load},
    limit::{Finish, Particle, Tether},
    root::Root,
    tile::{Tile, rest, state},
};
use crate::collide::{ObstaclePose, deepest, surface_displacement};
use fearless_simd::{mask32x8, prelude::*};

/// How deep a segment may be between its ends, over its length [1]. On a smooth body it is always a little inside: by L/8R of its length over a
/// radius of R. That is no contact: points alone hold it, and a head with segments of a centimetre is a smooth body.
const SAG: f32 = 0.015;

/// How deep at most [m].
const MOST_SAG: f32 = 2e-4;

/// Nearest place to the inner end whose depth the outer end answers wholly, as a part of the segment [1]. What is nearer is for the inner
/// end, in the next solve: a lever that short would throw the outer one.
const NEAREST: f32 = 0.125;

/// Times that a segment swings out; a curved surface leaves a little the first time.
const CORRECTIONS: usize = 2;

/// Least distance that a place between the ends of the segment to point `i` may have [m]: as little as it was authored with.
#[inline(always)]
pub fn clearance<S: Simd>(simd: S, tile: &Tile, i: usize) -> F<S> {
    let inner = i - tile.model.stride();
    let sag = -(load(simd, &tile.rest[inner][rest::LENGTH]) * SAG).min(MOST_SAG);
    tile.sunk.get(i).map_or(sag, |sunk| sag + load(simd, sunk))
}

/// Where point `i` may be, which is at `e` from the strand's point before and was at `old`, so that the segment between them is outside of `pose`; and
/// the force that holds it there in the next solve [N].
#[inline(always)]
pub fn clear<S: Simd>(
    simd: S,
    (finish, step, pose): (&Finish, &Step<S>, &ObstaclePose),
    tile: &Tile,
    (i, old, e): (usize, V3<S>, V3<S>),
    (inner, tether, near): (&Particle<S>, &Tether<S>, mask32x8<S>),
) -> (V3<S>, F<S>) {
    let zero = F::<S>::splat(simd, 0.0);
    let a = step.root.position + inner.x;
    let clear = clearance(simd, tile, i);
    let (mut q, mut force, mut cuts) = (e, zero, near);
    for correction in 0..CORRECTIONS {
        let Some(place) = deepest(simd, pose, (a, q), clear) else { break };
        cuts &= place.found;
        if !cuts.any_true() {
            break;
        }
        let depth = cuts.select(clear - place.distance, zero);
        let mut out = tether.clamp(tether.swing_out(q, place.normal, depth / place.at.max(NEAREST)));
        if correction == 0 {
            // What of the depth did not stop an approach presses on in the next solve, as of points.
            let carried = surface_displacement(simd, pose, e.mul_add(place.at, a));
            let v = |i: usize| V3::load(simd, &tile.state[i][state::V..]);
            let (v_a, v_b) = (v(i - tile.model.stride()), v(i));
            let way = (v_b - v_a).mul_add(place.at, v_a) * F::splat(simd, step.h);
            let approach = place.normal.dot(carried - way).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            force = mass * finish.press * (depth - approach).max(0.0);
            // Back along the surface, at most μ times as far.
            let friction = Root::<S>::fibre(simd, tile.strand).2;
            let slide = (out - old).mul_add(place.at, inner.way) - carried;
            let tangent = slide - place.normal * place.normal.dot(slide);
            let hold = friction * depth / tangent.dot(tangent).max(1e-30).sqrt();
            out = tether.clamp(out - tangent * hold.min(1.0));
        }
        q = V3::select(cuts, out, q);
    }
    (q, force)
}
