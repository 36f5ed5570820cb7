//! Pieces into pixels: how much of each pixel a ribbon covers, and what that adds.
//!
//! A pixel holds (red, green, blue, what still shows through). Pieces come nearest first, so a covering `a` of colour `c` adds
//! `through · a · (c, −1)`: one multiply and add of four lanes, and nothing behind a closed pixel counts.
//!
//! The ribbon is walked along its longer axis, one column (or row) of pixels a step. In a column it is an interval as long as its width over
//! the cosine of its slope, and a pixel's covering is the interval's length in it: exact area, for any width. An interval shorter than a pixel
//! is drawn a pixel long and fainter by the same factor, so it always lies on two pixels in proportion to its place: as the hair
//! moves, light moves from pixel to pixel without a jump, and its sum stays.

use super::segment::Piece;
use crate::{
    tile::{PATCH, PATCHES, PIXELS, SIDE},
    work::Work,
};
use glam::{Vec2, Vec4};

/// Light that still passes where a pixel counts as closed: under half a step of 8 bits.
pub(crate) const CLOSED: f32 = 0.002;

/// One tile while it is being drawn.
pub(crate) struct Canvas {
    /// (red, green, blue, what still shows through).
    pub pixels: [Vec4; PIXELS],
    /// Share of the frame's depth range at which the body lies; infinite: none, or already laid in.
    pub body_depth: [f32; PIXELS],
    /// Share of the pixel that the body covers.
    pub body_cover: [f32; PIXELS],
    /// What showed through before the body, once that is laid in.
    pub body_seen: [f32; PIXELS],
    /// Which patches have a pixel that was not closed when last surveyed.
    pub open: u16,
    /// The most that showed through in a pixel of each patch when last surveyed.
    pub through: [f32; PATCHES * PATCHES],
    /// What was done so far.
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
    /// Lays the body into a pixel: it hides what comes after. Its light is added later.
    #[inline]
    pub fn lay_body(&mut self, pixel: usize) {
        let before = self.pixels[pixel].w;
        self.body_seen[pixel] = before;
        self.body_depth[pixel] = f32::INFINITY;
        self.pixels[pixel].w = before * (1.0 - self.body_cover[pixel]);
    }

    /// Looks at what shows through the open patches, and closes those where nothing does.
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

    /// The most that showed through in a pixel of any of `patches` when last surveyed.
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
        // A thin piece lies on two pixels, a wide one on half of its width over the cosine of its slope.
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
        // It is less already; said so that it need not be asked for each array.
        let pixel = pixel % PIXELS;
        if depth > self.body_depth[pixel] {
            self.lay_body(pixel);
        }
        let at = &mut self.pixels[pixel];
        *at += color * (at.w * cover);
    }

    /// Draws a piece whose coordinates count from the tile's corner. Call it inside a `dispatch!`.
    #[inline(always)]
    pub fn draw(&mut self, piece: &Piece) {
        let d = piece.b - piece.a;
        if d.x.abs() >= d.y.abs() {
            self.walk::<1, SIDE>(piece, piece.a, piece.b);
        } else {
            self.walk::<SIDE, 1>(piece, Vec2::new(piece.a.y, piece.a.x), Vec2::new(piece.b.y, piece.b.x));
        }
    }

    /// Walks along x; a step along x moves `ALONG` pixels in memory, along y `ACROSS`.
    #[inline(always)]
    fn walk<const ALONG: usize, const ACROSS: usize>(&mut self, piece: &Piece, a: Vec2, b: Vec2) {
        // From left to right.
        let (a, b, from, to) = if a.x <= b.x { (a, b, 0, 1) } else { (b, a, 1, 0) };
        let d = b - a;
        if d.x <= 1e-6 {
            return;
        }
        let inverse = 1.0 / d.x;
        // Interval across the walk: width / cosine of the slope, halved.
        let lean = 0.5 * (1.0 + (d.y * inverse).powi(2)).sqrt();
        let (half0, half1) = (piece.width[from] * lean, piece.width[to] * lean);
        // A joint belongs to the piece in whose span the column's middle lies, so joints neither gape nor double. At
        // the strand's own ends the last column counts by the share of it that is reached.
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
