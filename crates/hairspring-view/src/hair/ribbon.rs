//! Strands to the screen: projects a run of strands and sorts its segments into picture tiles. Lighting and
//! smoothing are deferred until a tile needs them.

use super::{
    blend::CLOSED,
    order::{Order, Run},
    project::{Points, Projection, Track},
    segment::Dot,
    shade::{LANES, Shader},
    wisp::Wisp,
};
use crate::{
    camera::View,
    frame::Frame,
    ground::Floor,
    shadow::Shadow,
    tile::{PATCH, PATCHES, SIDE, Tiles},
};
use fearless_simd::{dispatch, f32x8, i32x8, mask32x8, prelude::*};
use glam::{Vec2, Vec3};

/// Data that every run and every tile of a frame needs.
pub(crate) struct Setup<'a> {
    pub frame: &'a Frame<'a>,
    pub view: View,
    pub tiles: Tiles,
    pub order: &'a Order,
    pub shadow: &'a Shadow,
    pub shader: Shader,
    pub wisp: Wisp,
    /// Pigment at root and tip of each style.
    pub pigments: Vec<[Vec3; 2]>,
    /// Instruction set to use.
    pub level: fearless_simd::Level,
    /// Nearest and farthest depth of hair [m].
    pub depths: [f32; 2],
    pub floor: Option<Floor>,
}

impl Setup<'_> {
    /// The height below which the ground hides everything [m]; −∞ if no ground is visible.
    pub fn low(&self) -> f32 {
        self.floor.map_or(f32::NEG_INFINITY, |floor| floor.height)
    }

    /// What is behind hair and bodies in the pixel at column and row `at`, where `wall` is the backdrop: the
    /// ground, if there is one. Opaque pixels need none; `through` is the pixel's transmittance.
    #[inline(always)]
    pub fn behind(&self, wall: Vec3, at: [usize; 2], through: f32) -> Vec3 {
        match self.floor.filter(|_| through > CLOSED) {
            Some(floor) => {
                let at = Vec2::new(at[0] as f32 + 0.5, at[1] as f32 + 0.5);
                floor.over(wall, &self.view, at, self.shadow, self.level)
            }
            None => wall,
        }
    }

    /// The share of the backdrop that the ground leaves in the pixel at column and row `at`. The color there is linear in
    /// that of the backdrop, so two backdrops, white and black, give the share.
    #[inline(always)]
    pub fn share_of_wall(&self, at: [usize; 2], through: f32) -> Vec3 {
        match self.floor {
            Some(_) => self.behind(Vec3::ONE, at, through) - self.behind(Vec3::ZERO, at, through),
            None => Vec3::ONE,
        }
    }
}

/// A segment in a tile, packed so that sorting by value sorts by depth: 16 bits for the depth at its middle,
/// 32 for the slot of its first point, and 16 for the patches of the tile that it may touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry(pub u64);

/// Shift that converts a number of patches to a number of tiles.
const TILE: u32 = PATCHES.ilog2();

/// Number of depth steps of an entry.
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

/// The results and the working memory of one run.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    /// Entries, sorted by tile.
    entries: Vec<Entry>,
    /// First entry of each tile; shape `[tiles + 1]`.
    starts: Vec<u32>,
    unsorted: Vec<(u32, Entry)>,
    /// The current strand.
    track: Track,
    /// Maximum difference in depth between a segment's middle and its ends, as a fraction of the range.
    pub reach: f32,
    /// Maximum width [pixels].
    pub widest: f32,
}

