//! Velocities made free of divergence (McAdams, Selle, Ward, Sifakis, Teran 2009, *Detail Preserving Continuum Simulation of Straight Hair*).
//!
//! ```text
//! D M⁻¹ Dᵀ p = d − D v       v⁺ = v + M⁻¹ Dᵀ p       p ≥ 0,       d = e/τ where a cell is overfull by e
//! ```
//!
//! over the cells that are full. (D v) of a cell is the divergence of the velocities at its eight corners, p its pressure times time, M the
//! mass at the nodes: one operator and its transpose, so that what pushes a node pushes another back and the result is exact for these
//! very velocities. Cells that are not full have no pressure: hair's surface is free. Nodes inside a collider move with it and have no
//! inverse mass: hair is pressed off the body.
//!
//! Hair is no liquid, and nothing keeps it from parting: pressure only presses (as Narain, Golas, Lin 2010 have it for sand). Cells that the solve
//! finds to pull are let go, and the others solved again from what they have: one step of an active set, after which what still pulls counts as 0.

use super::{conjugate::Solve, field::Field};
use glam::Vec3;
use rayon::prelude::*;

/// How full a cell is that hair begins to press in, and from which on it is hard [1]: below what chance leaves of a full one, see `rest::POINTS_A_CELL`.
const FULL: [f32; 2] = [0.9, 0.95];

/// Least mass at a corner of such a cell, over the mean of its eight [1], where it begins to press and where it is hard: what hangs on less is at the surface.
const LEAST_MASS: [f32; 2] = [0.025, 0.05];

/// How hard a cell is, 0 to 1, of which something is at `x`. Were there nothing between, the last bit of a place would tell whether a cell presses.
fn hardness(x: f32, [soft, hard]: [f32; 2]) -> f32 {
    ((x - soft) / (hard - soft)).clamp(0.0, 1.0)
}

/// Solves: of all full cells, then of those that press.
const SOLVES: usize = 2;

/// What the projection keeps from frame to frame: memory.
#[derive(Default)]
pub struct Projection {
    solve: Solve,
    /// Velocities in the lattice's axes [m/s].
    velocities: [Vec<f32>; 3],
}

/// What a projection came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projected {
    /// Cells that press.
    pub cells: usize,
    /// Iterations of the last solve.
    pub iterations: u32,
    /// What is left of the divergence of the cells that press, over what it was (root mean squares) [1].
    pub left: f64,
}

impl Projection {
    /// Room for so many nodes ever.
    pub fn reserve(&mut self, nodes: usize) {
        self.solve.reserve(nodes);
        self.velocities.iter_mut().for_each(|v| v.reserve_exact(nodes));
    }

    /// The next projection knows of none before it.
    pub fn forget(&mut self) {
        self.solve.forget();
    }

    /// Finds what changes the velocities of `field`. `to_lattice` turns a node's velocity into the lattice's axes and says whether the node
    /// is solid, in which case it is the solid's; `wanted` is the divergence that a cell is to have, times 4 cells [m/s].
    pub fn project(
        &mut self,
        field: &Field,
        to_lattice: impl Fn(usize, &[f32; 4]) -> (Vec3, bool) + Sync,
        wanted: impl Fn(usize) -> f32 + Sync,
    ) -> Projected {
        let window = field.window;
        let (slab, corners) = (window.slab(), window.corners());
        self.velocities.iter_mut().for_each(|v| v.resize(window.nodes(), 0.0));
        self.solve.begin(window);
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
            let hard =
                hardness(field.fill[cell], FULL) * hardness(least / mean.max(f32::MIN_POSITIVE), LEAST_MASS);
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

    /// Change of the velocity of node `n` in the lattice's axes [m/s].
    pub fn change(&self, n: usize) -> Vec3 {
        self.solve.change(n)
    }
}
