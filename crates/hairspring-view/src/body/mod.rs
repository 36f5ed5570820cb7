//! Bodies: the visible surface at each pixel, and its color.

pub(crate) mod raster;
pub(crate) mod skin;

use crate::{
    camera::{NEAR, View},
    frame::{Frame, MeshDraw},
    shadow::Shadow,
    tile::{PIXELS, SIDE},
};
use fearless_simd::{Level, dispatch, f32x8, prelude::*, u32x8};
use glam::{Vec2, Vec3};
use raster::{Bins, ScreenTriangle};
use rayon::prelude::*;

/// Sample positions in a pixel, for the outlines of bodies and for sharp shadows: one in each of eight
/// columns and rows. Shape `[axis][sample]`.
pub(crate) const SAMPLES: [[f32; 8]; 2] = [
    [0.5625, 0.4375, 0.8125, 0.3125, 0.1875, 0.0625, 0.6875, 0.9375],
    [0.3125, 0.6875, 0.5625, 0.1875, 0.8125, 0.4375, 0.9375, 0.0625],
];

/// The bodies as seen by a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Fraction of the pixel that bodies cover, 0 to 1.
    pub cover: f32,
    /// Distance along the camera's axis [m].
    pub depth: f32,
}

/// What the lighting of bodies depends on.
#[derive(Clone, Copy)]
pub(crate) struct Lit<'a> {
    pub frame: &'a Frame<'a>,
    pub view: &'a View,
    pub shadow: &'a Shadow,
    pub level: Level,
}

/// The frame's triangles on the screen. The memory is kept between frames.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    /// Vertices of one body in screen space: pixels and depth.
    vertices: Vec<Vec3>,
    screen: Vec<ScreenTriangle>,
    bins: Bins,
    /// Index of the first triangle of each body.
    first: Vec<u32>,
}

/// Buffers of one tile.
pub(crate) struct Samples {
    nearness: [[f32; 8]; PIXELS],
    triangle: [[u32; 8]; PIXELS],
}

/// Marks a sample without a triangle.
const NONE: u32 = u32::MAX;

impl Default for Samples {
    fn default() -> Self {
        Self { nearness: [[0.0; 8]; PIXELS], triangle: [[NONE; 8]; PIXELS] }
    }
}

impl Bodies {
    /// Projects the frame's triangles. Parts below the height `low` [m] are cut off.
    pub fn project(&mut self, frame: &Frame, view: &View, [width, height]: [usize; 2], low: f32) {
        self.screen.clear();
        self.first.clear();
        let mut count = 0u32;
        for body in frame.bodies {
            self.first.push(count);
            body.positions.par_iter().map(|p| view.project(*p)).collect_into_vec(&mut self.vertices);
            let vertices = &self.vertices;
            let near = |p: Vec3| p.with_z(1.0 / p.z);
            let above = |t: &[u32; 3]| t.iter().all(|i| body.positions[*i as usize].y >= low);
            let triangles = body.triangles.par_iter().enumerate().with_min_len(4096);
            self.screen.par_extend(triangles.flat_map_iter(|(i, t)| {
                let source = count + i as u32;
                let fan = match corners(vertices, t) {
                    Some(c) if c.iter().all(|p| p.z > NEAR) && above(t) => [Some(c.map(near)), None, None],
                    _ => cut(body, t, view, low).map(|fan| fan.map(|c| c.map(near))),
                };
                fan.into_iter().flatten().filter_map(move |c| ScreenTriangle::new(c, source, width, height))
            }));
            count = count.saturating_add(body.triangles.len() as u32);
        }
        self.bins.fill(&self.screen, [width, height], [SIDE; 2]);
    }

    /// Draws a tile with its corner at `corner` into `out`. Returns false if no body is visible in it.
    pub fn draw(
        &self,
        level: Level,
        tile: usize,
        corner: [usize; 2],
        samples: &mut Samples,
        out: &mut [Surface; PIXELS],
    ) -> bool {
        let here = self.bins.cell(tile);
        if !here.is_empty() {
            *samples = Samples::default();
            dispatch!(level, simd => self.draw_in_lanes(simd, here, corner, samples, out));
        }
        !here.is_empty()
    }

