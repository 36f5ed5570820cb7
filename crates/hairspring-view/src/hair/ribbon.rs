//! Strands to the screen: a run of strands is projected, and its segments are filed by picture tile. Light and smoothing wait until a tile sees them.

use super::{
    order::{Order, Run},
    project::{Points, Projection, Track},
    segment::Dot,
    shade::{LANES, Shader},
};
use crate::{
    camera::View,
    frame::Frame,
    shadow::Shadow,
    tile::{PATCH, PATCHES, SIDE, Tiles},
};
use fearless_simd::{dispatch, f32x8, i32x8, prelude::*};
use glam::Vec3;

/// What every run and every tile of a frame needs.
pub(crate) struct Setup<'a> {
    pub frame: &'a Frame<'a>,
    pub view: View,
    pub tiles: Tiles,
    pub order: &'a Order,
    pub shadow: &'a Shadow,
    pub shader: Shader,
    /// Pigment at root and tip of each style.
    pub pigments: Vec<[Vec3; 2]>,
    /// Instruction set to use.
    pub level: fearless_simd::Level,
    /// Nearest and farthest depth of hair [m].
    pub depths: [f32; 2],
}

/// A segment in a tile, packed so that order by number is order by depth: 16 bits of depth at its middle, 32 of the slot of its first point,
/// and 16 that say which patches of the tile it may touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry(pub u64);

/// Steps of an entry's depth.
pub(crate) const DEPTHS: f32 = 65535.0;

impl Entry {
    /// Depth in steps of 1 / [`DEPTHS`] of the range.
    #[inline(always)]
    pub fn depth(self) -> u32 {
        (self.0 >> 48) as u32
    }

    #[inline(always)]
    pub fn slot(self) -> usize {
        (self.0 >> 16) as u32 as usize
    }

    #[inline(always)]
    pub fn patches(self) -> u16 {
        self.0 as u16
    }
}

/// One run's results and memory.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    /// Tile after tile.
    entries: Vec<Entry>,
    /// First entry of each tile; shape `[tiles + 1]`.
    starts: Vec<u32>,
    unsorted: Vec<(u32, Entry)>,
    /// The strand in hand.
    track: Track,
    /// Greatest difference in depth between a segment's middle and its ends, as a share of the range.
    pub reach: f32,
    /// Greatest width [pixels].
    pub widest: f32,
}

