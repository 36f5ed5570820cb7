//! Pressure down the gradient of density, and friction (Petrovic, Henne, Anderson 2005, *Volumetric Methods for Simulation and Rendering of Hair*).
//!
//! ```text
//! cell   p = c² e ρ_least           e: how much fuller the cell is than it may be,   ρ_least: the least density at its corners
//! node   A = −∇p / ρ
//! ```
//!
//! What pushes a node pushes another back, so momentum is kept; ρ_least bounds what a node with next to no hair can take, and makes the
//! pressure 0 at the surface. The density that hair is pressed toward is that of the groom: cells are filled as at rest.

use super::field::Field;
use glam::Vec3;
use rayon::prelude::*;

/// Most that pressure knows of how overfull a cell is [1].
pub const MOST_EXCESS: f32 = 1.0;

/// Least time in which pressure crosses a cell, in intervals: it acts at the end of one on what was at its start, and a wave that crosses
/// a cell in less than that grows (Courant, Friedrichs, Lewy 1928), the faster the more diagonal: √3.
const CROSSING: f32 = 2.0;

/// Pressure of every cell, in the mass of the largest point [1]: e ρ_least.
pub fn pressures(field: &Field, excess: impl Fn(usize) -> f32 + Sync, pressures: &mut Vec<f32>) {
    let window = field.window;
    let (slab, corners) = (window.slab(), window.corners());
    pressures.resize(window.nodes(), 0.0);
    pressures.par_chunks_mut(slab).enumerate().for_each(|(z, out)| {
        let first = z * slab;
        out.fill(0.0);
        if z + 1 >= window.dims[2] {
            return;
        }
        let cells = slab.saturating_sub(window.dims[0] + 1);
        for (c, p) in out.iter_mut().enumerate().take(cells) {
            let cell = first + c;
            if field.fill[cell] > 1.0 {
                let excess = excess(cell).min(MOST_EXCESS);
                if excess > 0.0 {
                    let mass = corners.iter().map(|k| field.nodes[cell + k][3]);
                    *p = excess * mass.fold(f32::INFINITY, f32::min);
                }
            }
        }
    });
}

/// Acceleration of the nodes by these pressures of the cells, in the lattice's axes [m/s²], for waves of `speed` [m/s] in cells of `cell` [m] and
/// intervals of `dt` [s].
pub struct Push<'a> {
    pressures: &'a [f32],
    corners: [usize; 8],
    /// c²/4h [m/s²].
    strength: f32,
}

impl<'a> Push<'a> {
    /// See [`Push`].
    pub fn new(field: &Field, pressures: &'a [f32], speed: f32, cell: f32, dt: f32) -> Self {
        let speed = speed.min(cell / (CROSSING * dt));
        Self { pressures, corners: field.window.corners(), strength: speed * speed / (4.0 * cell) }
    }

    /// Of node `n`, of this mass, inside of the window's ring.
    pub fn at(&self, n: usize, mass: f32) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (k, corner) in self.corners.iter().enumerate() {
            // A node that is a cell's upper corner is pushed up.
            let p = self.pressures[n - corner];
            let along = |bit: usize| if k & bit == 0 { -p } else { p };
            sum += Vec3::new(along(1), along(2), along(4));
        }
        sum * (self.strength / mass)
    }
}
