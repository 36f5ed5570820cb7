//! Shadow: how much light of each lamp reaches a point.

pub(crate) mod contact;
pub(crate) mod density;
pub(crate) mod depth_map;
pub(crate) mod splat;
pub(crate) mod sweep;

use crate::{
    frame::Frame,
    hair::{
        order::Order,
        shade::{LANES, Row},
    },
};
use contact::Contact;
pub(crate) use density::bounds;
use density::{Cell, Density, Grid};
use depth_map::{DepthMap, RADIUS};
use fearless_simd::{Level, dispatch, f32x8, i32x8, prelude::*};
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use std::ops::{Add, Mul};

/// All occlusion between the lamps and the hair, computed once per frame.
#[derive(Debug, Default)]
pub(crate) struct Shadow {
    density: Density,
    depths: Vec<Vec<f32>>,
    /// Optical depth toward key, rim and fill, and the visible fraction of the sky.
    light: Vec<Vec4>,
    grid: Grid,
    map: DepthMap,
    contact: Contact,
    /// Unit directions toward key, rim and fill.
    lamps: [Vec3; 3],
}

/// Directions for averaging the sky: up and four slanted ones. None of them is mainly along x, because those
/// sweeps take longest.
pub(crate) const SKY: [Vec3; 5] = [
    Vec3::Y,
    Vec3::new(0.55, 0.45, 0.65),
    Vec3::new(-0.55, 0.45, 0.65),
    Vec3::new(0.55, 0.45, -0.65),
    Vec3::new(-0.55, 0.45, -0.65),
];

/// The value where nothing blocks the light.
const CLEAR: Vec4 = Vec4::new(0.0, 0.0, 0.0, 1.0);

/// The box of a frame's bodies [m]; `None` if there are none, or if one is larger than a building.
pub(crate) fn place(frame: &Frame) -> Option<(Vec3, Vec3)> {
    let points = frame.bodies.iter().flat_map(|b| b.positions).filter(|p| p.is_finite());
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let found = points.fold(none, |(low, high), p| (low.min(*p), high.max(*p)));
    (found.0.cmple(found.1).all() && (found.1 - found.0).max_element() < 1e4).then_some(found)
}

/// Width of the edge of the sharpest shadow [m]. `scale` is the resolution of the bodies' map in texels per
/// meter, and `voxel` is the side of a hair voxel [m]; either is 0 if there are none.
pub(crate) fn softness(scale: f32, voxel: f32) -> f32 {
    let bodies = if scale > 0.0 { RADIUS as f32 / scale } else { f32::INFINITY };
    let hair = if voxel > 0.0 { voxel } else { f32::INFINITY };
    bodies.min(hair).min(1e9)
}

/// Number of swept depths that belong to lamps; those of [`SKY`] follow.
const LAMPS: usize = 3;

/// Depth under the surface of bodies up to which hair is not in their shadow [m]: roots are inside the skin.
pub(crate) const HAIR_BIAS: f32 = 3e-3;
/// The corresponding depth for bodies, whose map is not exact.
pub(crate) const SKIN_BIAS: f32 = 8e-4;

/// Attenuation of sky light (see [`sky_open`]).
pub(crate) const SKY_LAW: f32 = 0.8;

/// Fraction of the light from one part of the sky that passes an optical depth. The light comes around
/// strands, so it is attenuated less than a direct beam.
fn sky_open(depth: f32) -> f32 {
    1.0 / (1.0 + SKY_LAW * depth)
}

/// Interpolates the values of a cell's eight corners.
#[inline(always)]
fn trilinear<T>(cell: Cell, value: impl Fn(usize) -> T) -> T
where
    T: Copy + Add<Output = T> + Mul<f32, Output = T>,
{
    let mix = |a: T, b: T, f: f32| a * (1.0 - f) + b * f;
    let line = |at: usize| mix(value(at), value(at + 1), cell.share.x);
    let face = |at: usize| mix(line(at), line(at + cell.strides[0]), cell.share.y);
    mix(face(cell.first), face(cell.first + cell.strides[1]), cell.share.z)
}

