//! Shadow: how much of each lamp reaches a place.

mod density;
mod depth_map;
mod sweep;

use crate::{frame::Frame, hair::order::Order};
pub(crate) use density::bounds;
use density::{Density, Grid};
use depth_map::DepthMap;
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// Everything between the lamps and the hair, worked out once a frame.
#[derive(Debug, Default)]
pub(crate) struct Shadow {
    density: Density,
    depths: Vec<Vec<f32>>,
    /// Optical depth towards key, rim and fill, and the share of the sky that is seen.
    light: Vec<Vec4>,
    grid: Grid,
    map: DepthMap,
    /// Unit directions towards key, rim and fill.
    lamps: [Vec3; 3],
}

/// Directions over which the sky is averaged: up, and four slanting ones.
const SKY: [Vec3; 5] = [
    Vec3::Y,
    Vec3::new(0.8, 0.45, 0.3),
    Vec3::new(-0.8, 0.45, -0.3),
    Vec3::new(-0.3, 0.45, 0.8),
    Vec3::new(0.3, 0.45, -0.8),
];

impl Shadow {
    /// Works out the shadow of a frame whose hair lies in `bounds`; `None`: no hair.
    pub fn fill(&mut self, frame: &Frame, bounds: Option<(Vec3, Vec3)>, order: &Order) {
        self.map.fill(frame);
        self.light.clear();
        let Some(bounds) = bounds else { return };
        self.density.fill(frame, bounds, order);
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
        self.depths.resize_with(jobs.len(), Vec::new);
        self.depths.par_iter_mut().zip(jobs).for_each(|(depth, (from, direction))| {
            sweep::sweep(&grid, from, direction, depth);
        });
        let depths = &self.depths;
        self.light.resize(grid.len(), Vec4::ZERO);
        let slice = grid.size[0] * grid.size[1];
        self.light.par_chunks_mut(slice).enumerate().for_each(|(z, light)| {
            for (i, light) in light.iter_mut().enumerate() {
                let at = z * slice + i;
                // Ambient light comes around strands: a gentler law than the straight beam's.
                let open: f32 = depths[3..].iter().map(|d| 1.0 / (1.0 + 0.8 * d[at])).sum();
                *light = Vec4::new(depths[0][at], depths[1][at], depths[2][at], open / SKY.len() as f32);
            }
        });
    }

    /// Optical depth of hair and far bodies towards key, rim and fill, and the share of sky seen; trilinear.
    #[inline(always)]
    pub fn light(&self, p: Vec3) -> Vec4 {
        const CLEAR: Vec4 = Vec4::new(0.0, 0.0, 0.0, 1.0);
        let q = (p - self.grid.origin) / self.grid.voxel;
        let [nx, ny, nz] = self.grid.size;
        let last = Vec3::new(nx as f32 - 1.0, ny as f32 - 1.0, nz as f32 - 1.0);
        if self.light.is_empty() || !(q.cmpge(Vec3::ZERO).all() && q.cmplt(last).all()) {
            return CLEAR;
        }
        let (x, y, z) = (q.x as usize, q.y as usize, q.z as usize);
        let at = (z * ny + y) * nx + x;
        let (f, slice) = (q - Vec3::new(x as f32, y as f32, z as f32), nx * ny);
        let line = |i: usize| self.light[i].lerp(self.light[i + 1], f.x);
        let face = |i: usize| line(i).lerp(line(i + nx), f.y);
        face(at).lerp(face(at + slice), f.z)
    }

    /// As [`Shadow::light`], for places that may lie outside the hair's grid: there, hair between a place and a lamp is met where the
    /// way to the lamp enters the grid.
    pub fn around(&self, p: Vec3) -> Vec4 {
        if self.light.is_empty() {
            return self.light(p);
        }
        // The outermost voxels are padding, which the sweeps leave clear.
        let margin = Vec3::splat(2.0 * self.grid.voxel);
        let size = Vec3::from_array(self.grid.size.map(|n| (n - 1) as f32)) * self.grid.voxel;
        let (low, high) = (self.grid.origin + margin, self.grid.origin + size - margin);
        if p.cmpge(low).all() && p.cmple(high).all() {
            return self.light(p);
        }
        let mut found = Vec4::new(0.0, 0.0, 0.0, 1.0);
        for (k, toward) in self.lamps.iter().enumerate() {
            let (a, b) = ((low - p) / *toward, (high - p) / *toward);
            let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
            if enter >= 0.0 && enter < leave {
                found[k] = self.light((p + *toward * enter).clamp(low, high))[k];
            }
        }
        found
    }

    /// Share of the key lamp that bodies let through to `p`.
    #[inline(always)]
    pub fn body(&self, p: Vec3, bias: f32, radius: i32) -> f32 {
        self.map.light(p, bias, radius)
    }

    /// Side of a voxel of the hair's grid [m]; 0 without hair.
    pub fn voxel(&self) -> f32 {
        if self.light.is_empty() { 0.0 } else { self.grid.voxel }
    }
}
