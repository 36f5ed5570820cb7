//! Strands to ribbons: a run of strands is lit, projected, smoothed, cut into straight pieces, and filed by picture tile.

use super::{
    order::{Order, Run},
    piece::{self, MAX_WIDTH, Piece},
    shade::{self, Block, Fibre, LANES, Shader},
};
use crate::{
    camera::{NEAR, View},
    frame::{Frame, HairDraw},
    shadow::Shadow,
    sort::KEY_BITS,
    tile::{SIDE, Tiles},
};
use fearless_simd::{Simd, dispatch};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// Bits of an entry below the depth key: a chunk's number and a piece's number in it.
pub(crate) const PIECE_BITS: u32 = 24;
pub(crate) const CHUNK_BITS: u32 = 64 - KEY_BITS - PIECE_BITS;
/// Most pieces that one segment is smoothed into.
const MAX_PIECES: f32 = 16.0;
/// Distance that hair is moved towards the camera against bodies [m]: roots lie on the skin, and must not flicker in it.
const ROOT_BIAS: f32 = 4e-4;
/// Deepest shadow that a root takes from the voxels of its own scalp.
const KEY_BIAS: f32 = 3e-3;

/// What every chunk of a frame needs.
pub(crate) struct Setup<'a> {
    pub frame: &'a Frame<'a>,
    pub view: View,
    pub tiles: Tiles,
    pub order: &'a Order,
    pub shadow: &'a Shadow,
    pub shader: Shader,
    /// Instruction set to use.
    pub level: fearless_simd::Level,
    /// Nearest and farthest depth of hair [m].
    pub depths: [f32; 2],
}

/// A point on the screen.
#[derive(Clone, Copy, Debug)]
struct Dot {
    at: Vec2,
    /// Share of the frame's depth range, 0 to 1; NaN where the point cannot be drawn.
    depth: f32,
    width: f32,
    /// Packed for a [`Piece`].
    bits: (u16, u16),
}

impl Dot {
    #[inline(always)]
    fn new(at: Vec2, depth: f32, width: f32) -> Self {
        Self { at, depth, width, bits: (piece::pack_depth(depth), piece::pack_width(width)) }
    }
}

/// One chunk's results and memory.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    pub pieces: Vec<Piece>,
    /// Depth key and piece number of each piece, tile after tile.
    entries: Vec<u64>,
    /// First entry of each tile; shape `[tiles + 1]`.
    starts: Vec<u32>,
    unsorted: Vec<(u32, u64)>,
    blocks: Vec<Block>,
    dots: Vec<Dot>,
}