fn holds((low, high): (Vec3, Vec3), p: Vec3) -> bool {
    p.cmpge(low).all() && p.cmple(high).all()
}

/// The point where a ray enters a box; `None` if it does not.
fn entry((low, high): (Vec3, Vec3), p: Vec3, toward: Vec3) -> Option<Vec3> {
    let (a, b) = ((low - p) / toward, (high - p) / toward);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter >= 0.0 && enter < leave).then(|| (p + toward * enter).clamp(low, high))
}

impl Shadow {
    /// Computes the shadow of a frame whose hair is inside `bounds`; `None` if there is no hair.
    pub fn fill(&mut self, frame: &Frame, bounds: Option<(Vec3, Vec3)>, order: &Order) {
        self.light.clear();
        let (map, contact, density) = (&mut self.map, &mut self.contact, &mut self.density);
        let mut bodies = || {
            rayon::join(|| map.fill(frame), || contact.fill(frame));
        };
        let Some(bounds) = bounds else { return bodies() };
        rayon::join(|| density.fill(frame, bounds, order), bodies);
        let density = &self.density;
        let grid = density.grid;
        self.grid = grid;
        let lamps = &frame.lighting;
        self.lamps = [lamps.key, lamps.rim, lamps.fill].map(|l| l.direction.normalize_or(Vec3::Y));
        let sweeps = [
            (&density.hair, lamps.key.direction),
            (&density.all, lamps.rim.direction),
            (&density.all, lamps.fill.direction),
        ];
        let sky = SKY.map(|d| (&density.all, d));
        let jobs: Vec<_> = sweeps.into_iter().chain(sky).collect();
        let level = Level::new();
        self.depths.resize_with(jobs.len(), Vec::new);
        self.depths.par_iter_mut().zip(jobs).for_each(|(depth, (from, direction))| {
            dispatch!(level, simd => sweep::sweep(simd, &grid, from, direction, depth));
        });
        let depths = &self.depths;
        self.light.resize(grid.len(), Vec4::ZERO);
        let slice = grid.size[0] * grid.size[1];
        self.light.par_chunks_mut(slice).enumerate().for_each(|(z, light)| {
            for (i, light) in light.iter_mut().enumerate() {
                let at = z * slice + i;
                let open: f32 = depths[LAMPS..].iter().map(|d| sky_open(d[at])).sum();
                *light = Vec4::new(depths[0][at], depths[1][at], depths[2][at], open / SKY.len() as f32);
            }
        });
    }

    /// Computes only the sharp shadow of bodies; the hair shadow is not changed.
    pub fn fill_bodies(&mut self, frame: &Frame) {
        self.map.fill(frame);
    }

    /// Whether there is no hair shadow.
    pub fn is_empty(&self) -> bool {
        self.light.is_empty()
    }

    /// Optical depth of hair and far bodies toward key, rim and fill, and the visible fraction of the sky;
    /// trilinear.
    #[inline(always)]
    pub fn light(&self, p: Vec3) -> Vec4 {
        match self.grid.cell(p) {
            Some(cell) if !self.light.is_empty() => trilinear(cell, |at| self.light[at]),
            _ => CLEAR,
        }
    }

    /// Like [`Shadow::light`], but for points that may be outside the hair's grid. For these, the value for
    /// each lamp and each part of the sky is taken where the ray toward it enters the grid. Shadows are
    /// therefore continuous where a surface leaves the grid.
    pub fn around(&self, p: Vec3) -> Vec4 {
        if self.light.is_empty() {
            return self.light(p);
        }
        let within = self.within();
        if holds(within, p) {
            return self.light(p);
        }
        let mut found = Vec4::ZERO;
        for (k, toward) in self.lamps.iter().enumerate() {
            found[k] = entry(within, p, *toward).map_or(0.0, |q| self.light(q)[k]);
        }
        for (toward, depth) in SKY.into_iter().zip(&self.depths[LAMPS..]) {
            let open = entry(within, p, toward)
                .and_then(|q| self.grid.cell(q))
                .map_or(1.0, |cell| trilinear(cell, |at| sky_open(depth[at])));
            found.w += open / SKY.len() as f32;
        }
        found
    }

