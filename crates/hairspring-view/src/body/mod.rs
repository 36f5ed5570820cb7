//! Bodies: which surface each pixel sees, and its colour.

pub(crate) mod raster;
mod skin;

use crate::{
    camera::{NEAR, View},
    frame::{Frame, MeshDraw},
    shadow::Shadow,
    tile::{PIXELS, SIDE},
};
use glam::{Vec2, Vec3};
use raster::{Bins, ScreenTriangle};

/// Samples of a pixel for the outlines of bodies: one in each of eight rows and columns.
const SAMPLES: [Vec2; 8] = [
    Vec2::new(0.5625, 0.3125),
    Vec2::new(0.4375, 0.6875),
    Vec2::new(0.8125, 0.5625),
    Vec2::new(0.3125, 0.1875),
    Vec2::new(0.1875, 0.8125),
    Vec2::new(0.0625, 0.4375),
    Vec2::new(0.6875, 0.9375),
    Vec2::new(0.9375, 0.0625),
];

/// What a pixel sees of the bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Share of the pixel that bodies fill, 0 to 1.
    pub cover: f32,
    /// Distance along the camera's axis [m].
    pub depth: f32,
}

/// The frame's triangles on the screen, kept between frames for their memory.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    screen: Vec<ScreenTriangle>,
    bins: Bins,
    /// First triangle number of each body.
    first: Vec<u32>,
}

/// Buffers of one tile.
pub(crate) struct Samples {
    nearness: [[f32; SAMPLES.len()]; PIXELS],
    triangle: [[u32; SAMPLES.len()]; PIXELS],
}

/// No triangle.
const NONE: u32 = u32::MAX;

impl Default for Samples {
    fn default() -> Self {
        Self { nearness: [[0.0; 8]; PIXELS], triangle: [[NONE; 8]; PIXELS] }
    }
}

impl Bodies {
    /// Projects the frame's triangles.
    pub fn project(&mut self, frame: &Frame, view: &View, width: usize, height: usize) {
        self.screen.clear();
        self.first.clear();
        let mut count = 0u32;
        for body in frame.bodies {
            self.first.push(count);
            for (i, t) in body.triangles.iter().enumerate() {
                let Some(corner) = corners(body, t) else {
                    continue;
                };
                let screen = |p: Vec3| {
                    let p = view.project(p);
                    p.with_z(1.0 / p.z)
                };
                // Cut at the near plane: a fan of up to two triangles.
                let (polygon, n) = clip(corner, |p| (p - view.eye).dot(view.forward) - NEAR);
                for k in 2..n {
                    let fan = [polygon[0], polygon[k - 1], polygon[k]].map(screen);
                    self.screen.extend(ScreenTriangle::new(fan, count + i as u32, width, height));
                }
            }
            count = count.saturating_add(body.triangles.len() as u32);
        }
        self.bins.fill(&self.screen, height);
    }

    /// Draws the tile whose corner is at `corner` into `out`; false where no body is.
    pub fn draw(&self, corner: [usize; 2], samples: &mut Samples, out: &mut [Surface; PIXELS]) -> bool {
        let columns = [corner[0] as u32, (corner[0] + SIDE) as u32];
        let here = |t: &&ScreenTriangle| t.columns[0] < columns[1] && t.columns[1] > columns[0];
        let triangles = self.bins.band(corner[1] / SIDE).iter().map(|t| &self.screen[*t as usize]);
        let mut any = false;
        for t in triangles.filter(here) {
            if !any {
                *samples = Samples::default();
                any = true;
            }
            for (s, offset) in SAMPLES.iter().enumerate() {
                t.cover(corner, [SIDE, SIDE], *offset, |x, y, nearness| {
                    let pixel = y * SIDE + x;
                    if nearness > samples.nearness[pixel][s] {
                        samples.nearness[pixel][s] = nearness;
                        samples.triangle[pixel][s] = t.source;
                    }
                });
            }
        }
        if !any {
            return false;
        }
        for (out, nearness) in out.iter_mut().zip(&samples.nearness) {
            // A sample without a body has nearness 0.
            let n = nearness.iter().filter(|near| **near > 0.0).count() as f32;
            let depth = if n > 0.0 { n / nearness.iter().sum::<f32>() } else { f32::INFINITY };
            *out = Surface { cover: n / SAMPLES.len() as f32, depth };
        }
        true
    }

    /// Linear RGB of the bodies in a pixel of the tile drawn last: each triangle seen in it is lit once and weighed by its samples.
    pub fn light(
        &self,
        frame: &Frame,
        view: &View,
        shadow: &Shadow,
        corner: [usize; 2],
        samples: &Samples,
        pixel: usize,
    ) -> Vec3 {
        let at = Vec2::new((corner[0] + pixel % SIDE) as f32 + 0.5, (corner[1] + pixel / SIDE) as f32 + 0.5);
        let seen = &samples.triangle[pixel];
        let (mut color, mut covered) = (Vec3::ZERO, 0.0);
        for (s, t) in seen.iter().enumerate() {
            if *t == NONE {
                continue;
            }
            covered += 1.0;
            if seen[..s].contains(t) {
                continue;
            }
            let weight = seen[s..].iter().filter(|other| *other == t).count() as f32;
            let b = self.first.partition_point(|first| first <= t) - 1;
            color +=
                weight * skin::light(frame, &frame.bodies[b], (t - self.first[b]) as usize, view, shadow, at);
        }
        color / f32::max(covered, 1.0)
    }
}

/// Corners of a triangle; `None` if an index is past the end or a corner is not finite.
fn corners(body: &MeshDraw, t: &[u32; 3]) -> Option<[Vec3; 3]> {
    let at = |i: u32| body.positions.get(i as usize).copied().filter(|p| p.is_finite());
    Some([at(t[0])?, at(t[1])?, at(t[2])?])
}

/// The part of a triangle where `side` is above 0, as a polygon (Sutherland & Hodgman 1974), and its corner count.
fn clip(corner: [Vec3; 3], side: impl Fn(Vec3) -> f32) -> ([Vec3; 4], usize) {
    let mut out = [Vec3::ZERO; 4];
    let mut n = 0;
    let mut push = |p| {
        out[n] = p;
        n += 1;
    };
    for i in 0..3 {
        let (a, b) = (corner[i], corner[(i + 1) % 3]);
        let (da, db) = (side(a), side(b));
        if da > 0.0 {
            push(a);
        }
        if (da > 0.0) != (db > 0.0) {
            push(a.lerp(b, da / (da - db)));
        }
    }
    (out, n)
}