impl Chunk {
    /// Entries of one tile.
    pub fn tile(&self, tile: usize) -> &[Entry] {
        &self.entries[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }

    /// Projects a run of strands into `dots`, its slots, and files them.
    pub fn fill(&mut self, setup: &Setup, run: &Run, dots: &mut [Dot]) {
        dispatch!(setup.level, simd => self.fill_in_lanes(simd, setup, run, dots));
    }

    #[inline(always)]
    fn fill_in_lanes<S: Simd>(&mut self, simd: S, setup: &Setup, run: &Run, dots: &mut [Dot]) {
        self.unsorted.clear();
        (self.reach, self.widest) = (0.0, 0.0);
        let hair = &setup.frame.hair[run.hair];
        let scale = 2.0 * hair.width_scale * setup.view.focal;
        let projection = Projection { view: setup.view, depths: setup.depths, scale };
        let mut slot = 0;
        for s in setup.order.strands(run) {
            let range = hair.range(s);
            let slots = range.len().next_multiple_of(LANES);
            self.track.project(simd, &projection, &hair.points[range.clone()], &hair.radii[range.clone()]);
            self.track.store(&mut dots[slot..slot + slots]);
            for first in (0..range.len().saturating_sub(1)).step_by(LANES) {
                self.file(simd, setup, run.slots.start + slot, first);
            }
            slot += slots;
        }
        self.sort(setup.tiles.count());
    }

    /// Files the eight segments of the strand in `track` that begin at point `first` under every tile that they touch; `slot` is that of the
    /// strand's first point.
    #[inline(always)]
    fn file<S: Simd>(&mut self, simd: S, setup: &Setup, slot: usize, first: usize) {
        let [z, a, b, c] = [0, 1, 2, 3].map(|k| self.track.before(simd, first + k));
        let zero = f32x8::splat(simd, 0.0);
        let linked = |a: &Points<S>, b: &Points<S>| a.width.simd_ge(0.0) & b.width.simd_ge(0.0);
        // Unit direction, zero where the strand has a gap, and length.
        let way = |a: &Points<S>, b: &Points<S>| {
            let (x, y) = (b.x - a.x, b.y - a.y);
            let length = (x * x + y * y).sqrt();
            let inverse = linked(a, b).select(f32x8::splat(simd, 1.0) / length.max(1e-12), zero);
            ([x * inverse, y * inverse], length)
        };
        let (here, length) = way(&a, &b);
        // How far the curve may leave the chord. A tangent that leaves it by an angle takes the cubic 4/27 of the chord times its sine away; an
        // angle's sine is at most half the difference of the two unit directions that it halves.
        let turn = |[x, y]: [f32x8<S>; 2]| {
            let none = x.simd_eq(0.0) & y.simd_eq(0.0);
            none.select(zero, (x - here[0]).abs() + (y - here[1]).abs())
        };
        let bulge = length * (2.0 / 27.0) * (turn(way(&z, &a).0) + turn(way(&b, &c).0));
        let widest = a.width.max(b.width);
        let reach = widest * 0.5 + 1.0 + bulge;
        let (low_x, high_x) = (a.x.min(b.x) - reach, a.x.max(b.x) + reach);
        let (low_y, high_y) = (a.y.min(b.y) - reach, a.y.max(b.y) + reach);
        let [w, h] = setup.tiles.size().map(|n| n as f32);
        let seen = linked(&a, &b)
            & widest.simd_ge(1e-4)
            & (low_x.simd_lt(w) & low_y.simd_lt(h))
            & (high_x.simd_gt(0.0) & high_y.simd_gt(0.0));
        let apart = seen.select((a.depth - b.depth).abs() * 0.5, zero);
        self.reach = self.reach.max(apart.reduce_max());
        self.widest = self.widest.max(seen.select(widest, zero).reduce_max());

        let middle = ((a.depth + b.depth) * (0.5 * DEPTHS) + 0.5).to_int::<i32x8<S>>();
        let depths = seen.select(middle, i32x8::splat(simd, -1));
        // In patches: columns and rows, first and last.
        let size = setup.tiles.grid().map(|n| (n * PATCHES - 1) as f32);
        let patch = |x: f32x8<S>, last: f32| {
            let patch = (x.max(0.0) * (1.0 / PATCH as f32)).min(last).to_int::<i32x8<S>>();
            let mut lanes = [0; LANES];
            patch.store_slice(&mut lanes);
            lanes
        };
        let columns = [patch(low_x, size[0]), patch(high_x, size[0])];
        let rows = [patch(low_y, size[1]), patch(high_y, size[1])];
        let (mut depth, mut reaches) = ([0; LANES], [0.0; LANES]);
        depths.store_slice(&mut depth);
        reach.store_slice(&mut reaches);
        for lane in 0..LANES {
            if depth[lane] >= 0 {
                let key = (depth[lane] as u64) << 48 | ((slot + first + lane) as u64) << 16;
                let of = |range: &[[i32; LANES]; 2]| range.map(|patch| patch[lane] as usize);
                self.push(setup, key, first + lane, reaches[lane], of(&columns), of(&rows));
            }
        }
    }

    /// Files the segment from point `i`, which lies in some patches, both ends included.
    #[inline(always)]
    fn push(
        &mut self,
        setup: &Setup,
        key: u64,
        i: usize,
        reach: f32,
        columns: [usize; 2],
        rows: [usize; 2],
    ) {
        let across = setup.tiles.grid()[0];
        let tiles = |range: [usize; 2]| range[0] / PATCHES..=range[1] / PATCHES;
        let straight = tiles(columns).count() == 1 || tiles(rows).count() == 1;
        for y in tiles(rows) {
            let [mut first, mut last] = columns;
            if !straight {
                [first, last] = self.crossed(setup, i, reach, y, columns);
            }
            let rows = patches(rows, y * PATCHES);
            // Bit 4 n for row n.
            let rows = rows & 1 | (rows & 2) << 3 | (rows & 4) << 6 | (rows & 8) << 9;
            for x in tiles([first, last]) {
                let touched = rows * patches([first, last], x * PATCHES);
                self.unsorted.push(((y * across + x) as u32, Entry(key | touched as u64)));
            }
        }
    }

    /// Which of some columns of patches the segment from point `i` crosses in a row of tiles: a long segment must not claim a whole rectangle.
    #[inline(never)]
    fn crossed(
        &self,
        setup: &Setup,
        i: usize,
        reach: f32,
        row: usize,
        [first, last]: [usize; 2],
    ) -> [usize; 2] {
        let (a, d) = (self.track.at(i), self.track.at(i + 1) - self.track.at(i));
        if d.y.abs() <= 1e-3 {
            return [first, last];
        }
        let at = |y: f32| a.x + d.x * ((y - a.y) / d.y).clamp(0.0, 1.0);
        let top = (row * SIDE) as f32;
        let (x0, x1) = (at(top - reach), at(top + SIDE as f32 + reach));
        let end = (setup.tiles.grid()[0] * PATCHES - 1) as f32;
        let patch = |x: f32| (x.max(0.0) * (1.0 / PATCH as f32)).min(end) as usize;
        [first.max(patch(x0.min(x1) - reach)), last.min(patch(x0.max(x1) + reach))]
    }

    /// Brings the entries into the order of the tiles.
    #[inline(always)]
    fn sort(&mut self, tiles: usize) {
        self.starts.clear();
        self.starts.resize(tiles + 1, 0);
        self.unsorted.iter().for_each(|(tile, _)| self.starts[*tile as usize + 1] += 1);
        (0..tiles).for_each(|t| self.starts[t + 1] += self.starts[t]);
        self.entries.clear();
        self.entries.resize(self.unsorted.len(), Entry::default());
        // `starts` walks to the end of each tile while filling, and is shifted back after.
        for (tile, entry) in &self.unsorted {
            let place = &mut self.starts[*tile as usize];
            self.entries[*place as usize] = *entry;
            *place += 1;
        }
        self.starts.copy_within(0..tiles, 1);
        self.starts[0] = 0;
    }
}

/// Which of the tile's patches in a row lie in `range`, both ends included; `tile` is its first.
#[inline(always)]
fn patches(range: [usize; 2], tile: usize) -> u32 {
    let first = range[0].max(tile) - tile;
    let last = range[1].min(tile + PATCHES - 1) - tile;
    (2 << last) - (1 << first)
}