    /// The depth toward the key lamp of [`Shadow::around`].
    pub fn key_around(&self, p: Vec3) -> f32 {
        if self.light.is_empty() {
            return 0.0;
        }
        let within = self.within();
        let place = if holds(within, p) { Some(p) } else { entry(within, p, self.lamps[0]) };
        place.map_or(0.0, |q| self.light(q).x)
    }

    /// The grid's box without the outermost voxels, which are padding that the sweeps leave clear.
    fn within(&self) -> (Vec3, Vec3) {
        let margin = Vec3::splat(2.0 * self.grid.voxel);
        let size = Vec3::from_array(self.grid.size.map(|n| (n - 1) as f32)) * self.grid.voxel;
        (self.grid.origin + margin, self.grid.origin + size - margin)
    }

    /// For eight points of hair: [`Shadow::light`], and the fraction of the key lamp's light that bodies let
    /// through. Must be called inside a `dispatch!`.
    #[inline(always)]
    pub fn on_hair<S: Simd>(&self, simd: S, p: &[Row; 3], light: &mut [Row; 4], body: &mut Row) {
        let p = [f32x8::simd_from(simd, p[0]), f32x8::simd_from(simd, p[1]), f32x8::simd_from(simd, p[2])];
        self.map.light(simd, p, HAIR_BIAS).store_slice(body);
        // As in `Grid::cell`.
        let (grid, zero) = (&self.grid, f32x8::splat(simd, 0.0));
        let per_voxel = 1.0 / grid.voxel;
        let origin = grid.origin.to_array();
        let mut inside = zero.simd_ge(0.0);
        let (mut first, mut shares) = (i32x8::splat(simd, 0), [[0.0; LANES]; 3]);
        for axis in [2, 1, 0] {
            let q = (p[axis] - origin[axis]) * per_voxel;
            inside &= q.simd_ge(0.0) & q.simd_lt(grid.size[axis] as f32 - 1.0);
            let whole = inside.select(q, zero).floor();
            (q - whole).store_slice(&mut shares[axis]);
            first = first * grid.size[axis] as i32 + whole.to_int::<i32x8<S>>();
        }
        let first = inside.select(first, i32x8::splat(simd, -1));
        let (mut at, strides) = ([0; LANES], [grid.size[0], grid.size[0] * grid.size[1]]);
        first.store_slice(&mut at);
        for lane in 0..LANES {
            let share = Vec3::new(shares[0][lane], shares[1][lane], shares[2][lane]);
            let found = match usize::try_from(at[lane]) {
                Ok(first) if !self.light.is_empty() => {
                    trilinear(Cell { first, strides, share }, |at| self.light[at])
                }
                _ => CLEAR,
            };
            for (row, value) in light.iter_mut().zip(found.to_array()) {
                row[lane] = value;
            }
        }
    }

    /// Fraction of the key lamp's light that bodies let through to a point of the ground.
    pub fn on_ground(&self, level: Level, p: Vec3) -> f32 {
        self.map.soft_light(level, p, SKIN_BIAS)
    }

    /// Fraction of the key lamp's light that bodies let through to a point on their surface with the unit normal `n`.
    pub fn on_skin(&self, level: Level, p: Vec3, n: Vec3) -> f32 {
        self.map.area_light(level, p, n, SKIN_BIAS)
    }

    /// Width of the edge of the sharpest shadow [m]; infinite if there is no shadow.
    pub fn softness(&self) -> f32 {
        softness(self.map.scale(), self.voxel())
    }

    /// The sky visibility of the ground near bodies.
    pub fn contact(&self) -> &Contact {
        &self.contact
    }

    /// Side of a voxel of the hair's grid [m]; 0 without hair.
    pub fn voxel(&self) -> f32 {
        if self.light.is_empty() { 0.0 } else { self.grid.voxel }
    }
}
