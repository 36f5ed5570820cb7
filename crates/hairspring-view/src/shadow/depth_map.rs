//! The depth map of the bodies from the key lamp. It gives sharp shadows, such as that of a nose on a cheek,
//! with softened edges.

use crate::{
    body::raster::{Bins, ScreenTriangle},
    frame::Frame,
    tile::SIDE,
};
use fearless_simd::{Level, dispatch, f32x8, i32x8, prelude::*};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Radius of the filter that softens shadows on skin [texels].
pub(crate) const RADIUS: usize = 4;
/// Places of the taps along an axis around the middle of the filter, in units of their spacing: as many as twice
/// [`RADIUS`].
const PLACES: [f32; 8] = [-3.5, -2.5, -1.5, -0.5, 0.5, 1.5, 2.5, 3.5];
/// Radius of the key lamp over its distance [1]: a soft box of 40 cm in 2 m.
pub(crate) const LAMP: f32 = 0.1;
/// Largest radius of the filter on bodies [m].
pub(crate) const WIDEST: f32 = 0.012;
/// Least cosine between normal and light that is used for the tangent plane [1].
pub(crate) const STEEPEST: f32 = 0.2;
/// Number of rows that one thread draws.
const BAND: usize = SIDE;

/// Empty texels around the bodies. Light on the ground next to their shadow is filtered over some of them,
/// and a filter window that touches a body must not extend over the map's edge. On bodies no window does.
pub(crate) fn border(frame: &Frame) -> f32 {
    if frame.ground_seen().is_some() { 2.0 * RADIUS as f32 + 1.0 } else { 4.0 }
}

/// Depth along the light's rays, as an orthographic picture. Greater is nearer to the lamp.
#[derive(Debug, Default)]
pub(crate) struct DepthMap {
    side: usize,
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    /// Texels per meter, and the texel of the world's origin.
    scale: f32,
    origin: Vec2,
    /// Maximum height above the plane through the origin that faces the lamp [m]; −∞ for empty texels.
    heights: Vec<f32>,
    /// Vertices of one body: texels and height.
    vertices: Vec<Vec3>,
    triangles: Vec<ScreenTriangle>,
    bins: Bins,
}

