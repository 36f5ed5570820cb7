//! The density of hair: a grid of optical density, filled again in each frame.
//!
//! A voxel's density is the fraction of light that a beam along the grid loses in it, for small densities:
//! length × diameter of the strands in it over the area of its face. Sums are fixed-point integers, so that
//! the result is bit-identical for any distribution over threads.

use super::splat::{self, UNIT};
use crate::{
    body::corners,
    frame::{Frame, MeshDraw},
    hair::order::Order,
};
use fearless_simd::{Level, dispatch};
use glam::Vec3;
use rayon::prelude::*;

/// Position and size of a grid. The center of voxel (0, 0, 0) is at `origin`; x is the fastest index.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Grid {
    pub origin: Vec3,
    /// Side of a voxel [m].
    pub voxel: f32,
    pub size: [usize; 3],
}

/// A position between eight voxels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// Index of the voxel with the lowest coordinates.
    pub first: usize,
    /// Steps in memory to the next voxel along y and along z.
    pub strides: [usize; 2],
    /// Relative position between them, 0 to 1 along each axis.
    pub share: Vec3,
}

/// Voxels of padding around the hair, for the blur and for lookups.
const PAD: usize = 4;
/// Optical depth of a closed body's wall, which is opaque.
pub(crate) const WALL: f32 = 8.0;

impl Grid {
    pub fn len(&self) -> usize {
        self.size.iter().product()
    }

    /// Creates a grid around the hair. Its voxels are snapped to a fixed lattice, so that small motion does
    /// not shift them.
    pub fn around(bounds: (Vec3, Vec3), voxels: u32) -> Self {
        let extent = (bounds.1 - bounds.0).max_element().max(1e-4);
        let inner = voxels.clamp(16, 256) as f32;
        // Voxel sizes are quantized to steps of 2^(1/4), so that swinging hair keeps its voxel size for a
        // whole shot.
        let voxel = ((extent / inner).log2() * 4.0).ceil().mul_add(0.25, 0.0).exp2();
        let first = (bounds.0 / voxel).floor() - Vec3::splat(PAD as f32);
        let last = (bounds.1 / voxel).ceil() + Vec3::splat(PAD as f32);
        let size = (last - first).to_array().map(|n| n as usize + 1);
        Self { origin: first * voxel, voxel, size }
    }

    /// The cell between eight voxel centers that contains `p`; `None` outside.
    #[inline(always)]
    pub fn cell(&self, p: Vec3) -> Option<Cell> {
        let q = (p - self.origin) / self.voxel;
        let [nx, ny, nz] = self.size;
        let last = Vec3::new(nx as f32 - 1.0, ny as f32 - 1.0, nz as f32 - 1.0);
        if !(q.cmpge(Vec3::ZERO).all() && q.cmplt(last).all()) {
            return None;
        }
        let (x, y, z) = (q.x as usize, q.y as usize, q.z as usize);
        let share = q - Vec3::new(x as f32, y as f32, z as f32);
        Some(Cell { first: (z * ny + y) * nx + x, strides: [nx, nx * ny], share })
    }

    /// The nearest voxel; `None` outside.
    fn nearest(&self, p: Vec3) -> Option<usize> {
        let q = (p - self.origin) / self.voxel + Vec3::splat(0.5);
        let [x, y, z] = [q.x as usize, q.y as usize, q.z as usize];
        let inside = q.cmpge(Vec3::ZERO).all() && x < self.size[0] && y < self.size[1] && z < self.size[2];
        inside.then(|| (z * self.size[1] + y) * self.size[0] + x)
    }
}

/// The box that contains the hair [m], without strands that have flown off; `None` if there is no finite
/// point.
///
/// Points farther from the center than 12 times the mean distance (per axis) are ignored. A single stray
/// strand would otherwise take all the voxels.
pub(crate) fn bounds(styles: &[&[Vec3]]) -> Option<(Vec3, Vec3)> {
    // A few thousand points of every style are enough to find the box.
    let some = |points: &[Vec3]| points.len() / 8192 + 1;
    let sample =
        || styles.iter().flat_map(|points| points.iter().step_by(some(points))).filter(|p| p.is_finite());
    let count = sample().count();
    if count == 0 {
        return None;
    }
    let mean = sample().fold(glam::DVec3::ZERO, |sum, p| sum + p.as_dvec3()) / count as f64;
    let spread = sample().fold(glam::DVec3::ZERO, |sum, p| sum + (p.as_dvec3() - mean).abs()) / count as f64;
    let (mean, reach) = (mean.as_vec3(), (spread * 12.0).as_vec3() + Vec3::splat(1e-3));
    let (low, high) = (mean - reach, mean + reach);
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let join = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
    let found = styles.iter().fold(none, |found, points| {
        let of = |points: &[Vec3]| {
            points.iter().fold(none, |b, p| {
                if p.cmpge(low).all() && p.cmple(high).all() { join(b, (*p, *p)) } else { b }
            })
        };
        join(found, points.par_chunks(1 << 16).map(of).reduce(|| none, join))
    });
    // Limits the extent of the shadow to that of a building, for any input.
    (found.0.is_finite() && found.1.is_finite() && (found.1 - found.0).max_element() < 1e4).then_some(found)
}

