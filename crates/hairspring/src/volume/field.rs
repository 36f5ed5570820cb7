//! Node and cell values computed from the sums over all points.

use super::{
    grid_bounds::GridBounds,
    splat::{REST_VOLUME_UNITS, Sums, Units, VALUES_PER_NODE},
};
use crate::parallel::prelude::*;

/// Number of used values in an element of [`Field::push`].
pub const VALUES_PER_PUSH: usize = 9;
pub const PUSH: usize = 12;

/// Indices in an element of [`Field::push`] of the rows of the symmetric matrix.
pub const BRAKE: [[usize; 3]; 3] = [[3, 6, 8], [6, 4, 7], [8, 7, 5]];

/// Hair as a continuum, and its effect on the points in it.
#[derive(Default)]
pub struct Field {
    /// Bounds of the grid.
    pub bounds: GridBounds,
    /// Mean velocity at each node [m/s], and its mass relative to that of the largest point; shape `[nodes]`.
    pub nodes: Vec<[f32; 4]>,
    /// Mean direction of the strands at each node [1], whose length shows how far they agree, and the
    /// standard deviation of the velocities [m/s].
    pub spread: Vec<[f32; 4]>,
    /// Rest volume of the points at each node [cells].
    rest_volumes: Vec<f32>,
    /// Fill of each cell: rest volume over cell volume, the mean of its corners [1].
    pub fill: Vec<f32>,
    /// Values that a point interpolates with its trilinear weights: an acceleration [m/s²], and a symmetric
    /// drag matrix that multiplies its own velocity [1/s].
    pub push: Vec<[f32; PUSH]>,
}

impl Field {
    /// Reserves memory for at most `nodes` nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.nodes.reserve_exact(nodes);
        self.spread.reserve_exact(nodes);
        self.rest_volumes.reserve_exact(nodes);
        self.fill.reserve_exact(nodes);
        self.push.reserve_exact(nodes);
    }

    /// Adds up the sums of all threads.
    pub fn collect(&mut self, bounds: GridBounds, units: &Units, sums: &[Sums]) {
        self.bounds = bounds;
        let (count, slab) = (bounds.nodes(), bounds.slab());
        self.nodes.resize(count, [0.0; 4]);
        self.spread.resize(count, [0.0; 4]);
        self.rest_volumes.resize(count, 0.0);
        self.fill.resize(count, 0.0);
        self.push.resize(count, [0.0; PUSH]);
        // Uses double precision, because the variance of the velocities is the difference of two squares.
        let to_mass = 1.0 / units.mass;
        let to_speed = f64::from(units.mass) / f64::from(units.momentum);
        let to_square = f64::from(units.mass) / f64::from(units.energy);
        let parts = self.nodes.par_chunks_mut(slab).zip(self.spread.par_chunks_mut(slab));
        parts.zip(self.rest_volumes.par_chunks_mut(slab)).enumerate().for_each(
            |(z, ((nodes, spread), rest_volumes))| {
                let first = z * slab;
                for (n, (node, spread)) in nodes.iter_mut().zip(spread).enumerate() {
                    let mut sum = [0; VALUES_PER_NODE];
                    for own in sums {
                        let Some(own) =
                            own.nodes[(first + n) * VALUES_PER_NODE..].first_chunk::<VALUES_PER_NODE>()
                        else {
                            continue;
                        };
                        for (sum, own) in sum.iter_mut().zip(own) {
                            // As in `splat`: sums that cancel may leave the range in between.
                            *sum = i32::wrapping_add(*sum, *own);
                        }
                    }
                    let mass = sum[3] as f32;
                    let inverse = if sum[3] > 0 { 1.0 / f64::from(sum[3]) } else { 0.0 };
                    let mean = sum.map(|sum| f64::from(sum) * inverse);
                    let v = [0, 1, 2].map(|k| mean[k] * to_speed);
                    let square = mean[7] * to_square - v.iter().map(|v| v * v).sum::<f64>();
                    let [x, y, z] = [0, 1, 2].map(|k| v[k] as f32 + units.carried[k]);
                    *node = [x, y, z, mass * to_mass];
                    *spread = [mean[4] as f32, mean[5] as f32, mean[6] as f32, square.max(0.0).sqrt() as f32];
                }
                for (n, rest_volume) in rest_volumes.iter_mut().enumerate() {
                    let sum =
                        sums.iter().fold(0_u32, |sum, own| sum.saturating_add(own.rest_volumes[first + n]));
                    *rest_volume = sum as f32 * (1.0 / REST_VOLUME_UNITS);
                }
            },
        );
        self.fill_cells();
    }

    /// Computes `fill` from `rest_volumes` as the mean of a cell's eight corners. It is continuous when a point
    /// crosses from one cell to the next.
    fn fill_cells(&mut self) {
        let [nx, ny, nz] = self.bounds.dims;
        let (slab, corners, rest_volumes) = (nx * ny, self.bounds.corners(), &self.rest_volumes);
        self.fill.par_chunks_mut(slab).enumerate().for_each(|(z, fill)| {
            fill.fill(0.0);
            if z + 1 >= nz {
                return;
            }
            for y in 0..ny.saturating_sub(1) {
                let row = y * nx..(y + 1) * nx - 1;
                let sides = corners.map(|corner| &rest_volumes[z * slab + row.start + corner..][..row.len()]);
                for (x, out) in fill[row].iter_mut().enumerate() {
                    *out = 0.125 * sides.iter().map(|side| side[x]).sum::<f32>();
                }
            }
        });
    }
}
