//! Rasterizes triangles with edge functions (Pineda 1988), both for the camera and for the shadow map.

use fearless_simd::{f32x8, mask32x8, prelude::*};
use glam::{Vec2, Vec3};

/// How far outside a triangle a sample still counts, as a fraction of the triangle. Adjacent triangles round
/// differently, and must not leave a gap.
const EDGE: f32 = 1e-5;

/// A triangle on the screen, prepared for testing sample positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScreenTriangle {
    /// First and past-the-end column and row of pixels that the triangle may touch.
    pub columns: [u32; 2],
    pub rows: [u32; 2],
    /// The first corner. Sample positions are relative to it. In picture coordinates, edge functions are
    /// small differences of products near a million, which would lose all precision for triangles smaller
    /// than a pixel.
    first: Vec2,
    /// Weights of the second and the third corner, as dot products with the offset from the first. The first
    /// corner has the rest.
    weights: [Vec2; 2],
    /// The interpolated nearness at the first corner, and its gradient. Greater is nearer.
    nearness: (f32, Vec2),
    /// Index of the source triangle.
    pub source: u32,
}

impl ScreenTriangle {
    /// Corners are (x, y, nearness) in pixels; `None` if empty, not finite, or outside a picture of `width` × `height`.
    pub fn new(corner: [Vec3; 3], source: u32, width: usize, height: usize) -> Option<Self> {
        let [a, b, c] = corner;
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if !(area.abs() > 1e-12 && area.is_finite()) {
            return None;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f32, high: f32, n: usize| {
            let first = low.max(0.0).min(n as f32) as u32;
            [first, ((high.max(-1.0) + 1.0) as u32).min(n as u32)]
        };
        let (columns, rows) = (range(low.x, high.x, width), range(low.y, high.y, height));
        if columns[0] >= columns[1] || rows[0] >= rows[1] {
            return None;
        }
        let (to_b, to_c) = ((b - a).truncate(), (c - a).truncate());
        let weights = [-to_c.perp() / area, to_b.perp() / area];
        let slope = weights[0] * (b.z - a.z) + weights[1] * (c.z - a.z);
        Some(Self { columns, rows, first: a.truncate(), weights, nearness: (a.z, slope), source })
    }

    /// Calls `hit(column, row, nearness)` for each pixel of the rectangle (`corner`, `size`) whose center is
    /// inside the triangle. Columns and rows count from the corner of the rectangle.
    #[inline]
    pub fn cover(&self, corner: [usize; 2], size: [usize; 2], mut hit: impl FnMut(usize, usize, f32)) {
        let [columns, rows] = self.within(corner, size);
        for y in rows {
            for x in columns.clone() {
                let way = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - self.first;
                let (v, w) = (self.weights[0].dot(way), self.weights[1].dot(way));
                if v.min(w).min(1.0 - v - w) >= -EDGE {
                    hit(x - corner[0], y - corner[1], self.nearness.0 + self.nearness.1.dot(way));
                }
            }
        }
    }

    /// Like [`ScreenTriangle::cover`], but for eight samples of each pixel, at `offset` (columns, rows) in
    /// the pixel. `hit` receives a mask of the samples inside and their nearness. Must be called inside a
    /// `dispatch!`.
    #[inline(always)]
    pub fn cover_samples<S: Simd>(
        &self,
        offset: [f32x8<S>; 2],
        corner: [usize; 2],
        size: [usize; 2],
        mut hit: impl FnMut(usize, usize, mask32x8<S>, f32x8<S>),
    ) {
        let [columns, rows] = self.within(corner, size);
        for y in rows {
            let down = offset[1] + (y as f32) - self.first.y;
            for x in columns.clone() {
                let along = offset[0] + (x as f32) - self.first.x;
                let [to_v, to_w] = self.weights;
                let (v, w) = (along * to_v.x + down * to_v.y, along * to_w.x + down * to_w.y);
                let inside = v.min(w).min(-(v + w) + 1.0).simd_ge(-EDGE);
                let (nearness, slope) = self.nearness;
                hit(x - corner[0], y - corner[1], inside, along * slope.x + down * slope.y + nearness);
            }
        }
    }

    /// Columns and rows of the triangle's bounds that are inside a rectangle.
    #[inline(always)]
    fn within(&self, corner: [usize; 2], size: [usize; 2]) -> [std::ops::Range<usize>; 2] {
        [(self.columns, 0), (self.rows, 1)].map(|(range, axis)| {
            let clip = |i: u32| (i as usize).clamp(corner[axis], corner[axis] + size[axis]);
            clip(range[0])..clip(range[1])
        })
    }
}

/// The triangles that touch each cell of a picture, row by row.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Bins {
    /// Sorts the triangles of a picture of `size` pixels into cells of `cell` pixels.
    pub fn fill(&mut self, triangles: &[ScreenTriangle], size: [usize; 2], cell: [usize; 2]) {
        let [across, down] = [0, 1].map(|axis| size[axis].div_ceil(cell[axis]).max(1));
        let touched = |t: &ScreenTriangle| {
            let cells = |range: [u32; 2], n: usize| range[0] as usize / n..(range[1] as usize).div_ceil(n);
            let columns = cells(t.columns, cell[0]);
            cells(t.rows, cell[1]).flat_map(move |y| columns.clone().map(move |x| y * across + x))
        };
        self.starts.clear();
        self.starts.resize(across * down + 1, 0);
        triangles.iter().flat_map(touched).for_each(|cell| self.starts[cell + 1] += 1);
        (0..across * down).for_each(|cell| self.starts[cell + 1] += self.starts[cell]);
        self.triangles.clear();
        self.triangles.resize(self.starts[across * down] as usize, 0);
        let mut next = self.starts.clone();
        for (i, t) in triangles.iter().enumerate() {
            for cell in touched(t) {
                self.triangles[next[cell] as usize] = i as u32;
                next[cell] += 1;
            }
        }
    }