/// Working memory of the grid.
#[derive(Debug, Default)]
pub(crate) struct Density {
    pub grid: Grid,
    partial: Vec<Vec<u32>>,
    /// Voxels that a surface of a body passes through.
    walls: Vec<bool>,
    /// Voxel of each vertex of one body.
    nearest: Vec<Option<usize>>,
    scratch: Vec<f32>,
    /// Hair only, in optical depth per voxel.
    pub hair: Vec<f32>,
    /// Hair and the walls of bodies.
    pub all: Vec<f32>,
}

impl Density {
    /// Fills the grid from the frame's strands and bodies.
    pub fn fill(&mut self, frame: &Frame, bounds: (Vec3, Vec3), order: &Order) {
        self.grid = Grid::around(bounds, frame.quality.shadow_voxels);
        let (grid, len) = (self.grid, self.grid.len());
        let level = Level::new();
        // One grid per thread. More than eight would cost more to add up than they save.
        let parts = rayon::current_num_threads().clamp(1, 8);
        self.partial.resize_with(parts, Vec::new);
        let (partial, walls, nearest) = (&mut self.partial, &mut self.walls, &mut self.nearest);
        let splats = |(part, sum): (usize, &mut Vec<u32>)| {
            sum.clear();
            sum.resize(len, 0);
            let n = order.runs.len();
            for run in &order.runs[part * n / parts..(part + 1) * n / parts] {
                let (hair, strands) = (&frame.hair[run.hair], order.strands(run));
                dispatch!(level, simd => splat::splat(simd, &grid, hair, strands, sum));
            }
        };
        rayon::join(
            || partial.par_iter_mut().enumerate().for_each(splats),
            || {
                walls.clear();
                walls.resize(len, false);
                frame.bodies.iter().for_each(|body| wall_in(&grid, body, nearest, walls));
            },
        );
        let [nx, ny, _] = grid.size;
        let partial = &self.partial;
        self.hair.resize(len, 0.0);
        self.hair.par_chunks_mut(nx * ny).enumerate().for_each(|(z, slice)| {
            for (i, value) in slice.iter_mut().enumerate() {
                let sum = partial.iter().fold(0u32, |s, p| s.saturating_add(p[z * nx * ny + i]));
                *value = sum as f32 * (1.0 / UNIT);
            }
        });
        blur(&grid, &mut self.hair, &mut self.scratch);
        self.all.resize(len, 0.0);
        let walls = self.walls.par_iter().zip(&self.hair);
        self.all.par_iter_mut().with_min_len(1 << 14).zip(walls).for_each(|(all, (wall, hair))| {
            *all = if *wall { hair.max(WALL) } else { *hair };
        });
    }
}

/// Marks the voxels that a body's triangles pass through, by rows of samples on them, less than a voxel
/// apart.
fn wall_in(grid: &Grid, body: &MeshDraw, nearest: &mut Vec<Option<usize>>, walls: &mut [bool]) {
    body.positions.par_iter().map(|p| grid.nearest(*p)).collect_into_vec(nearest);
    let most = (grid.voxel / FINER).powi(2);
    for t in body.triangles {
        let Some([a, b, c]) = corners(body.positions, t) else { continue };
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        if longest <= most {
            // Small triangles, the majority in a fine mesh: the corners are sufficient as samples.
            t.iter().filter_map(|i| nearest[*i as usize]).for_each(|at| walls[at] = true);
        } else if longest.is_finite() {
            wall_across(grid, [a, b, c], longest.sqrt(), walls);
        }
    }
}

/// Samples of a triangle per voxel along its longest edge.
const FINER: f32 = 1.5;

/// Marks the voxels that a large triangle passes through.
fn wall_across(grid: &Grid, [a, b, c]: [Vec3; 3], longest: f32, walls: &mut [bool]) {
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let end =
        grid.origin + Vec3::new(grid.size[0] as f32, grid.size[1] as f32, grid.size[2] as f32) * grid.voxel;
    if !(low.cmple(end).all() && high.cmpge(grid.origin).all()) {
        return;
    }
    // The number of samples is limited to 512 for triangles much larger than the grid.
    let n = (longest / grid.voxel * FINER).ceil().clamp(1.0, 512.0) as usize;
    for i in 0..=n {
        for j in 0..=n - i {
            let (u, v) = (i as f32 / n as f32, j as f32 / n as f32);
            if let Some(at) = grid.nearest(a + (b - a) * u + (c - a) * v) {
                walls[at] = true;
            }
        }
    }
}

/// Tent filter of ±1 voxel along each axis. It makes nearest-voxel sums as smooth as trilinear splats.
fn blur(grid: &Grid, values: &mut Vec<f32>, scratch: &mut Vec<f32>) {
    let [nx, ny, _] = grid.size;
    let slice = nx * ny;
    for stride in [1, nx, slice] {
        scratch.resize(values.len(), 0.0);
        let from = &values[..];
        // The padding is empty, so wrapping around at the faces mixes only zeros.
        scratch.par_chunks_mut(slice).enumerate().for_each(|(z, out)| {
            let base = z * slice;
            for (i, value) in out.iter_mut().enumerate() {
                let at = base + i;
                let before = if at >= stride { from[at - stride] } else { 0.0 };
                let after = if at + stride < from.len() { from[at + stride] } else { 0.0 };
                *value = 0.25 * (before + after) + 0.5 * from[at];
            }
        });
        std::mem::swap(values, scratch);
    }
}