impl DepthMap {
    /// Draws the frame's bodies from the key lamp.
    pub fn fill(&mut self, frame: &Frame) {
        self.toward = frame.lighting.key.direction.try_normalize().unwrap_or(Vec3::Y);
        self.right = self.toward.any_orthonormal_vector();
        self.up = self.toward.cross(self.right);
        self.triangles.clear();
        let flat = |p: Vec3| Vec2::new(p.dot(self.right), p.dot(self.up));
        let points = frame.bodies.iter().flat_map(|b| b.positions).filter(|p| p.is_finite());
        let (low, high) = points
            .map(|p| flat(*p))
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |b, p| (b.0.min(p), b.1.max(p)));
        let extent = (high - low).max_element();
        self.side = 0;
        if !(extent > 0.0 && extent.is_finite()) {
            return;
        }
        self.side = frame.quality.shadow_texels.clamp(64, 8192) as usize;
        let border = border(frame);
        self.scale = (self.side as f32 - 2.0 * border) / extent;
        self.origin = Vec2::splat(border) - low * self.scale;
        let side = self.side;
        for body in frame.bodies {
            let mut vertices = std::mem::take(&mut self.vertices);
            body.positions.par_iter().map(|p| self.texel(*p)).collect_into_vec(&mut vertices);
            self.triangles.par_extend(body.triangles.par_iter().with_min_len(4096).filter_map(|t| {
                let corner = t.map(|i| vertices.get(i as usize).copied().unwrap_or(Vec3::NAN));
                ScreenTriangle::new(corner, 0, side, side)
            }));
            self.vertices = vertices;
        }
        self.bins.fill(&self.triangles, [side; 2], [side, BAND]);
        self.heights.clear();
        self.heights.resize(side * side, f32::NEG_INFINITY);
        let (triangles, bins) = (&self.triangles, &self.bins);
        self.heights.par_chunks_mut(side * BAND).enumerate().for_each(|(band, rows)| {
            for t in bins.cell(band) {
                let height = rows.len() / side;
                triangles[*t as usize].cover([0, band * BAND], [side, height], |x, y, h| {
                    let at = &mut rows[y * side + x];
                    *at = at.max(h);
                });
            }
        });
    }

    /// Texels per meter; 0 without bodies.
    pub fn scale(&self) -> f32 {
        if self.side > 0 { self.scale } else { 0.0 }
    }

    /// Texel coordinates and height of a point.
    fn texel(&self, p: Vec3) -> Vec3 {
        let xy = Vec2::new(p.dot(self.right), p.dot(self.up)) * self.scale + self.origin;
        xy.extend(p.dot(self.toward))
    }

    /// Fraction of the key lamp's light that bodies let through to eight points, 0 to 1: percentage-closer
    /// filtering (Reeves et al. 1987) of the four texels around each. `bias` [m] keeps a surface from
    /// shadowing itself. Must be called inside a `dispatch!`.
    #[inline(always)]
    pub fn light<S: Simd>(&self, simd: S, p: [f32x8<S>; 3], bias: f32) -> f32x8<S> {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let x = dot(p, self.right) * self.scale + (self.origin.x - 0.5);
        let y = dot(p, self.up) * self.scale + (self.origin.y - 0.5);
        let height = dot(p, self.toward) + bias;
        let edge = self.side as f32 - 2.5;
        // Comparisons with NaN are false. For a map of size 0 they are false too.
        let inside = x.simd_gt(1.0) & y.simd_gt(1.0) & x.simd_lt(edge) & y.simd_lt(edge);
        let (x, y) = (inside.select(x, zero), inside.select(y, zero));
        let (column, row) = (x.floor(), y.floor());
        let (right, down) = (x - column, y - row);
        let first = row.to_int::<i32x8<S>>() * self.side as i32 + column.to_int::<i32x8<S>>();
        let first = inside.select(first, i32x8::splat(simd, -1));
        let mut corner = [0; 8];
        first.store_slice(&mut corner);
        let mut heights = [[f32::NEG_INFINITY; 8]; 4];
        for lane in 0..8 {
            if let Ok(corner) = usize::try_from(corner[lane]) {
                let (here, below) = (&self.heights[corner..][..2], &self.heights[corner + self.side..][..2]);
                (heights[0][lane], heights[1][lane]) = (here[0], here[1]);
                (heights[2][lane], heights[3][lane]) = (below[0], below[1]);
            }
        }
        let mut open = [zero; 4];
        for (open, over) in open.iter_mut().zip(heights) {
            let over = f32x8::simd_from(simd, over) - height;
            *open = one - (over * SLOPE).max(0.0).min(1.0);
        }
        let (above, below) = (open[0] + (open[1] - open[0]) * right, open[2] + (open[3] - open[2]) * right);
        above + (below - above) * down
    }

    /// Like [`DepthMap::light`], with a tent filter of radius [`RADIUS`] texels, for one point.
    pub fn soft_light(&self, level: Level, p: Vec3, bias: f32) -> f32 {
        dispatch!(level, simd => self.soft_light_in_lanes(simd, p, bias))
    }

    #[inline(always)]
    fn soft_light_in_lanes<S: Simd>(&self, simd: S, p: Vec3, bias: f32) -> f32 {
        let Some((corner, share, height)) = self.window(p) else { return 1.0 };
        // A tent centered on the sample. Its weights change smoothly as `p` moves, and their sum is the
        // radius squared.
        let places = f32x8::simd_from(simd, [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
        let across = -((places - share.x).abs() * (1.0 / RADIUS as f32)) + 1.0;
        let mut down = [0.0; 2 * RADIUS];
        (-((places - share.y).abs() * (1.0 / RADIUS as f32)) + 1.0).store_slice(&mut down);
        let mut lit = f32x8::splat(simd, 0.0);
        for (y, weight) in down.into_iter().enumerate() {
            let row = &self.heights[corner + y * self.side..][..2 * RADIUS];
            let over = f32x8::from_slice(simd, row) - (height + bias);
            lit += (-(over * SLOPE).max(0.0).min(1.0) + 1.0) * weight;
        }
        (lit * across).reduce_sum() * (1.0 / (RADIUS * RADIUS) as f32)
    }

    /// Fraction of the key lamp's light that reaches a point `p` of a body with the unit normal `n`, 0 to 1:
    /// percentage-closer soft shadows (Fernando 2005). The width of the penumbra grows with the distance of the occluder,
    /// so the shadow of a chin on the chest is softer than that of a nose on the cheek.
    ///
    /// ```text
    ///      lamp  ═══
    ///            \ /         r = LAMP · d      d  mean height of the occluders above the surface [m]
    ///   occluder  X   ┐                        r  radius of the filter [m]
    ///            / \  │ d
    ///   ────────╱─p─╲─┘
    ///             ├─┤ r
    /// ```
    pub fn area_light(&self, level: Level, p: Vec3, n: Vec3, bias: f32) -> f32 {
        dispatch!(level, simd => self.area_light_in_lanes(simd, p, n, bias))
    }

    #[inline(always)]
    fn area_light_in_lanes<S: Simd>(&self, simd: S, p: Vec3, n: Vec3, bias: f32) -> f32 {
        if self.side == 0 {
            return 1.0;
        }
        let middle = self.texel(p) + Vec3::new(0.0, 0.0, bias);
        // The tangent plane of the surface rises toward the lamp by this, so that a surface does not shadow itself.
        let slope =
            Vec2::new(n.dot(self.right), n.dot(self.up)) / (-n.dot(self.toward).max(STEEPEST) * self.scale);
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let places = f32x8::simd_from(simd, PLACES);
        let weights = -(places.abs() * (1.0 / RADIUS as f32)) + 1.0;
        // Height above the surface of one row of taps, `spacing` texels apart. The plane is evaluated where the
        // height is: in the middle of a texel.
        let row = |y: f32, spacing: f32| {
            let (xs, y) =
                (PLACES.map(|x| (middle.x + x * spacing).floor()), (middle.y + y * spacing).floor());
            let across = f32x8::simd_from(simd, xs) + (0.5 - middle.x);
            let plane = across * slope.x + (middle.z + (y + 0.5 - middle.y) * slope.y);
            f32x8::simd_from(simd, self.row(xs, y)) - plane
        };
        let spacing = (WIDEST * self.scale / RADIUS as f32).max(1.0);
        let (mut sum, mut count) = (zero, zero);
        for y in PLACES {
            let over = row(y, spacing);
            let above = over.simd_gt(0.0);
            sum += above.select(over, zero);
            count += above.select(one, zero);
        }
        let count = count.reduce_sum();
        if count <= 0.0 {
            return 1.0;
        }
        let radius = (LAMP * sum.reduce_sum() / count).min(WIDEST);
        let spacing = (radius * self.scale / RADIUS as f32).max(1.0);
        let mut lit = zero;
        for y in PLACES {
            let over = row(y, spacing);
            let weight = 1.0 - y.abs() * (1.0 / RADIUS as f32);
            lit += (-(over * SLOPE).max(0.0).min(1.0) + 1.0) * weight;
        }
        (lit * weights).reduce_sum() * (1.0 / (RADIUS * RADIUS) as f32)
    }

    /// Heights of eight texels `xs` of row `y`; −∞ outside of the map.
    #[inline(always)]
    fn row(&self, xs: [f32; 8], y: f32) -> [f32; 8] {
        let side = self.side as f32;
        xs.map(|x| {
            let inside = x >= 0.0 && y >= 0.0 && x < side && y < side;
            if inside { self.heights[y as usize * self.side + x as usize] } else { f32::NEG_INFINITY }
        })
    }

    /// The square of 2 · [`RADIUS`] texels around `p`: its first texel, the position of `p` between the
    /// middle texels, and its height; `None` if the square extends over the map's edge.
    #[inline(always)]
    fn window(&self, p: Vec3) -> Option<(usize, Vec2, f32)> {
        let t = self.texel(p);
        let (margin, edge) = (RADIUS as f32 + 0.5, self.side as f32 - 1.0 - RADIUS as f32);
        if !(t.x > margin && t.y > margin && t.x < edge && t.y < edge) {
            return None;
        }
        let (x, y) = (t.x - 0.5, t.y - 0.5);
        let (column, row) = (x as usize, y as usize);
        let corner = (row + 1 - RADIUS) * self.side + column + 1 - RADIUS;
        Some((corner, Vec2::new(x - column as f32, y - row as f32), t.z))
    }
}

/// Rate at which light fades under an occluder [1/m]: over half a millimeter and not abruptly, which would
/// show stair steps on slopes.
pub(crate) const SLOPE: f32 = 2e3;

#[inline(always)]
fn dot<S: Simd>([x, y, z]: [f32x8<S>; 3], d: Vec3) -> f32x8<S> {
    x * d.x + y * d.y + z * d.z
}
