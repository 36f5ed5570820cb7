//! Self-occlusion: the share of the air outside the hair that reaches each point. Dense hair carries the air
//! inside it along.
//!
//! Air flows at U relative to hair with n fibers of diameter d per area across them. The flow loses its
//! momentum to their drag:
//!
//! ```text
//! ρ U dU/ds = −n d ½ρU² Cd   ⟹   U = U₀ e^(−τ),   τ = ½ Cd ∫ n d ds
//! ```
//!
//! n is the length of hair per volume at rest, weighted by the multiplicity of each strand. τ is taken along
//! the path from outside that crosses the least hair and no collider. In the point's own cell, e^(−τ) is
//! averaged over the cell, without the hair itself. A lone hair therefore feels all of the air, and all hair
//! together absorbs no more momentum than the air has. The rest of the air moves with the hair
//! (`carried_air.rs`).
//!
//! # Limitations
//! n is that of the groom at rest. Wind from every side reaches a point along the same path. Occlusion behind
//! hair and bodies, which depends on the wind direction, is in [`crate::air::WindOcclusion`].

use super::{
    Simulation,
    carried_air::{CarriedAir, slip},
};
use crate::{
    collide::ColliderPose,
    simd::lanes::LANES,
    strand::{drag::AIR_KINEMATIC_VISCOSITY, tile::rest},
};
use glam::Vec3;
use std::{cmp::Reverse, collections::BinaryHeap, sync::Arc};

/// Edge length of a cell [m]. Cells are larger if the hair needs more than [`MAX_CELLS`], or if guides are
/// so far apart that they leave gaps between cells.
const CELL: f32 = 0.005;

/// Mean number of strands in an occupied cell below which cells are made larger [1].
const MIN_STRANDS_PER_CELL: f32 = 3.0;

/// Edge length from which on cells are no longer enlarged for that [m].
const MAX_EDGE: f32 = 0.02;

/// Approximate largest number of cells.
const MAX_CELLS: f32 = 262_144.0;

/// Drag coefficient Cd of a hair in a wind of about 1 m/s.
const COEFFICIENT: f32 = 4.0;

/// Smallest τ of a cell that is divided by [1].
const MIN_DEPTH: f32 = 1e-6;

/// Smallest share of the air: some air reaches every point.
const MIN_EXPOSURE: f32 = 0.02;

impl Simulation {
    /// Enables self-occlusion, from the density of the groom at rest and `colliders` at rest. Without it,
    /// every strand has the drag of a lone hair.
    pub fn set_self_occlusion(&mut self, colliders: &[ColliderPose]) {
        let points = || self.strands().flat_map(|s| self.model.groom.strand(s as usize).iter().copied());
        let low = points().fold(Vec3::INFINITY, Vec3::min);
        let high = points().fold(Vec3::NEG_INFINITY, Vec3::max);
        let mut grid = self.dense_grid(low, high, CELL);
        while grid.edge < MAX_EDGE && grid.strands_per_cell() < MIN_STRANDS_PER_CELL {
            grid = self.dense_grid(low, high, 2.0 * grid.edge);
        }
        let depth = grid.depths(colliders);
        let mut found = Vec::with_capacity(self.point_count());
        for (place, s) in self.model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let tile = self.model.tiles[place / LANES];
            let reynolds = self.strand(place).reynolds();
            let own = 0.5 * COEFFICIENT * reynolds * AIR_KINEMATIC_VISCOSITY / grid.edge;
            for (i, point) in self.model.groom.strand(*s as usize).iter().enumerate() {
                let cell = grid.cell(*point);
                // A hair does not occlude itself.
                let others = (grid.cost[cell] - own).max(MIN_DEPTH);
                let mean = (1.0 - (-others).exp()) / others;
                let exposure = (mean * (-depth[cell]).exp()).max(MIN_EXPOSURE);
                let at = tile.first as usize + i * tile.model.stride();
                found.push((at, place % LANES, exposure));
            }
        }
        let model = Arc::make_mut(&mut self.model);
        for (at, lane, exposure) in found {
            model.rest[at][rest::SLIP].0[lane] = slip(exposure);
        }
        model.carried_air = CarriedAir::new(model);
    }

    /// Builds the density grid between `low` and `high`, with cells whose edge is at least `edge` [m].
    fn dense_grid(&self, low: Vec3, high: Vec3, edge: f32) -> Grid {
        let mut grid = Grid::new(low, high, edge);
        for (place, s) in self.model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let reynolds = self.strand(place).reynolds();
            let width = self.model.multiplicity[*s as usize] * reynolds * AIR_KINEMATIC_VISCOSITY;
            for w in self.model.groom.strand(*s as usize).windows(2) {
                grid.add(w[0], w[1], width);
            }
        }
        grid
    }
}

