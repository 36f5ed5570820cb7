//! Long range attachments: no point gets much farther from its root than it was at rest (Kim, Chentanez & Müller 2012, *Long Range Attachments*).
//!
//! ```text
//!   root ●╮ ╭╮ ╭╮            at rest the tip of a coil is at r, and its hair is much longer than that:
//!         ╰─╯╰─╯╰─● tip      with a tether of 1.2 it comes no farther than 1.2 r, however heavy it is
//!        └────r────┘
//! ```
//!
//! Not physics: what keeps a coil together is its stiffness. For an artist who wants the fall of hair and no more of it than this.

use super::{
    lanes::{V3, load},
    limit::Particle,
    tile::Tile,
};
use fearless_simd::prelude::*;

/// Where point `i` may be that is at `e` from the point before, which is `at`: no farther from the root than its tether is long, at the same length. Where not
/// both can be, it points to the root.
#[inline(always)]
pub fn tethered<S: Simd>(simd: S, tile: &Tile, i: usize, at: &Particle<S>, e: V3<S>) -> V3<S> {
    let Some(reach) = tile.tethers.get(i) else { return e };
    let reach = load(simd, reach);
    let x = at.x + e;
    let far = x.dot(x).simd_gt(reach * reach);
    if !far.any_true() {
        return e;
    }
    // Swung about the point before, at its length: the place of the sphere that is nearest to where it was.
    let (l, _) = e.length_and_unit();
    let (d, away) = at.x.length_and_unit();
    let along = (reach * reach - d * d - l * l) / (d * 2.0).max(1e-12);
    let along = along.max(-l).min(l);
    let (_, side) = (e - away * away.dot(e)).length_and_unit();
    let aside = (l * l - along * along).max(0.0).sqrt();
    V3::select(far, away * along + side * aside, e)
}