    /// The triangles of one cell, in their original order.
    pub fn cell(&self, cell: usize) -> &[u32] {
        if cell + 1 >= self.starts.len() {
            return &[];
        }
        &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    /// A slanted surface of triangles far smaller than a pixel, far from the picture's corner: every sample
    /// hits it, at the correct depth.
    #[test]
    fn tiny_triangles_leave_no_gaps_and_do_not_jump() {
        let side = 4000;
        let (origin, step, n) = (Vec2::new(3001.3, 3977.7), 0.037, 300);
        let corner = |i: usize, j: usize| {
            let at = origin + Vec2::new(i as f32 + 0.31 * j as f32, j as f32) * step;
            at.extend(0.7 + 0.01 * (at.x - origin.x))
        };
        let from = [3007, 3981];
        let offset = [[0.5625; 8], [0.3125; 8]];
        let mut seen = [[0.0f32; 4]; 4];
        let mut cover = |t: &ScreenTriangle| {
            dispatch!(Level::new(), simd => {
                let lanes = offset.map(|o| f32x8::simd_from(simd, o));
                t.cover_samples(lanes, from, [4, 4], |x, y, inside, z| {
                    let mut lanes = [0.0; 8];
                    inside.select(z, f32x8::splat(simd, 0.0)).store_slice(&mut lanes);
                    seen[y][x] = seen[y][x].max(lanes[7]);
                });
            });
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let quad = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            for t in [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]] {
                ScreenTriangle::new(t, 0, side, side).iter().for_each(&mut cover);
            }
        }
        for row in seen {
            for (x, z) in row.into_iter().enumerate() {
                let expected = 0.7 + 0.01 * ((from[0] + x) as f32 + 0.5625 - origin.x);
                assert!((z - expected).abs() < 1e-4, "{z} in place of {expected}");
            }
        }
    }
}