/// Density grid of the hair, with a border of empty cells.
struct Grid {
    low: Vec3,
    edge: f32,
    dims: [usize; 3],
    /// τ across each cell along an axis [1].
    cost: Vec<f32>,
    /// Total length of all strands [m].
    length: f32,
}

impl Grid {
    fn new(low: Vec3, high: Vec3, edge: f32) -> Self {
        let extent = (high - low).max(Vec3::splat(CELL));
        let edge = edge.max((extent.element_product() / MAX_CELLS).cbrt());
        let dims = (extent / edge).to_array().map(|n| n as usize + 3);
        Self { low: low - edge, edge, dims, cost: vec![0.0; dims.iter().product()], length: 0.0 }
    }

    fn cell(&self, place: Vec3) -> usize {
        let [x, y, z] = ((place - self.low) / self.edge).to_array().map(|k| k as usize);
        (z * self.dims[1] + y) * self.dims[0] + x
    }

    /// Adds hair of width `width` [m] from `a` to `b`.
    fn add(&mut self, a: Vec3, b: Vec3, width: f32) {
        let length = a.distance(b);
        self.length += length;
        let parts = (length / self.edge).ceil().max(1.0);
        // The projected area of the part, over that of a cell's face.
        let cost = 0.5 * COEFFICIENT * width * length / (parts * self.edge * self.edge);
        for k in 0..parts as usize {
            let cell = self.cell(a.lerp(b, (k as f32 + 0.5) / parts));
            self.cost[cell] += cost;
        }
    }

    fn strands_per_cell(&self) -> f32 {
        let held = self.cost.iter().filter(|cost| **cost > 0.0).count();
        self.length / (self.edge * held.max(1) as f32)
    }

    /// Smallest τ from outside to each cell, not counting the cell itself (Dijkstra 1959); infinite where
    /// colliders enclose it.
    fn depths(&self, colliders: &[ColliderPose]) -> Vec<f32> {
        let steps = [1, self.dims[0], self.dims[0] * self.dims[1]];
        let along = |cell: usize, axis: usize| cell / steps[axis] % self.dims[axis];
        let blocked = |cell: usize| {
            let at = Vec3::from([0, 1, 2].map(|axis| along(cell, axis) as f32 + 0.5)) * self.edge + self.low;
            self.cost[cell] == 0.0 && colliders.iter().any(|o| o.distance(at) < 0.0)
        };
        let mut depths = vec![f32::INFINITY; self.cost.len()];
        let mut queue = BinaryHeap::new();
        for (cell, depth) in depths.iter_mut().enumerate() {
            if (0..3).any(|axis| along(cell, axis) == 0 || along(cell, axis) + 1 == self.dims[axis])
                && !blocked(cell)
            {
                *depth = 0.0;
                queue.push(Reverse((0, cell)));
            }
        }
        // The bits of non-negative floats have the same order as the floats.
        while let Some(Reverse((bits, cell))) = queue.pop() {
            if f32::from_bits(bits) > depths[cell] {
                continue;
            }
            let depth = depths[cell] + self.cost[cell];
            for (axis, step) in steps.into_iter().enumerate() {
                let mut enter = |next: usize| {
                    if depth < depths[next] && !blocked(next) {
                        depths[next] = depth;
                        queue.push(Reverse((depth.to_bits(), next)));
                    }
                };
                if along(cell, axis) > 0 {
                    enter(cell - step);
                }
                if along(cell, axis) + 1 < self.dims[axis] {
                    enter(cell + step);
                }
            }
        }
        depths
    }
}
