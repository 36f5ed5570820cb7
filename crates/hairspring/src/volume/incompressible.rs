//! Projects velocities to be free of divergence (McAdams, Selle, Ward, Sifakis, Teran 2009, *Detail
//! Preserving Continuum Simulation of Straight Hair*).
//!
//! ```text
//! D M⁻¹ Dᵀ p = d − D v       v⁺ = v + M⁻¹ Dᵀ p       p ≥ 0,       d = e/τ where a cell is overfull by e
//! ```
//!
//! The system covers the full cells. (D v) of a cell is the divergence of the velocities at its eight
//! corners, p its pressure times time, and M the mass at the nodes. The same operator and its transpose are
//! used, so momentum is conserved and the result is exact for these velocities. Cells that are not full have
//! no pressure: the surface of the hair is free. Nodes inside a collider move with it and have zero inverse
//! mass, so hair is pushed off the body.
//!
//! Hair is not a liquid: nothing keeps it from separating. The pressure is therefore never negative (like
//! that of sand in Narain, Golas, Lin 2010). Cells with negative pressure in the first solve are released,
//! and the others are solved again, starting from their pressures. This is one step of an active-set method;
//! pressures that are still negative count as 0.

use super::{conjugate::Solve, field::Field};
use crate::parallel::prelude::*;
use glam::Vec3;

/// Fill at which a cell begins to have pressure, and at which it is hard [1]. Both are below the random
/// variation of a full cell, see `rest::POINTS_A_CELL`.
const FULL_CELL_FILL: [f32; 2] = [0.9, 0.95];

/// Thresholds as [`FULL_CELL_FILL`], for the smallest mass at a corner of the cell relative to the mean of its eight
/// [1]. A cell with less is at the surface.
const MIN_CORNER_MASS: [f32; 2] = [0.025, 0.05];

/// Returns the hardness of a cell for a value `x`, 0 to 1. The ramp prevents the rounding of a position from
/// deciding whether the cell has pressure.
fn hardness(x: f32, [soft, hard]: [f32; 2]) -> f32 {
    ((x - soft) / (hard - soft)).clamp(0.0, 1.0)
}

/// Number of solves: one for all full cells, then one for those with positive pressure.
const SOLVES: usize = 2;

/// Buffers of the projection, kept from frame to frame.
#[derive(Default)]
pub struct Projection {
    solve: Solve,
    /// Velocities in the grid's axes [m/s].
    velocities: [Vec<f32>; 3],
}

/// Statistics of a projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projected {
    /// Number of cells with pressure.
    pub cells: usize,
    /// Number of iterations of the last solve.
    pub iterations: u32,
    /// Remaining divergence of the cells with pressure, relative to that before (root mean squares) [1].
    pub left: f64,
}

impl Projection {
    /// Reserves memory for at most `nodes` nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.solve.reserve(nodes);
        self.velocities.iter_mut().for_each(|v| v.reserve_exact(nodes));
    }

    /// Discards the warm start of the next projection.
    pub fn clear(&mut self) {
        self.solve.clear();
    }

    /// Computes the change of the velocities of `field`. `to_lattice` rotates a node's velocity to the grid's
    /// axes and returns whether the node is solid; if so, the velocity is that of the solid. `wanted` is the
    /// target divergence of a cell, times 4 cells [m/s].
    pub fn project(
        &mut self,
        field: &Field,
        to_lattice: impl Fn(usize, &[f32; 4]) -> (Vec3, bool) + Sync,
        wanted: impl Fn(usize) -> f32 + Sync,
    ) -> Projected {
        let bounds = field.bounds;
        let (slab, corners) = (bounds.slab(), bounds.corners());
        self.velocities.iter_mut().for_each(|v| v.resize(bounds.nodes(), 0.0));
        self.solve.begin(bounds);
        let [vx, vy, vz] = &mut self.velocities;
        let inverse = &mut self.solve.inverse_mass;
        let parts = field.nodes.par_chunks(slab).zip(inverse.par_chunks_mut(slab));
        let parts =
            parts.zip(vx.par_chunks_mut(slab).zip(vy.par_chunks_mut(slab)).zip(vz.par_chunks_mut(slab)));
        parts.enumerate().for_each(|(z, ((nodes, inverse), ((vx, vy), vz)))| {
            for (n, node) in nodes.iter().enumerate() {
                (inverse[n], vx[n], vy[n], vz[n]) = (0.0, 0.0, 0.0, 0.0);
                if node[3] > 0.0 {
                    let (v, solid) = to_lattice(z * slab + n, node);
                    (vx[n], vy[n], vz[n]) = (v.x, v.y, v.z);
                    inverse[n] = if solid { 0.0 } else { 1.0 / node[3] };
                }
            }
        });
        let [vx, vy, vz] = &self.velocities;
        let cells = self.solve.fill(|cell| {
            let masses = corners.map(|k| field.nodes[cell + k][3]);
            let least = masses.iter().copied().fold(f32::INFINITY, f32::min);
            let mean = 0.125 * masses.iter().sum::<f32>();
            let hard = hardness(field.fill[cell], FULL_CELL_FILL)
                * hardness(least / mean.max(f32::MIN_POSITIVE), MIN_CORNER_MASS);
            if hard <= 0.0 {
                return None;
            }
            let mut flow = wanted(cell);
            for (k, corner) in corners.iter().enumerate() {
                let n = cell + corner;
                let out = |v: &[f32], bit: usize| if k & bit == 0 { v[n] } else { -v[n] };
                flow += out(vx, 1) + out(vy, 2) + out(vz, 4);
            }
            Some((flow, hard))
        });
        let mut projected = Projected { cells, ..Projected::default() };
        for solve in 0..SOLVES {
            if solve > 0 {
                projected.cells = self.solve.let_go();
            }
            if projected.cells == 0 {
                break;
            }
            (projected.iterations, projected.left) = self.solve.run();
        }
        self.solve.press();
        projected
    }

    /// Returns the change of the velocity of node `n` in the grid's axes [m/s].
    pub fn change(&self, n: usize) -> Vec3 {
        self.solve.change(n)
    }
}
