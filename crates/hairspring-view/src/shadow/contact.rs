//! Fraction of the sky that is visible from the ground near bodies.
//!
//! Seen from straight below, bodies are a height map. A patch of area A at height h covers A h² / (π (h² +
//! d²)²) of the sky for a point at horizontal distance d. This is the form factor of two level patches; all
//! of them add up to 1 in the plane. The implementation replaces it by a bump of the same volume with a
//! finite radius in proportion to h, so that a low patch is cheap to compute. Surfaces higher than a seventh
//! of the bodies' size are ignored, so that few patches remain. The CPU computes this for both renderers.

use crate::{
    body::{corners, raster::ScreenTriangle},
    frame::Frame,
    shadow::place,
};
use glam::{Vec2, Vec3, Vec3Swizzles};
use std::f32::consts::PI;

/// Height above the ground up to which surfaces count, relative to the longest edge of the bodies' box.
const REACH: f32 = 0.15;
/// Approximate number of texels in that height.
const FINE: f32 = 12.0;
/// Radius of influence of a patch at the height of the ground, relative to the maximum height. The sides of a
/// foot, which a view from below does not show, block about as much light.
const LEAST: f32 = 0.5;
/// Growth of the radius of influence with the height of a patch.
const WIDER: f32 = 2.0;
/// Maximum number of texels per side.
const MOST: usize = 1024;

/// The map of sky visibility.
#[derive(Debug, Default)]
pub(crate) struct Contact {
    /// Corner of the first texel, X and Z [m].
    pub low: Vec2,
    /// Side of a texel [m].
    pub texel: f32,
    /// Number of texels along X and along Z; 0 if nothing is near the ground.
    pub size: [usize; 2],
    /// Fraction of the sky that is visible from the center of each texel. X is the fastest index.
    pub sky: Vec<f32>,
    /// Height of the lowest surface above each texel [m].
    lowest: Vec<f32>,
}

impl Contact {
    /// Computes the map for a frame's bodies and ground.
    pub fn fill(&mut self, frame: &Frame) {
        self.size = [0; 2];
        self.sky.clear();
        let Some((height, bodies)) = frame.ground_seen().map(|g| g.height).zip(place(frame)) else { return };
        let reach = REACH * (bodies.1 - bodies.0).max_element();
        let near = || {
            let all = frame.bodies.iter().flat_map(|b| b.triangles.iter().map(|t| corners(b.positions, t)));
            all.flatten().filter(|t| t.iter().any(|p| p.y < height + reach))
        };
        let none = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (low, high) = near().flatten().fold(none, |(low, high), p| (low.min(p.xz()), high.max(p.xz())));
        if !(reach > 0.0 && low.is_finite() && high.is_finite()) {
            return;
        }
        // As in `Grid::around`: quantized sizes and a fixed lattice, so that moving bodies are sampled the
        // same way in each frame.
        self.texel = ((reach / FINE).log2() * 4.0).ceil().mul_add(0.25, 0.0).exp2();
        let margin = ((LEAST + WIDER) * reach / self.texel).ceil() + 2.0;
        let first = (low / self.texel).floor() - Vec2::splat(margin);
        let size = (high / self.texel).ceil() + Vec2::splat(margin) - first;
        self.low = first * self.texel;
        self.size = size.to_array().map(|n| (n as usize).min(MOST));
        let [w, h] = self.size;
        self.lowest.clear();
        self.lowest.resize(w * h, f32::INFINITY);
        for t in near() {
            let flat = t.map(|p| ((p.xz() - self.low) / self.texel).extend(height - p.y));
            let Some(triangle) = ScreenTriangle::new(flat, 0, w, h) else { continue };
            triangle.cover([0, 0], [w, h], |x, y, under| {
                let lowest = &mut self.lowest[y * w + x];
                *lowest = lowest.min(-under);
            });
        }
        self.sky.resize(w * h, 1.0);
        for at in 0..w * h {
            let over = self.lowest[at].max(0.0);
            if over < reach {
                // Fades smoothly to zero at the maximum height.
                let share = (1.0 - over / reach).powi(2);
                self.hide([at % w, at / w], (LEAST * reach + WIDER * over) / self.texel, share);
            }
        }
        self.sky.iter_mut().for_each(|sky| *sky = sky.max(0.0));
    }

    /// Subtracts a bump with a volume of `share` texels and the given radius from the sky around a texel.
    fn hide(&mut self, [x, y]: [usize; 2], radius: f32, share: f32) {
        let [w, h] = self.size;
        let n = radius as usize;
        let (top, per) = (share * 3.0 / (PI * radius * radius), 1.0 / (radius * radius));
        let columns = x.saturating_sub(n)..(x + n + 1).min(w);
        for row in y.saturating_sub(n)..(y + n + 1).min(h) {
            let down = (row.abs_diff(y) as f32).powi(2);
            for column in columns.clone() {
                let left = (1.0 - ((column.abs_diff(x) as f32).powi(2) + down) * per).max(0.0);
                self.sky[row * w + column] -= top * left * left;
            }
        }
    }

    /// Fraction of the sky that is visible from a point of the ground, interpolated between texel centers.
    pub fn open(&self, p: Vec3) -> f32 {
        let [w, h] = self.size;
        let at = (p.xz() - self.low) / self.texel - Vec2::splat(0.5);
        // Comparisons with NaN are false, and a map of size 0 contains no point.
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < w as f32 - 1.0 && at.y < h as f32 - 1.0) {
            return 1.0;
        }
        let (first, share) = (at.floor(), at.fract());
        let row = &self.sky[first.y as usize * w + first.x as usize..];
        let mix = |a: f32, b: f32, f: f32| a + (b - a) * f;
        mix(mix(row[0], row[1], share.x), mix(row[w], row[w + 1], share.x), share.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frame::{MeshDraw, Quality},
        ground::Ground,
        lighting::{Background, Lighting},
    };
    use hairspring_scene::Camera;

    /// Sky visibility at points of the ground under and next to a plate of 2 m at a height [m].
    fn under(height: f32, places: [f32; 3]) -> [f32; 3] {
        let corner = |x: f32, z: f32| Vec3::new(x, height, z);
        let positions = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let bodies = [MeshDraw { positions: &positions, normals: &[], triangles: &triangles, parts: &[] }];
        let mut contact = Contact::default();
        contact.fill(&Frame {
            hair: &[],
            bodies: &bodies,
            camera: Camera { position: Vec3::ONE, ..Camera::default() },
            lighting: Lighting::default(),
            background: Background::default(),
            ground: Some(Ground { height: 0.0, color: None }),
            quality: Quality::default(),
        });
        places.map(|x| contact.open(Vec3::new(x, 0.0, 0.1)))
    }

    #[test]
    fn a_plate_occludes_the_sky_under_it_and_half_of_it_at_its_edge() {
        let reach = REACH * 2.0;
        let close = |found: [f32; 3], right: [f32; 3]| {
            assert!(found.iter().zip(right).all(|(a, b)| (a - b).abs() < 0.03), "{found:?} for {right:?}");
        };
        close(under(0.0, [0.0, 1.0, 1.01 + LEAST * reach]), [0.0, 0.5, 1.0]);
        // Below the ground as on it.
        close(under(-0.5, [0.0, 1.0, 1.01 + LEAST * reach]), [0.0, 0.5, 1.0]);
        // At half the height, a quarter counts, over a larger radius.
        close(under(0.5 * reach, [0.0, 1.0, 1.0 + 0.5 * LEAST * reach]), [0.75, 0.875, 0.916]);
        close(under(reach, [0.0, 1.0, 1.1]), [1.0; 3]);
    }
}
