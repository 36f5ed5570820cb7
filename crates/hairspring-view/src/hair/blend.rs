//! Draws pieces into pixels: computes how much of each pixel a ribbon covers, and blends it.
//!
//! A pixel holds (red, green, blue, transmittance). Pieces are drawn nearest first, so a coverage `a` of
//! color `c` adds `transmittance · a · (c, −1)`. This is one multiply-add of four lanes, and nothing behind
//! an opaque pixel has an effect.
//!
//! The ribbon is traversed along its longer axis, one column (or row) of pixels per step. In each column it
//! is an interval with a length of the ribbon's width over the cosine of its slope. The coverage of a pixel
//! is the length of the interval in it: exact area, for any width. An interval shorter than a pixel is drawn
//! one pixel long and fainter by the same factor, so it always covers two pixels in proportion to its
//! position. When the hair moves, light moves smoothly from pixel to pixel, and its sum is constant.

use super::segment::Piece;
use crate::{
    tile::{PATCH, PATCHES, PIXELS, SIDE},
    work::Work,
};
use glam::{Vec2, Vec4};

/// Transmittance below which a pixel counts as opaque: less than half a step of 8 bits.
pub(crate) const CLOSED: f32 = 0.002;

/// One tile while it is being drawn.
pub(crate) struct Canvas {
    /// (red, green, blue, transmittance).
    pub pixels: [Vec4; PIXELS],
    /// Depth of the body as a fraction of the frame's depth range; infinite if there is none or if it was
    /// already blended.
    pub body_depth: [f32; PIXELS],
    /// Fraction of the pixel that the body covers.
    pub body_cover: [f32; PIXELS],
    /// Transmittance in front of the body, set once the body is blended.
    pub body_seen: [f32; PIXELS],
    /// Patches that had a pixel which was not opaque at the last survey.
    pub open: u16,
    /// Maximum transmittance of each patch at the last survey.
    pub through: [f32; PATCHES * PATCHES],
    /// Work done so far.
    pub work: Work,
}

impl Default for Canvas {
    fn default() -> Self {
        Self {
            pixels: [Vec4::W; PIXELS],
            body_depth: [f32::INFINITY; PIXELS],
            body_cover: [0.0; PIXELS],
            body_seen: [0.0; PIXELS],
            open: u16::MAX,
            through: [1.0; PATCHES * PATCHES],
            work: Work::default(),
        }
    }
}

impl Canvas {
    /// Blends the body into a pixel, so that it hides what comes after. Its light is added later.
    #[inline]
    pub fn lay_body(&mut self, pixel: usize) {
        let before = self.pixels[pixel].w;
        self.body_seen[pixel] = before;
        self.body_depth[pixel] = f32::INFINITY;
        self.pixels[pixel].w = before * (1.0 - self.body_cover[pixel]);
    }

    /// Updates the transmittance of the open patches, and closes those that are opaque.
    #[inline(always)]
    pub fn survey(&mut self) {
        for patch in 0..PATCHES * PATCHES {
            if self.open >> patch & 1 == 0 {
                continue;
            }
            let corner = patch / PATCHES * PATCH * SIDE + patch % PATCHES * PATCH;
            let mut most = Vec4::ZERO;
            for row in (0..PATCH).map(|y| corner + y * SIDE) {
                most = self.pixels[row..row + PATCH].iter().fold(most, |most, pixel| most.max(*pixel));
            }
            self.through[patch] = most.w;
            if most.w <= CLOSED {
                self.open &= !(1 << patch);
            }
        }
    }

    /// Maximum transmittance in any of `patches` at the last survey.
    #[inline(always)]
    pub fn through_any(&self, patches: u16) -> f32 {
        let mut left = patches & self.open;
        let mut most = 0.0f32;
        while left != 0 {
            most = most.max(self.through[left.trailing_zeros() as usize]);
            left &= left - 1;
        }
        most
    }

    /// Whether a piece may touch an open patch.
    #[inline(always)]
    pub fn is_open_to(&self, piece: &Piece) -> bool {
        // A thin piece covers two pixels; a wide one extends by half of its width over the cosine of its
        // slope.
        let reach = piece.width[0].max(piece.width[1]) + 1.0;
        let (low, high) = (piece.a.min(piece.b) - reach, piece.a.max(piece.b) + reach);
        let side = SIDE as f32;
        if low.max_element() >= side || high.min_element() < 0.0 {
            return false;
        }
        let patch = |at: f32| (at.clamp(0.0, side - 1.0) * (1.0 / PATCH as f32)) as u32;
        let columns = (2u16 << patch(high.x)) - (1 << patch(low.x));
        let rows = u16::MAX << (PATCHES as u32 * patch(low.y));
        let rows = rows & u16::MAX >> (PATCHES as u32 * (PATCHES as u32 - 1 - patch(high.y)));
        self.open & (columns * 0x1111) & rows != 0
    }

