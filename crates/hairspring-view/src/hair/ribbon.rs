//! Strands to the screen: a run of strands is projected, and its segments are filed by picture tile. Light and smoothing wait until a tile sees them.

use super::{
    order::{Order, Run},
    segment::{self, Dot},
    shade::{LANES, Shader},
};
use crate::{
    camera::{NEAR, View},
    frame::Frame,
    shadow::Shadow,
    tile::{PATCH, PATCHES, SIDE, Tiles},
};
use fearless_simd::dispatch;
use glam::{Vec2, Vec3};

/// Greatest width of a strand on the screen [pixels].
const MAX_WIDTH: f32 = 512.0;
/// Distance that hair is moved towards the camera against bodies [m]: roots lie on the skin, and must not flicker in it.
const ROOT_BIAS: f32 = 1e-3;

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
        dispatch!(setup.level, _simd => self.fill_in_lanes(setup, run, dots));
    }

    #[inline(always)]
    fn fill_in_lanes(&mut self, setup: &Setup, run: &Run, dots: &mut [Dot]) {
        self.unsorted.clear();
        self.reach = 0.0;
        self.widest = 0.0;
        let hair = &setup.frame.hair[run.hair];
        let scale = 2.0 * hair.width_scale * setup.view.focal;
        let mut first = 0;
        for s in setup.order.strands(run) {
            let range = hair.range(s);
            let slots = range.len().next_multiple_of(LANES);
            let dots = &mut dots[first..first + slots];
            let n = range.len();
            if project(setup, &hair.points[range.clone()], &hair.radii[range], scale, dots) {
                self.cut(setup, run.slots.start + first, &dots[..n]);
            }
            first += slots;
        }
        self.file(setup.tiles.count());
    }

    /// Files the segments of a strand whose first slot is `slot`.
    #[inline(always)]
    fn cut(&mut self, setup: &Setup, slot: usize, dots: &[Dot]) {
        let direction = |i: usize| match dots[i].linked() {
            true => {
                let d = dots[i + 1].at - dots[i].at;
                let length = d.length();
                if length > 0.0 { (d / length, length) } else { (Vec2::ZERO, 0.0) }
            }
            false => (Vec2::ZERO, 0.0),
        };
        let (mut before, mut here) = ((Vec2::ZERO, 0.0), direction(0));
        for i in 0..dots.len() - 1 {
            let next = direction(i + 1);
            if dots[i].linked() {
                let bulge = segment::bulge(before.0, here.0, next.0, here.1);
                self.push(setup, slot + i, [dots[i], dots[i + 1]], bulge);
            }
            (before, here) = (here, next);
        }
    }

    /// Files one segment under every tile that it touches.
    #[inline(always)]
    fn push(&mut self, setup: &Setup, slot: usize, [a, b]: [Dot; 2], bulge: f32) {
        let [w, h] = setup.tiles.size();
        let widest = a.width().max(b.width());
        let reach = 0.5 * widest + 1.0 + bulge;
        let (low, high) = (a.at.min(b.at) - reach, a.at.max(b.at) + reach);
        let outside = low.x >= w as f32 || low.y >= h as f32 || high.x <= 0.0 || high.y <= 0.0;
        if widest < 1e-4 || outside {
            return;
        }
        self.widest = self.widest.max(widest);
        self.reach = self.reach.max(0.5 * (a.depth - b.depth).abs());
        let depth = (0.5 * (a.depth + b.depth) * DEPTHS + 0.5) as u64;
        let key = depth << 48 | (slot as u64) << 16;
        // In patches: [columns, rows].
        let size = setup.tiles.grid().map(|n| n * PATCHES);
        let patch = |x: f32, n: usize| (x.max(0.0) * (1.0 / PATCH as f32)).min((n - 1) as f32) as usize;
        let columns = [patch(low.x, size[0]), patch(high.x, size[0])];
        let rows = [patch(low.y, size[1]), patch(high.y, size[1])];
        let d = b.at - a.at;
        let single = rows[0] / PATCHES == rows[1] / PATCHES || columns[0] / PATCHES == columns[1] / PATCHES;
        for y in rows[0] / PATCHES..=rows[1] / PATCHES {
            let (mut first, mut last) = (columns[0], columns[1]);
            if !single && d.y.abs() > 1e-3 {
                // Only where the line crosses this row of tiles: a long segment must not claim a whole rectangle.
                let at = |y: f32| a.at.x + d.x * ((y - a.at.y) / d.y).clamp(0.0, 1.0);
                let top = (y * SIDE) as f32;
                let (x0, x1) = (at(top - reach), at(top + SIDE as f32 + reach));
                first = first.max(patch(x0.min(x1) - reach, size[0]));
                last = last.min(patch(x0.max(x1) + reach, size[0]));
            }
            let across = patches([rows[0], rows[1]], y * PATCHES);
            for x in first / PATCHES..=last / PATCHES {
                let mask = patches([first, last], x * PATCHES);
                let touched = (0..PATCHES).fold(0, |sum, row| {
                    sum | if across >> row & 1 != 0 { mask << (row * PATCHES) } else { 0 }
                });
                let tile = y * setup.tiles.grid()[0] + x;
                self.unsorted.push((tile as u32, Entry(key | touched as u64)));
            }
        }
    }

    /// Brings the entries into the order of the tiles.
    #[inline(always)]
    fn file(&mut self, tiles: usize) {
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

/// Projects a strand; false if none of it can be seen in the picture.
#[inline(always)]
fn project(setup: &Setup, points: &[Vec3], radii: &[f32], scale: f32, dots: &mut [Dot]) -> bool {
    let [near, far] = setup.depths;
    let per_depth = 1.0 / (far - near);
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let mut was_good = false;
    for (i, (p, radius)) in points.iter().zip(radii).enumerate() {
        let q = setup.view.project(*p);
        let width = radius * scale / q.z;
        let good = q.z > NEAR && q.is_finite() && q.truncate().abs().max_element() < 1e6 && width >= 0.0;
        dots[i] = Dot::END;
        if good {
            let reach = Vec2::splat(0.5 * width + 1.0);
            low = low.min(q.truncate() - reach);
            high = high.max(q.truncate() + reach);
            let depth = ((q.z - ROOT_BIAS - near) * per_depth).clamp(0.0, 1.0);
            dots[i] = Dot::new(q.truncate(), depth, width.min(MAX_WIDTH));
        }
        if good && was_good {
            dots[i - 1].link();
        } else if i > 0 {
            dots[i - 1].cut();
        }
        was_good = good;
    }
    // The last point, and the slots that no point fills.
    dots[points.len().max(1) - 1..].iter_mut().for_each(Dot::cut);
    let [w, h] = setup.tiles.size();
    points.len() >= 2 && high.x > 0.0 && high.y > 0.0 && low.x < w as f32 && low.y < h as f32
}

/// Which of the tile's patches in a row lie in `range`, both ends included; `tile` is its first.
#[inline(always)]
fn patches(range: [usize; 2], tile: usize) -> u32 {
    let first = range[0].max(tile) - tile;
    let last = range[1].min(tile + PATCHES - 1) - tile;
    (2 << last) - (1 << first)
}