    #[inline(always)]
    fn draw_in_lanes<S: Simd>(
        &self,
        simd: S,
        here: &[u32],
        corner: [usize; 2],
        samples: &mut Samples,
        out: &mut [Surface; PIXELS],
    ) {
        let offset = [f32x8::simd_from(simd, SAMPLES[0]), f32x8::simd_from(simd, SAMPLES[1])];
        for t in here.iter().map(|t| &self.screen[*t as usize]) {
            let source = u32x8::splat(simd, t.source);
            t.cover_samples(offset, corner, [SIDE, SIDE], |x, y, inside, nearness| {
                let pixel = y * SIDE + x;
                let before = f32x8::simd_from(simd, samples.nearness[pixel]);
                let nearer = inside & nearness.simd_gt(before);
                nearer.select(nearness, before).store_slice(&mut samples.nearness[pixel]);
                let before = u32x8::simd_from(simd, samples.triangle[pixel]);
                nearer.select(source, before).store_slice(&mut samples.triangle[pixel]);
            });
        }
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        for (out, nearness) in out.iter_mut().zip(&samples.nearness) {
            // A sample without a body has nearness 0.
            let nearness = f32x8::simd_from(simd, *nearness);
            let n = nearness.simd_gt(0.0).select(one, zero).reduce_sum();
            let depth = if n > 0.0 { n / nearness.reduce_sum() } else { f32::INFINITY };
            *out = Surface { cover: n * 0.125, depth };
        }
    }

    /// The mean of a value over the bodies in a pixel of the last drawn tile. `value` is called once for each
    /// surface in the pixel, with the body's index, the body, the triangle and the pixel's position, and
    /// weighted by its number of samples.
    pub fn average(
        &self,
        lit: &Lit,
        corner: [usize; 2],
        samples: &Samples,
        pixel: usize,
        value: impl Fn(usize, &MeshDraw, usize, Vec2) -> Vec3,
    ) -> Vec3 {
        let at = Vec2::new((corner[0] + pixel % SIDE) as f32 + 0.5, (corner[1] + pixel / SIDE) as f32 + 0.5);
        let mut left = samples.triangle[pixel];
        let (mut sum, mut covered) = (Vec3::ZERO, 0.0);
        for s in 0..left.len() {
            let number = left[s];
            if number == NONE {
                continue;
            }
            let b = self.first.partition_point(|first| *first <= number) - 1;
            let (body, t) = (&lit.frame.bodies[b], (number - self.first[b]) as usize);
            let mut weight = 0.0;
            for other in &mut left[s..] {
                if *other != NONE && (*other == number || neighbours(body, t, *other - self.first[b])) {
                    *other = NONE;
                    weight += 1.0;
                }
            }
            covered += weight;
            sum += weight * value(b, body, t, at);
        }
        sum / f32::max(covered, 1.0)
    }
}

/// Whether triangles `t` and `other` of `body` belong to one smooth surface, so that the light on one can be
/// used for the other: they share a corner, their color and smooth normals.
fn neighbours(body: &MeshDraw, t: usize, other: u32) -> bool {
    let Some(far) = body.triangles.get(other as usize).filter(|_| body.smooth()) else { return false };
    let near = &body.triangles[t];
    near.iter().any(|corner| far.contains(corner)) && skin::part(body, t) == skin::part(body, other as usize)
}

/// Corners of a triangle; `None` if an index is past the end or a corner is not finite.
pub(crate) fn corners(vertices: &[Vec3], t: &[u32; 3]) -> Option<[Vec3; 3]> {
    let at = |i: u32| vertices.get(i as usize).copied().filter(|p| p.is_finite());
    Some([at(t[0])?, at(t[1])?, at(t[2])?])
}

/// Clips a triangle at the near plane and at a height. Returns a fan of up to three triangles in pixels and
/// depth.
fn cut(body: &MeshDraw, t: &[u32; 3], view: &View, low: f32) -> [Option<[Vec3; 3]>; 3] {
    let Some(corner) = corners(body.positions, t) else { return [None; 3] };
    let (above, n) = clip(&corner, |p| p.y - low);
    let (polygon, n) = clip(&above[..n], |p| (p - view.eye).dot(view.forward) - NEAR);
    [3, 4, 5].map(|k| (k <= n).then(|| [0, k - 2, k - 1].map(|i| view.project(polygon[i]))))
}

/// Clips a triangle, or a triangle that was clipped once, to the side where `side` is above 0 (Sutherland &
/// Hodgman 1974). Returns the polygon and its number of corners.
fn clip(corner: &[Vec3], side: impl Fn(Vec3) -> f32) -> ([Vec3; 5], usize) {
    let mut out = [Vec3::ZERO; 5];
    let mut n = 0;
    let mut push = |p| {
        out[n] = p;
        n += 1;
    };
    for i in 0..corner.len() {
        let (a, b) = (corner[i], corner[(i + 1) % corner.len()]);
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