    #[inline(always)]
    fn add(&mut self, pixel: usize, cover: f32, color: Vec4, depth: f32) {
        // The index is already in range; the modulo only removes the bounds checks.
        let pixel = pixel % PIXELS;
        if depth > self.body_depth[pixel] {
            self.lay_body(pixel);
        }
        let at = &mut self.pixels[pixel];
        *at += color * (at.w * cover);
    }

    /// Draws a piece whose coordinates are relative to the tile's corner. Must be called inside a
    /// `dispatch!`.
    #[inline(always)]
    pub fn draw(&mut self, piece: &Piece) {
        let d = piece.b - piece.a;
        if d.x.abs() >= d.y.abs() {
            self.walk::<1, SIDE>(piece, piece.a, piece.b);
        } else {
            self.walk::<SIDE, 1>(piece, Vec2::new(piece.a.y, piece.a.x), Vec2::new(piece.b.y, piece.b.x));
        }
    }

    /// Traverses along x. A step along x moves `ALONG` pixels in memory, and a step along y moves `ACROSS`.
    #[inline(always)]
    fn walk<const ALONG: usize, const ACROSS: usize>(&mut self, piece: &Piece, a: Vec2, b: Vec2) {
        // From left to right.
        let (a, b, from, to) = if a.x <= b.x { (a, b, 0, 1) } else { (b, a, 1, 0) };
        let d = b - a;
        if d.x <= 1e-6 {
            return;
        }
        let inverse = 1.0 / d.x;
        // Half of the interval across the direction of traversal: width over the cosine of the slope.
        let lean = 0.5 * (1.0 + (d.y * inverse).powi(2)).sqrt();
        let (half0, half1) = (piece.width[from] * lean, piece.width[to] * lean);
        // A column at a joint belongs to the piece whose span contains the column's center, so joints have
        // neither gaps nor overlaps. At the ends of the strand, the last column counts by the fraction that
        // is covered.
        let first = if piece.cap[from] { a.x.floor() } else { (a.x - 0.5).ceil() };
        let last = if piece.cap[to] { b.x.ceil() } else { (b.x - 0.5).ceil() };
        let (first, last) = (first.max(0.0) as i32, (last.min(SIDE as f32)) as i32);
        self.work.columns += (last - first).max(0) as u64;
        let thin = half0.max(half1) <= 0.5;
        for column in first..last {
            let x = column as f32;
            let t = ((x + 0.5 - a.x) * inverse).clamp(0.0, 1.0);
            let y = a.y + d.y * t;
            let half = half0 + (half1 - half0) * t;
            let mut strength = 1.0;
            if piece.cap[from] {
                strength *= (x + 1.0 - a.x).min(1.0);
            }
            if piece.cap[to] {
                strength *= (b.x - x).min(1.0);
            }
            let color = piece.color[from] + (piece.color[to] - piece.color[from]) * t;
            let depth = piece.depth[from] + (piece.depth[to] - piece.depth[from]) * t;
            let base = column as usize * ALONG;
            if thin {
                let cover = 2.0 * half * strength;
                let top = (y - 0.5).floor();
                let share = y - 0.5 - top;
                let row = top as i32;
                if (0..SIDE as i32).contains(&row) {
                    self.add(base + row as usize * ACROSS, cover * (1.0 - share), color, depth);
                }
                if (-1..SIDE as i32 - 1).contains(&row) {
                    self.add(base + (row + 1) as usize * ACROSS, cover * share, color, depth);
                }
            } else {
                let reach = half.max(0.5);
                let faint = strength * half / reach;
                let (low, high) = (y - reach, y + reach);
                let rows = (low.floor().max(0.0) as i32)..(high.ceil().min(SIDE as f32) as i32);
                for row in rows {
                    let cover = (high.min(row as f32 + 1.0) - low.max(row as f32)) * faint;
                    self.add(base + row as usize * ACROSS, cover, color, depth);
                }
            }
        }
    }
}
