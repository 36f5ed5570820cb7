//! Long-range attachments (tethers): limit the distance of each point from its root, relative to that at rest
//! (Kim, Chentanez & Müller 2012, *Long Range Attachments*).
//!
//! ```text
//!   root ●╮ ╭╮ ╭╮            at rest the tip of a coil is at the distance r, and the hair is much longer than that:
//!         ╰─╯╰─╯╰─● tip      with a tether of 1.2 it stays within 1.2 r, however heavy it is
//!        └────r────┘
//! ```
//!
//! Tethers are an artistic control, not physics: in reality, stiffness keeps a coil together. They limit how
//! far hair may drop.
//!
//! A point beyond its tether is pulled back in the solve, by a spring that is part of the strand's system.
//! Cases that the solve cannot handle (a fall, with twenty times the weight) are corrected in `post_solve`.

use super::{
    assemble::SubstepContext,
    model::stretch::STRETCH,
    post_solve::{Particle, SegmentLimit},
    system::System,
    tile::{Tile, rest},
};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, load};

/// How far a point may be beyond its tether without correction, over the tether's length [1].
const SLACK: f32 = 1e-3;

/// Adds the tether's force on point `i`, the second of the window. `x` is its position relative to the root
/// and `drift` its predicted displacement.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
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
    // As stiff as a segment: the tether need not yield to anything.
    let k = load(simd, &tile.rest[i][rest::MASS]) * (STRETCH / (step.h * step.h));
    let zero = F::splat(simd, 0.0);
    let (k, excess) = (far.select(k, zero), far.select(excess, zero));
    system.add_diagonal(1, Sym3::outer(out, k));
    system.add_force(1, out * (k * -(excess + out.dot(drift))));
}

/// Returns whether point `i`, at `x` relative to the root, is beyond its tether.
#[inline(always)]
pub fn exceeds_lra<S: Simd>(simd: S, tile: &Tile, i: usize, x: V3<S>) -> Mask<S> {
    let Some(reach) = tile.tether_lengths.get(i) else { return Mask::splat(simd, false) };
    let reach = load(simd, reach) * (1.0 + SLACK);
    x.dot(x).simd_gt(reach * reach)
}

/// Returns the corrected offset `e` of point `i` from the previous point `at`: within its tether's length of
/// the root, and within the limits of its segment. Where both are impossible, the segment points to the root.
///
/// The point first moves straight toward the root as far as the segment may shorten, and only then sideways.
/// A segment that points away from the root would have to swing by √(2 l δ) to come back by δ at constant
/// length, which would create motion.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
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
