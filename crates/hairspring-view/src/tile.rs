//! A square of the picture. One thread draws it from start to end, while it stays in the first-level cache.

use crate::{
    body::{Bodies, Lit, Samples, Surface},
    hair::{
        blend::{CLOSED, Canvas},
        color::Colors,
        ribbon::{Chunk, DEPTHS, Setup},
        segment::{Dot, Segment},
        shade::LANES,
    },
    pass::Pass,
    sort::Buckets,
    work::Work,
};
use fearless_simd::dispatch;
use glam::Vec2;

/// Side of a tile [pixels].
pub(crate) const SIDE: usize = 32;
/// Pixels in a tile.
pub(crate) const PIXELS: usize = SIDE * SIDE;

/// Side of a patch, the part of a tile that is closed as a unit [pixels].
pub(crate) const PATCH: usize = 8;
/// Number of patches per row of a tile, and number of rows.
pub(crate) const PATCHES: usize = SIDE / PATCH;

/// The division of the picture into tiles, row by row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tiles {
    size: [usize; 2],
}

impl Tiles {
    pub fn new(width: usize, height: usize) -> Self {
        Self { size: [width, height] }
    }

    /// Width and height of the picture [pixels].
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Number of tiles per row, and number of rows.
    pub fn grid(&self) -> [usize; 2] {
        self.size.map(|n| n.div_ceil(SIDE).max(1))
    }

    pub fn count(&self) -> usize {
        self.grid()[0] * self.grid()[1]
    }

    /// Pixel position of a tile's corner.
    pub fn corner(&self, tile: usize) -> [usize; 2] {
        let [nx, _] = self.grid();
        [tile % nx * SIDE, tile / nx * SIDE]
    }
}

/// The strands of a frame, ready to be drawn by tiles.
pub(crate) struct Strands<'a> {
    pub chunks: &'a [Chunk],
    /// Projected points; shape `[slots]`.
    pub dots: &'a [Dot],
    pub colors: &'a Colors,
    /// Maximum difference in depth between a segment's middle and its ends, as a fraction of the range.
    pub reach: f32,
    /// Maximum width [pixels].
    pub widest: f32,
}

/// A thread's working memory.
pub(crate) struct Brush {
    canvas: Box<Canvas>,
    samples: Box<Samples>,
    surfaces: Box<[Surface; PIXELS]>,
    buckets: Buckets,
}

impl Default for Brush {
    fn default() -> Self {
        let none = Surface { cover: 0.0, depth: f32::INFINITY };
        Self {
            canvas: Box::default(),
            samples: Box::default(),
            surfaces: Box::new([none; PIXELS]),
            buckets: Buckets::default(),
        }
    }
}

/// Number of segments that are fetched from memory together, so that their cache misses overlap.
const BATCH: usize = 32;

/// Number of segments that are drawn between two surveys of the canvas. It spreads the cost of a survey over
/// them.
const SURVEY: usize = 24;

/// Transmittance below which hair is thinned out (see [`thinned`]).
const THIN_FROM: f32 = 0.5;

/// Fraction of strands that is drawn if `through` is the maximum transmittance of the pixels nearby. Each
/// drawn strand represents those that are left out and is drawn correspondingly wider (stochastic
/// simplification, Cook, Halstead, Planck & Ryu 2007). The contribution of a strand to a pixel stays below
/// that of the strands in front of it. The coverage is right on average. Whether a strand is drawn depends on
/// its index, so the same strands are drawn from frame to frame. No strand becomes wider than a pixel;
/// `widest` is the maximum width [pixels].
#[inline(always)]
fn thinned(through: f32, widest: f32) -> f32 {
    (through * (1.0 / THIN_FROM)).max(widest).min(1.0)
}

