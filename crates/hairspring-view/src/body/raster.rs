//! Triangles to samples: edge functions (Pineda 1988), for the camera and for the shadow map alike.

use glam::{Vec2, Vec3};

/// Rows in a band: the side of a picture tile.
pub(crate) const BANDS: usize = crate::tile::SIDE;

/// A triangle on the screen, set up for testing sample positions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScreenTriangle {
    /// First and past-last column and row of pixels that it may touch.
    pub columns: [u32; 2],
    pub rows: [u32; 2],
    /// Weight of each corner: `weights[i].dot((x, y, 1))`; all are 0 or more inside.
    weights: [Vec3; 3],
    /// The nearness that is interpolated: linear on the screen, greater is nearer.
    nearness: Vec3,
    /// Index of the triangle it came from.
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
        let edge = |p: Vec3, q: Vec3| Vec3::new(p.y - q.y, q.x - p.x, p.x * q.y - p.y * q.x) / area;
        let weights = [edge(b, c), edge(c, a), edge(a, b)];
        let nearness = weights[0] * a.z + weights[1] * b.z + weights[2] * c.z;
        Some(Self { columns, rows, weights, nearness, source })
    }

    /// Calls `hit(column, row, nearness)` for each pixel of the window (`corner`, `size`) whose sample at `offset` in it lies inside;
    /// columns and rows count from the window's corner.
    #[inline]
    pub fn cover(
        &self,
        corner: [usize; 2],
        size: [usize; 2],
        offset: Vec2,
        mut hit: impl FnMut(usize, usize, f32),
    ) {
        let clip = |range: [u32; 2], from: usize, n: usize| {
            let clip = |i: u32| (i as usize).clamp(from, from + n);
            clip(range[0])..clip(range[1])
        };
        let columns = clip(self.columns, corner[0], size[0]);
        for y in clip(self.rows, corner[1], size[1]) {
            for x in columns.clone() {
                let p = Vec3::new(x as f32 + offset.x, y as f32 + offset.y, 1.0);
                let inside =
                    self.weights[0].dot(p).min(self.weights[1].dot(p)).min(self.weights[2].dot(p)) >= 0.0;
                if inside {
                    hit(x - corner[0], y - corner[1], self.nearness.dot(p));
                }
            }
        }
    }
}

/// Which triangles touch each band of rows.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Bins {
    pub fn fill(&mut self, triangles: &[ScreenTriangle], height: usize) {
        let bands = height.div_ceil(BANDS);
        let touched = |t: &ScreenTriangle| t.rows[0] as usize / BANDS..(t.rows[1] as usize).div_ceil(BANDS);
        self.starts.clear();
        self.starts.resize(bands + 1, 0);
        triangles.iter().flat_map(touched).for_each(|band| self.starts[band + 1] += 1);
        (0..bands).for_each(|band| self.starts[band + 1] += self.starts[band]);
        self.triangles.clear();
        self.triangles.resize(self.starts[bands] as usize, 0);
        let mut next = self.starts.clone();
        for (i, t) in triangles.iter().enumerate() {
            for band in touched(t) {
                self.triangles[next[band] as usize] = i as u32;
                next[band] += 1;
            }
        }
    }

    /// Triangles of one band, in their order.
    pub fn band(&self, band: usize) -> &[u32] {
        if band + 1 >= self.starts.len() {
            return &[];
        }
        &self.triangles[self.starts[band] as usize..self.starts[band + 1] as usize]
    }
}