impl Chunk {
    /// Entries of one tile.
    pub fn tile(&self, tile: usize) -> &[Entry] {
        &self.entries[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }

    /// Projects a run of strands into `dots`, its slots, and sorts its segments into tiles.
    pub fn fill(&mut self, setup: &Setup, run: &Run, dots: &mut [Dot]) {
        dispatch!(setup.level, simd => self.fill_in_lanes(simd, setup, run, dots));
    }

    #[inline(always)]
    fn fill_in_lanes<S: Simd>(&mut self, simd: S, setup: &Setup, run: &Run, dots: &mut [Dot]) {
        self.unsorted.clear();
        (self.reach, self.widest) = (0.0, 0.0);
        let hair = &setup.frame.hair[run.hair];
        let scale = 2.0 * hair.width_scale * setup.view.focal;
        let projection = Projection { view: setup.view, depths: setup.depths, scale, low: setup.low() };
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

    /// Adds the eight segments of the strand in `track` that begin at point `first` to every tile that they
    /// touch. `slot` is the slot of the strand's first point.
    #[inline(always)]
    fn file<S: Simd>(&mut self, simd: S, setup: &Setup, slot: usize, first: usize) {
        let (z, a) = (self.track.before(simd, first), self.track.before(simd, first + 1));
        let (b, c) = (self.track.before(simd, first + 2), self.track.before(simd, first + 3));
        let zero = f32x8::splat(simd, 0.0);
        let (here, length) = way(simd, &a, &b);
        // Bound on the distance between curve and chord. A tangent at an angle to the chord moves the cubic
        // by at most 4/27 of the chord times the sine of the angle. The tangent bisects the angle between two
        // unit directions, and the sine of its half is at most half of their difference.
        let turns = turn(zero, way(simd, &z, &a).0, here) + turn(zero, way(simd, &b, &c).0, here);
        let bulge = length * (2.0 / 27.0) * turns;
        let widest = a.width.max(b.width);
        let reach = widest * setup.wisp.reach() + 1.0 + bulge;
        let (low_x, high_x) = (a.x.min(b.x) - reach, a.x.max(b.x) + reach);
        let (low_y, high_y) = (a.y.min(b.y) - reach, a.y.max(b.y) + reach);
        let [w, h] = setup.tiles.size();
        let (w, h) = (w as f32, h as f32);
        let seen = linked(&a, &b)
            & widest.simd_ge(1e-4)
            & (low_x.simd_lt(w) & low_y.simd_lt(h))
            & (high_x.simd_gt(0.0) & high_y.simd_gt(0.0));
        let apart = seen.select((a.depth - b.depth).abs() * 0.5, zero);
        self.reach = self.reach.max(apart.reduce_max());
        self.widest = self.widest.max(seen.select(widest, zero).reduce_max());

        let middle = ((a.depth + b.depth) * (0.5 * DEPTHS) + 0.5).to_int::<i32x8<S>>();
        let depths = seen.select(middle, i32x8::splat(simd, -1));
        // In patches: first and last column and row.
        let [nx, ny] = setup.tiles.grid();
        let (end_x, end_y) = ((nx * PATCHES - 1) as f32, (ny * PATCHES - 1) as f32);
        let (left, right) = (patch(low_x, end_x), patch(high_x, end_x));
        let (top, bottom) = (patch(low_y, end_y), patch(high_y, end_y));
        // Most segments are inside one tile.
        let same_column = (left >> TILE).simd_eq(right >> TILE);
        let alone = same_column & (top >> TILE).simd_eq(bottom >> TILE);
        let alone = alone.select((top >> TILE) * nx as i32 + (left >> TILE), i32x8::splat(simd, -1));
        let touched = (bits(simd, left, right, 1) * 0x1111) & bits(simd, top, bottom, PATCHES as i32);
        let (depths, alone, touched) = (store(depths), store(alone), store(touched));
        let (left, right, top, bottom) = (store(left), store(right), store(top), store(bottom));
        let mut reaches = [0.0; LANES];
        reach.store_slice(&mut reaches);
        for lane in 0..LANES {
            if depths[lane] < 0 {
                continue;
            }
            let key = (depths[lane] as u64) << 48 | ((slot + first + lane) as u64) << 16;
            if alone[lane] >= 0 {
                self.unsorted.push((alone[lane] as u32, Entry(key | touched[lane] as u64)));
            } else {
                let columns = [left[lane] as usize, right[lane] as usize];
                let rows = [top[lane] as usize, bottom[lane] as usize];
                self.push(setup, key, first + lane, reaches[lane], columns, rows);
            }
        }
    }

    /// Adds the segment from point `i` to the tiles that it touches. Its patches, given by inclusive ranges,
    /// are in more than one tile.
    #[inline(always)]
    fn push(&mut self, setup: &Setup, key: u64, i: usize, reach: f32, columns: [usize; 2], rows: [usize; 2]) {
        let across = setup.tiles.grid()[0];
        let tiles = |range: [usize; 2]| range[0] / PATCHES..range[1] / PATCHES + 1;
        let straight = tiles(columns).len() == 1 || tiles(rows).len() == 1;
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

    /// The columns of patches that the segment from point `i` crosses in a row of tiles. A long segment would
    /// otherwise occupy a whole rectangle.
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

    /// Sorts the entries by tile.
    #[inline(always)]
    fn sort(&mut self, tiles: usize) {
        self.starts.clear();
        self.starts.resize(tiles + 1, 0);
        self.unsorted.iter().for_each(|(tile, _)| self.starts[*tile as usize + 1] += 1);
        (0..tiles).for_each(|t| self.starts[t + 1] += self.starts[t]);
        self.entries.clear();
        self.entries.resize(self.unsorted.len(), Entry::default());
        // `starts` advances to the end of each tile while filling, and is shifted back afterwards.
        for (tile, entry) in &self.unsorted {
            let place = &mut self.starts[*tile as usize];
            self.entries[*place as usize] = *entry;
            *place += 1;
        }
        self.starts.copy_within(0..tiles, 1);
        self.starts[0] = 0;
    }
}

// Helpers are functions with `inline(always)` and not closures, so that they are compiled for the selected
// instruction set.

/// Whether both points exist.
#[inline(always)]
fn linked<S: Simd>(a: &Points<S>, b: &Points<S>) -> mask32x8<S> {
    a.width.simd_ge(0.0) & b.width.simd_ge(0.0)
}

/// Unit direction, or zero if the strand has a gap, and length [pixels].
#[inline(always)]
fn way<S: Simd>(simd: S, a: &Points<S>, b: &Points<S>) -> ([f32x8<S>; 2], f32x8<S>) {
    let (x, y) = (b.x - a.x, b.y - a.y);
    let length = (x * x + y * y).sqrt();
    let inverse = f32x8::splat(simd, 1.0) / length.max(1e-12);
    let inverse = linked(a, b).select(inverse, f32x8::splat(simd, 0.0));
    ([x * inverse, y * inverse], length)
}

/// Length of the difference of two directions; zero if either is missing.
#[inline(always)]
fn turn<S: Simd>(zero: f32x8<S>, [x, y]: [f32x8<S>; 2], here: [f32x8<S>; 2]) -> f32x8<S> {
    let none = x.simd_eq(0.0) & y.simd_eq(0.0);
    none.select(zero, (x - here[0]).abs() + (y - here[1]).abs())
}

/// Column or row of patches that contains a position; `end` is the last one.
#[inline(always)]
fn patch<S: Simd>(x: f32x8<S>, end: f32) -> i32x8<S> {
    (x.max(0.0) * (1.0 / PATCH as f32)).min(end).to_int()
}

/// In a tile, the bits from patch `first` to `last`, with `step` bits per patch.
#[inline(always)]
fn bits<S: Simd>(simd: S, first: i32x8<S>, last: i32x8<S>, step: i32) -> i32x8<S> {
    let (one, inner) = (i32x8::splat(simd, 1), PATCHES as i32 - 1);
    (one << (((last & inner) + 1) * step)) - (one << ((first & inner) * step))
}

#[inline(always)]
fn store<S: Simd>(lanes: i32x8<S>) -> [i32; LANES] {
    let mut out = [0; LANES];
    lanes.store_slice(&mut out);
    out
}

/// The tile's patches in a row that are in `range` (inclusive); `tile` is the tile's first patch.
#[inline(always)]
fn patches(range: [usize; 2], tile: usize) -> u32 {
    let first = range[0].max(tile) - tile;
    let last = range[1].min(tile + PATCHES - 1) - tile;
    (2 << last) - (1 << first)
}
