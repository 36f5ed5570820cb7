//! Long range attachments: no point gets much farther from its root than it was at rest (Kim, Chentanez & Müller 2012, *Long Range Attachments*).
//!
//! ```text
//!   root ●╮ ╭╮ ╭╮            at rest the tip of a coil is at r, and its hair is much longer than that:
//!         ╰─╯╰─╯╰─● tip      with a tether of 1.2 it comes no farther than 1.2 r, however heavy it is
//!        └────r────┘
//! ```
//!
//! Not physics: what keeps a coil together is its stiffness. For an artist who wants the fall of hair and no more of it than this. What is beyond its tether
//! is pulled back in the solve, by a spring that all of the strand knows of; what that could not know (a fall, twenty times its weight) ends in `limit`.

use super::{
    assemble::SubstepContext,
    model::stretch::STRETCH,
    post_solve::{Particle, SegmentLimit},
    system::System,
    tile::{Tile, rest},
};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, load};

/// How far a spring may let a point be beyond its tether, over the tether's length [1].
const SLACK: f32 = 1e-3;

/// Adds the pull on point `i`, the second of the window, which is at `x` from the root and drifts by `drift`.
#[inline(always)]
pub fn pull<S: Simd, const B: usize>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &Tile,
    (i, x, drift): (usize, V3<S>, V3<S>),
    system: &mut impl System<S, B>,
) {
    let Some(reach) = tile.tether_lengths.get(i) else { return };
    let (size, out) = x.length_and_unit();
    let excess = size - load(simd, reach);
    let far = excess.simd_gt(0.0);
    if !far.any_true() {
        return;
    }
    // Like a segment's: there is nothing that it should give way to.
    let k = load(simd, &tile.rest[i][rest::MASS]) * (STRETCH / (step.h * step.h));
    let zero = F::splat(simd, 0.0);
    let (k, excess) = (far.select(k, zero), far.select(excess, zero));
    system.add_diagonal(1, Sym3::outer(out, k));
    system.add_force(1, out * (k * -(excess + out.dot(drift))));
}

/// Whether point `i`, at `x` from the root, is beyond its tether.
#[inline(always)]
pub fn exceeds_lra<S: Simd>(simd: S, tile: &Tile, i: usize, x: V3<S>) -> Mask<S> {
    let Some(reach) = tile.tether_lengths.get(i) else { return Mask::splat(simd, false) };
    let reach = load(simd, reach) * (1.0 + SLACK);
    x.dot(x).simd_gt(reach * reach)
}

/// Where point `i` may be that is at `e` from the point before, which is `at`: no farther from the root than its tether is long, within the limits of its
/// segment. Where not both can be, it points to the root.
///
/// Straight toward the root as far as the segment may shorten, and only then aside: a segment that points away from the root would have to swing by √(2 l δ)
/// to come back by δ at its length, which is motion out of nothing.
#[inline(always)]
pub fn apply_lra<S: Simd>(
    simd: S,
    tile: &Tile,
    i: usize,
    (at, link): (&Particle<S>, &SegmentLimit<S>),
    e: V3<S>,
) -> V3<S> {
    let x = at.x + e;
    let far = exceeds_lra(simd, tile, i, x);
    if !far.any_true() {
        return e;
    }
    let reach = load(simd, &tile.tether_lengths[i]) * (1.0 + SLACK);
    let (size, out) = x.length_and_unit();
    let pulled = e - out * (size - reach);
    let l = link.within(pulled.length_and_unit().0);
    let (d, away) = at.x.length_and_unit();
    let along = (reach * reach - d * d - l * l) / (d * 2.0).max(1e-12);
    let along = along.max(-l).min(l);
    let (_, side) = (e - away * away.dot(e)).length_and_unit();
    let aside = (l * l - along * along).max(0.0).sqrt();
    V3::select(far, away * along + side * aside, e)
}
