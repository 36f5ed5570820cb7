//! The bodies as the key lamp sees them: sharp shadow of a nose on a cheek, softened at the edge.

use crate::{
    body::raster::{BANDS, Bins, ScreenTriangle},
    frame::Frame,
};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Depth along the light's rays, as an orthographic picture. Nearer the lamp is greater.
#[derive(Debug, Default)]
pub(crate) struct DepthMap {
    side: usize,
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    /// Texels per metre, and the texel of the world's origin.
    scale: f32,
    origin: Vec2,
    /// Greatest height above the plane through the origin that faces the lamp [m]; −∞ where nothing is.
    heights: Vec<f32>,
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
        let points =
            || frame.bodies.iter().flat_map(|b| b.positions).filter(|p| p.is_finite()).map(|p| flat(*p));
        let (low, high) =
            points().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |b, p| (b.0.min(p), b.1.max(p)));
        let extent = (high - low).max_element();
        self.side = 0;
        if !(extent > 0.0 && extent.is_finite()) {
            return;
        }
        self.side = frame.quality.shadow_texels.clamp(64, 8192) as usize;
        self.scale = (self.side as f32 - 8.0) / extent;
        self.origin = Vec2::splat(4.0) - low * self.scale;
        for body in frame.bodies {
            for t in body.triangles {
                let p = t.map(|i| body.positions.get(i as usize).copied().unwrap_or(Vec3::NAN));
                let screen = p.map(|p| self.texel(p));
                self.triangles.extend(ScreenTriangle::new(screen, 0, self.side, self.side));
            }
        }
        self.bins.fill(&self.triangles, self.side);
        let side = self.side;
        self.heights.clear();
        self.heights.resize(side * side, f32::NEG_INFINITY);
        let (triangles, bins) = (&self.triangles, &self.bins);
        self.heights.par_chunks_mut(side * BANDS).enumerate().for_each(|(band, rows)| {
            for t in bins.band(band) {
                let height = rows.len() / side;
                triangles[*t as usize].cover(
                    [0, band * BANDS],
                    [side, height],
                    Vec2::splat(0.5),
                    |x, y, h| {
                        let at = &mut rows[y * side + x];
                        *at = at.max(h);
                    },
                );
            }
        });
    }

    /// Texel coordinates and height of a place.
    fn texel(&self, p: Vec3) -> Vec3 {
        let xy = Vec2::new(p.dot(self.right), p.dot(self.up)) * self.scale + self.origin;
        xy.extend(p.dot(self.toward))
    }

    /// Share of the key lamp's light that bodies let through to `p`, 0 to 1: percentage-closer filtering (Reeves et al. 1987) under a
    /// tent `radius` texels (1 or more) to each side. `bias` [m] keeps a surface from shading itself.
    #[inline(always)]
    pub fn light(&self, p: Vec3, bias: f32, radius: i32) -> f32 {
        let t = self.texel(p);
        let edge = self.side as f32 - 1.0 - radius as f32;
        let margin = radius as f32 + 0.5;
        if !(t.x > margin && t.y > margin && t.x < edge && t.y < edge) {
            return 1.0;
        }
        let (x, y) = (t.x - 0.5, t.y - 0.5);
        let (ix, iy) = (x as i32, y as i32);
        let (fx, fy) = (x - ix as f32, y - iy as f32);
        let inverse = 1.0 / radius as f32;
        let mut lit = 0.0;
        for j in 1 - radius..=radius {
            let wy = 1.0 - (j as f32 - fy).abs() * inverse;
            let row = &self.heights[(iy + j) as usize * self.side + (ix + 1 - radius) as usize..]
                [..2 * radius as usize];
            for (i, height) in (1 - radius..).zip(row) {
                // A tent over the sample's place: its weights change smoothly as `p` moves, and add up to the radius squared.
                let wx = 1.0 - (i as f32 - fx).abs() * inverse;
                // Over half a millimetre, not at once: no stair steps on slopes.
                let open = 1.0 - ((height - t.z - bias) * 2e3).clamp(0.0, 1.0);
                lit += wx * wy * open;
            }
        }
        lit * inverse * inverse
    }
}