/// Rank of a block of points, 0 to 1, in the order in which blocks are left out. Multiples of the golden
/// ratio thin out neighbors evenly.
#[inline(always)]
fn rank(slot: usize) -> f32 {
    const GOLDEN: u32 = 0x9e37_79b9;
    (((slot / LANES) as u32).wrapping_mul(GOLDEN) >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// Draws a tile's segments, nearest first, until all pixels are opaque. Closed patches cost nothing: their
/// segments are not sorted, fetched or lit.
#[inline(always)]
fn lay_hair<P: Pass>(
    pass: &P,
    setup: &Setup,
    strands: &Strands,
    canvas: &mut Canvas,
    buckets: &mut Buckets,
    origin: Vec2,
) {
    let tolerance = setup.frame.quality.smoothness.clamp(0.02, 4.0);
    let walls = walls(canvas);
    let mut next_wall = nearest_from(&walls, f32::NEG_INFINITY);
    let mut fetched = [Fetched::default(); BATCH];
    let (mut drawn, mut bucket) = (0, Vec::new());
    while let Some((nearest, entries)) = buckets.next() {
        let here = nearest as f32 / DEPTHS - strands.reach;
        if next_wall < here {
            lay_walls(canvas, &walls, here);
            next_wall = nearest_from(&walls, here);
        }
        if drawn >= SURVEY {
            canvas.survey();
            drawn = 0;
        }
        if canvas.open == 0 {
            break;
        }
        bucket.clear();
        for e in entries.iter().filter(|e| e.patches() & canvas.open != 0) {
            if rank(e.slot()) < thinned(canvas.through_any(e.patches()), strands.widest) {
                bucket.push(*e);
            }
        }
        bucket.sort_unstable();
        drawn += bucket.len();
        canvas.work.drawn += bucket.len() as u64;
        for few in bucket.chunks(BATCH) {
            for (to, e) in fetched.iter_mut().zip(few) {
                *to = Fetched::new(strands, e.slot());
            }
            for (from, e) in fetched.iter().zip(few) {
                let wider = 1.0 / thinned(canvas.through_any(e.patches()), strands.widest);
                let color = pass.hair(setup, strands.colors, e.slot(), from.colors);
                let segment = Segment::new(&from.dots, origin);
                let mut pieces = segment.pieces(tolerance, color);
                if setup.wisp.is_one() {
                    for mut piece in pieces {
                        piece.width = piece.width.map(|w| w * wider);
                        canvas.draw(&piece);
                    }
                    continue;
                }
                let owner = &setup.order.owners[e.slot() / LANES];
                let points = setup.frame.hair[owner.hair as usize].range(owner.strand as usize).len();
                let i = owner.first as usize + e.slot() % LANES;
                let hairs = setup.wisp.hairs(&segment, owner.strand, i, points);
                while let Some(mut piece) = pieces.next() {
                    piece.width = piece.width.map(|w| w * wider);
                    for hair in 0..hairs.count() {
                        let hair = hairs.piece(hair, &piece, pieces.along());
                        if canvas.is_open_to(&hair) {
                            canvas.draw(&hair);
                        }
                    }
                }
            }
        }
    }
}

/// The data of a segment that is read from memory for drawing.
#[derive(Clone, Copy)]
struct Fetched {
    /// The point before the segment, its own two points, and the one after.
    dots: [Dot; 4],
    /// Packed colors of its own two points.
    colors: [u32; 2],
}

impl Default for Fetched {
    fn default() -> Self {
        Self { dots: [Dot::END; 4], colors: [0; 2] }
    }
}

impl Fetched {
    /// Fetches the segment whose first point is in `slot`.
    #[inline(always)]
    fn new(strands: &Strands, slot: usize) -> Self {
        let (dots, mut out) = (strands.dots, Self::default());
        if slot > 0 {
            out.dots[0] = dots[slot - 1];
        }
        out.dots[1] = dots[slot];
        out.dots[2] = dots[slot + 1];
        if slot + 2 < dots.len() {
            out.dots[3] = dots[slot + 2];
        }
        out.colors = [strands.colors.peek(slot), strands.colors.peek(slot + 1)];
        out
    }
}

/// For each patch that the body fills, the maximum depth of the body in it, as a fraction of the depth range;
/// infinite elsewhere.
fn walls(canvas: &Canvas) -> [f32; PATCHES * PATCHES] {
    let mut walls = [f32::NEG_INFINITY; PATCHES * PATCHES];
    for pixel in 0..PIXELS {
        let wall = &mut walls[pixel / SIDE / PATCH * PATCHES + pixel % SIDE / PATCH];
        let filled = canvas.body_cover[pixel] >= 1.0;
        *wall = if filled { wall.max(canvas.body_depth[pixel]) } else { f32::INFINITY };
    }
    walls
}

/// The nearest wall that is not nearer than `depth`; infinite if there is none.
#[inline(always)]
fn nearest_from(walls: &[f32; PATCHES * PATCHES], depth: f32) -> f32 {
    walls.iter().fold(f32::INFINITY, |nearest, wall| if *wall >= depth { wall.min(nearest) } else { nearest })
}

/// Closes the patches whose walls are nearer than `depth`.
fn lay_walls(canvas: &mut Canvas, walls: &[f32; PATCHES * PATCHES], depth: f32) {
    for (patch, wall) in walls.iter().enumerate() {
        if *wall < depth && canvas.open >> patch & 1 != 0 {
            let corner = patch / PATCHES * PATCH * SIDE + patch % PATCHES * PATCH;
            for pixel in (0..PATCH * PATCH).map(|i| corner + i / PATCH * SIDE + i % PATCH) {
                if canvas.body_depth[pixel].is_finite() {
                    canvas.lay_body(pixel);
                }
            }
        }
    }
}

impl Brush {
    /// Draws one tile and writes its pixels, row by row.
    pub fn draw<P: Pass>(
        &mut self,
        pass: &P,
        setup: &Setup,
        bodies: &Bodies,
        strands: &Strands,
        tile: usize,
        out: &mut [P::Pixel; PIXELS],
    ) -> Work {
        let corner = setup.tiles.corner(tile);
        *self.canvas = Canvas::default();
        let canvas = &mut *self.canvas;
        let body = bodies.draw(setup.level, tile, corner, &mut self.samples, &mut self.surfaces);
        if body {
            let [near, far] = setup.depths;
            for (i, s) in self.surfaces.iter().enumerate().filter(|(_, s)| s.cover > 0.0) {
                canvas.body_cover[i] = s.cover;
                canvas.body_depth[i] = (s.depth - near) / (far - near);
            }
        }
        // Patches outside the picture are not drawn.
        let [w, h] = setup.tiles.size();
        for patch in 0..PATCHES * PATCHES {
            let (x, y) = (corner[0] + patch % PATCHES * PATCH, corner[1] + patch / PATCHES * PATCH);
            if x >= w || y >= h {
                canvas.open &= !(1 << patch);
            }
        }
        self.buckets.fill(strands.chunks.iter().map(|c| c.tile(tile)));
        let origin = Vec2::new(corner[0] as f32, corner[1] as f32);
        dispatch!(setup.level, _simd => lay_hair(pass, setup, strands, canvas, &mut self.buckets, origin));
        if body {
            let lit = Lit { frame: setup.frame, view: &setup.view, shadow: setup.shadow, level: setup.level };
            for i in (0..PIXELS).filter(|i| self.surfaces[*i].cover > 0.0) {
                if canvas.body_depth[i].is_finite() {
                    canvas.lay_body(i);
                }
                let seen = canvas.body_seen[i];
                // Surfaces hidden by hair need no lighting.
                if seen > CLOSED {
                    let color = pass.body(&lit, bodies, corner, &self.samples, i);
                    canvas.pixels[i] += (color * (self.surfaces[i].cover * seen)).extend(0.0);
                }
            }
        }
        dispatch!(setup.level, _simd => self.develop(pass, setup, corner, out));
        Work { filed: strands.chunks.iter().map(|c| c.tile(tile).len() as u64).sum(), ..self.canvas.work }
    }

    /// Adds ground and backdrop, and makes the pixels of the picture.
    #[inline(always)]
    fn develop<P: Pass>(&self, pass: &P, setup: &Setup, corner: [usize; 2], out: &mut [P::Pixel; PIXELS]) {
        let [w, h] = setup.tiles.size().map(|n| n as f32);
        let backdrop = &setup.frame.background;
        // The pool of light falls off smoothly and is flat at the center. It is a product of one factor per
        // column and one per row.
        let pool = |from: f32| (-3.2 * from * from).exp();
        let columns: [f32; SIDE] = std::array::from_fn(|x| pool((corner[0] + x) as f32 / w - 0.5));
        for (y, row) in out.chunks_mut(SIDE).enumerate() {
            let down = pool((corner[1] + y) as f32 / h - 0.42);
            for (x, out) in row.iter_mut().enumerate() {
                let wall = backdrop.edge.lerp(backdrop.center, columns[x] * down);
                let at = [corner[0] + x, corner[1] + y];
                *out = pass.pixel(setup, at, self.canvas.pixels[y * SIDE + x], wall);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For any fraction and any number of blocks per strand, the drawn strands with their larger widths add
    /// up to all strands, over any thousand neighbors and for any block of each.
    #[test]
    fn drawn_strands_keep_the_total_width_of_all() {
        for (through, widest) in [(1.0, 0.1), (0.4, 0.1), (0.1, 0.1), (0.01, 0.1), (0.01, 0.6), (0.2, 3.0)] {
            let share = thinned(through, widest);
            assert!(widest.min(1.0) / share <= 1.0, "none is wider than a pixel");
            for blocks in [1, 2, 3, 4, 7, 8, 16] {
                for first in [0, 5000, 123_456] {
                    let slot = |strand: usize| (first + strand * blocks) * LANES;
                    let drawn = (0..1000).filter(|strand| rank(slot(*strand)) < share).count();
                    let sum = drawn as f32 / share;
                    assert!((sum - 1000.0).abs() < 100.0, "share {share}, {blocks} blocks: {sum} of 1000");
                }
            }
        }
    }
}
