//! A square of the picture, drawn by one thread from start to end while it sits in the first-level cache.

use crate::{
    body::{Bodies, Samples, Surface},
    hair::{
        blend::{CLOSED, Canvas},
        piece::Piece,
        ribbon::{CHUNK_BITS, Chunk, PIECE_BITS, Setup},
    },
    sort,
    tonemap::{Encoder, filmic},
};
use fearless_simd::dispatch;
use glam::{Vec2, Vec3, Vec4};

/// Side of a tile [pixels].
pub(crate) const SIDE: usize = 32;
/// Pixels in a tile.
pub(crate) const PIXELS: usize = SIDE * SIDE;

/// How the picture is cut into tiles, row by row.
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

    /// Tiles in a row, and rows.
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

/// A thread's working memory.
pub(crate) struct Brush {
    canvas: Box<Canvas>,
    samples: Box<Samples>,
    surfaces: Box<[Surface; PIXELS]>,
    entries: Vec<u64>,
    scratch: Vec<u64>,
}

impl Default for Brush {
    fn default() -> Self {
        let none = Surface { color: Vec3::ZERO, cover: 0.0, depth: f32::INFINITY };
        Self {
            canvas: Box::default(),
            samples: Box::default(),
            surfaces: Box::new([none; PIXELS]),
            entries: Vec::new(),
            scratch: Vec::new(),
        }
    }
}

/// Draws a tile's pieces, nearest first, until nothing shows through any more.
#[inline(always)]
fn lay_hair(canvas: &mut Canvas, entries: &[u64], chunks: &[Chunk], origin: Vec2) {
    let mut fetched = [Piece::default(); BATCH];
    for (round, few) in entries.chunks(BATCH).enumerate() {
        for (piece, e) in fetched.iter_mut().zip(few) {
            let chunk = *e >> PIECE_BITS & ((1 << CHUNK_BITS) - 1);
            *piece = chunks[chunk as usize].pieces[(*e & ((1 << PIECE_BITS) - 1)) as usize];
        }
        for piece in &fetched[..few.len()] {
            let mut open = piece.open();
            open.a -= origin;
            open.b -= origin;
            canvas.draw(&open);
        }
        if round % 16 == 15 && canvas.pixels.iter().all(|p| p.w <= CLOSED) {
            break;
        }
    }
}

/// Pieces fetched from memory together, so that their cache misses overlap.
const BATCH: usize = 32;

impl Brush {
    /// Draws one tile and writes its pixels, row by row, three bytes each.
    pub fn draw(
        &mut self,
        setup: &Setup,
        bodies: &Bodies,
        chunks: &[Chunk],
        encoder: &Encoder,
        tile: usize,
        out: &mut [[u8; 3]; PIXELS],
    ) {
        let corner = setup.tiles.corner(tile);
        *self.canvas = Canvas::default();
        let canvas = &mut *self.canvas;
        let body = bodies.draw(
            setup.frame,
            &setup.view,
            setup.shadow,
            corner,
            &mut self.samples,
            &mut self.surfaces,
        );
        if body {
            let [near, far] = setup.depths;
            for (i, s) in self.surfaces.iter().enumerate().filter(|(_, s)| s.cover > 0.0) {
                canvas.body[i] = (s.color * s.cover).extend(-s.cover);
                canvas.body_depth[i] = (s.depth - near) / (far - near);
            }
        }
        self.entries.clear();
        for (c, chunk) in chunks.iter().enumerate() {
            // Room for the chunk's number lies between the depth key and the piece's number.
            self.entries.extend(chunk.tile(tile).iter().map(|e| e | (c as u64) << PIECE_BITS));
        }
        sort::sort(&mut self.entries, &mut self.scratch);
        let origin = Vec2::new(corner[0] as f32, corner[1] as f32);
        dispatch!(setup.level, _simd => lay_hair(canvas, &self.entries, chunks, origin));
        if body {
            (0..PIXELS).filter(|i| self.surfaces[*i].cover > 0.0).for_each(|i| {
                if canvas.body_depth[i].is_finite() {
                    canvas.lay_body(i);
                }
            });
        }
        self.develop(setup, encoder, corner, out);
    }

    /// Backdrop, exposure, tone curve, 8 bits.
    fn develop(&self, setup: &Setup, encoder: &Encoder, corner: [usize; 2], out: &mut [[u8; 3]; PIXELS]) {
        let [w, h] = setup.tiles.size().map(|n| n as f32);
        let backdrop = &setup.frame.background;
        let gain = setup.frame.lighting.exposure.exp2();
        for (i, out) in out.iter_mut().enumerate() {
            let (x, y) = (corner[0] + i % SIDE, corner[1] + i / SIDE);
            let pixel: Vec4 = self.canvas.pixels[i];
            let from = Vec2::new(x as f32 / w - 0.5, y as f32 / h - 0.42);
            // A pool of light: falls off smoothly, level in the middle.
            let pool = (-3.2 * from.length_squared()).exp();
            let behind = backdrop.edge.lerp(backdrop.center, pool);
            let light = pixel.truncate() + behind * pixel.w;
            *out = encoder.encode(filmic(light * gain), x, y);
        }
    }
}