impl Chunk {
    /// Entries of one tile: depth key on top, piece number below.
    pub fn tile(&self, tile: usize) -> &[u64] {
        &self.entries[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }

    /// Draws a run of strands into pieces.
    pub fn fill(&mut self, setup: &Setup, run: &Run) {
        dispatch!(setup.level, simd => self.fill_with(simd, setup, run));
    }

    #[inline(always)]
    fn fill_with<S: Simd>(&mut self, simd: S, setup: &Setup, run: &Run) {
        self.pieces.clear();
        self.unsorted.clear();
        let hair = &setup.frame.hair[run.hair];
        let look = hair.look;
        let ends = [look.root_color, look.tip_color].map(shade::pigment);
        for s in setup.order.strands(run) {
            let range = hair.range(s);
            if range.len() < 2 {
                continue;
            }
            if self.project(setup, hair, range.clone()) {
                let random = shade::random(s as u32);
                // More or less of the same pigment: lighter strands are also less saturated.
                let amount = 1.0 + look.variation.clamp(0.0, 1.0) * random * 0.6;
                self.light(setup, hair, range, ends, amount);
                let fibre = Fibre::new(look, shade::random(!(s as u32)));
                setup.shader.shade(simd, &fibre, &mut self.blocks);
                self.cut(setup);
            }
        }
        self.file(setup.tiles.count());
    }

    /// Projects a strand; false if all of it is off one side of the picture.
    #[inline(always)]
    fn project(&mut self, setup: &Setup, hair: &HairDraw, range: Range<usize>) -> bool {
        let scale = 2.0 * hair.width_scale * setup.view.focal;
        let [near, far] = setup.depths;
        let per_depth = 1.0 / (far - near);
        self.dots.clear();
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for i in range {
            let q = setup.view.project(hair.points[i]);
            let width = hair.radii[i] * scale / q.z;
            let good = q.z > NEAR && q.is_finite() && q.truncate().abs().max_element() < 1e6 && width >= 0.0;
            if good {
                let reach = Vec2::splat(0.5 * width + 1.0);
                low = low.min(q.truncate() - reach);
                high = high.max(q.truncate() + reach);
            }
            let depth = if good { ((q.z - ROOT_BIAS - near) * per_depth).clamp(0.0, 1.0) } else { f32::NAN };
            self.dots.push(Dot::new(q.truncate(), depth, width.min(MAX_WIDTH)));
        }
        let [w, h] = setup.tiles.size();
        high.x > 0.0 && high.y > 0.0 && low.x < w as f32 && low.y < h as f32
    }

    /// Gathers what the shader needs at every point.
    #[inline(always)]
    fn light(&mut self, setup: &Setup, hair: &HairDraw, range: Range<usize>, ends: [Vec3; 2], amount: f32) {
        let points = &hair.points[range.clone()];
        let n = points.len();
        // Lanes past the last point keep old numbers, which nobody reads.
        self.blocks.resize(n.div_ceil(LANES), Block::default());
        let per_point = 1.0 / (n - 1) as f32;
        for (i, p) in points.iter().enumerate() {
            let along = points[(i + 1).min(n - 1)] - points[i.saturating_sub(1)];
            let t = along.try_normalize().unwrap_or(Vec3::Y);
            let pigment = match hair.colors.get(range.start + i) {
                Some(color) => shade::pigment(*color),
                None => ends[0].lerp(ends[1], i as f32 * per_point),
            };
            let light = setup.shadow.light(*p);
            let body = setup.shadow.body(*p, KEY_BIAS, 1);
            self.blocks[i / LANES].set(i % LANES, *p, t, pigment * amount, light, body);
        }
    }

    /// Cuts the strand's smooth curve into straight pieces.
    #[inline(always)]
    fn cut(&mut self, setup: &Setup) {
        let tolerance = setup.frame.quality.smoothness.clamp(0.02, 4.0);
        let n = self.dots.len();
        let color = |blocks: &[Block], i: usize| blocks[i / LANES].color[i % LANES];
        let direction = |dots: &[Dot], i: usize| (dots[i + 1].at - dots[i].at).normalize_or_zero();
        // Directions of the segment before, of this one and of the next; zero where there is none.
        let mut before = Vec2::ZERO;
        let mut here = direction(&self.dots, 0);
        let mut from = color(&self.blocks, 0);
        for i in 0..n - 1 {
            let (a, b) = (self.dots[i], self.dots[i + 1]);
            let next = if i + 2 < n && self.dots[i + 2].depth >= 0.0 {
                direction(&self.dots, i + 1)
            } else {
                Vec2::ZERO
            };
            let to = color(&self.blocks, i + 1);
            let good = a.depth >= 0.0 && b.depth >= 0.0;
            if good {
                let length = a.at.distance(b.at);
                // Tangents at the joints halve the angle there: a Catmull-Rom curve by chord length, which has no
                // loops or overshoot where points are spaced unevenly.
                let turn = |other: Vec2| {
                    if other == Vec2::ZERO { 0.0 } else { (other - here).length() }
                };
                let bend = length * 0.0625 * (turn(before) + turn(next));
                let count = (bend / tolerance).sqrt().ceil().clamp(1.0, MAX_PIECES);
                let (ta, tb) = match count > 1.0 {
                    true => ((before + here).normalize_or(here), (here + next).normalize_or(here)),
                    false => (here, here),
                };
                let starts = i == 0 || before == Vec2::ZERO;
                let ends = next == Vec2::ZERO;
                if count <= 1.0 {
                    self.push(setup, [a, b], [from, to], [starts, ends]);
                } else {
                    let (first, last) = (piece::open_color(from), piece::open_color(to));
                    let (mut p, mut start) = (a, from);
                    for k in 1..=count as usize {
                        let u = k as f32 / count;
                        let closes = k as f32 == count;
                        let (q, end) = match closes {
                            true => (b, to),
                            false => {
                                let at = hermite(a.at, b.at, ta * length, tb * length, u);
                                let mix = |a: f32, b: f32| a + (b - a) * u;
                                let dot = Dot::new(at, mix(a.depth, b.depth), mix(a.width, b.width));
                                (dot, piece::pack_color(first.lerp(last, u)))
                            }
                        };
                        self.push(setup, [p, q], [start, end], [starts && k == 1, ends && closes]);
                        (p, start) = (q, end);
                    }
                }
            }
            before = if good { here } else { Vec2::ZERO };
            here = next;
            if here == Vec2::ZERO && i + 2 < n {
                here = direction(&self.dots, i + 1);
            }
            from = to;
        }
    }

    /// Files one piece under every tile that it touches.
    #[inline(always)]
    fn push(&mut self, setup: &Setup, [a, b]: [Dot; 2], colors: [u32; 2], cap: [bool; 2]) {
        let [w, h] = setup.tiles.size();
        let widest = a.width.max(b.width);
        let reach = 0.5 * widest + 1.0;
        let (low, high) = (a.at.min(b.at) - reach, a.at.max(b.at) + reach);
        let outside = low.x >= w as f32 || low.y >= h as f32 || high.x <= 0.0 || high.y <= 0.0;
        if widest < 1e-4 || outside || self.pieces.len() >= 1 << PIECE_BITS {
            return;
        }
        let key = (0.5 * (a.depth + b.depth) * ((1u32 << KEY_BITS) - 1) as f32) as u64;
        let entry = key << (64 - KEY_BITS) | self.pieces.len() as u64;
        let widths = [a.bits.1 | cap[0] as u16, b.bits.1 | cap[1] as u16];
        self.pieces.push(Piece::new([a.at, b.at], [a.bits.0, b.bits.0], widths, colors));
        let side = SIDE as f32;
        let tile = |x: f32, n: usize| (x.max(0.0) / side).min((n - 1) as f32) as usize;
        let [nx, ny] = setup.tiles.grid();
        let (rows, columns) = (tile(low.y, ny)..=tile(high.y, ny), tile(low.x, nx)..=tile(high.x, nx));
        let d = b.at - a.at;
        let single = rows.start() == rows.end() || columns.start() == columns.end();
        for y in rows {
            let (mut first, mut last) = (*columns.start(), *columns.end());
            if !single {
                // Only where the line crosses this row of tiles: a long piece must not claim a whole rectangle.
                let at = |y: f32| {
                    a.at.x + d.x * if d.y == 0.0 { 0.0 } else { ((y - a.at.y) / d.y).clamp(0.0, 1.0) }
                };
                let (x0, x1) = (at(y as f32 * side - reach), at((y + 1) as f32 * side + reach));
                if d.y.abs() > 1e-3 {
                    first = first.max(tile(x0.min(x1) - reach, nx));
                    last = last.min(tile(x0.max(x1) + reach, nx));
                }
            }
            for x in first..=last {
                self.unsorted.push(((y * nx + x) as u32, entry));
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
        self.entries.resize(self.unsorted.len(), 0);
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

/// Cubic through `a` and `b` with tangents `ta` and `tb`.
#[inline(always)]
fn hermite(a: Vec2, b: Vec2, ta: Vec2, tb: Vec2, u: f32) -> Vec2 {
    let (u2, u3) = (u * u, u * u * u);
    a * (2.0 * u3 - 3.0 * u2 + 1.0) + b * (3.0 * u2 - 2.0 * u3) + ta * (u3 - 2.0 * u2 + u) + tb * (u3 - u2)
}
