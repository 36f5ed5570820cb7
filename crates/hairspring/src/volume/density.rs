//! Pressure along the negative density gradient, and friction (Petrovic, Henne, Anderson 2005, *Volumetric
//! Methods for Simulation and Rendering of Hair*).
//!
//! ```text
//! cell   p = c² e ρ_least           e: excess of the cell's fill over the allowed fill,   ρ_least: the smallest density at its corners
//! node   A = −∇p / ρ
//! ```
//!
//! The force on each node has an opposite reaction, so momentum is conserved. ρ_least bounds the acceleration
//! of nodes with very little hair, and makes the pressure 0 at the surface. The target density is that of the
//! groom: cells as full as at rest.

use super::field::Field;
use crate::parallel::prelude::*;
use glam::Vec3;

/// Largest excess that the pressure takes into account [1].
pub const MAX_EXCESS: f32 = 1.0;

/// Minimum time for a pressure wave to cross a cell, in intervals. The pressure is computed at the start of
/// an interval and acts during it, so faster waves grow (Courant, Friedrichs, Lewy 1928). Diagonal waves are
/// the most critical: √3.
const MIN_CROSSING_TIME: f32 = 2.0;

/// Computes the pressure of every cell, e ρ_least, with mass relative to the largest point's [1].
pub fn pressures(field: &Field, excess: impl Fn(usize) -> f32 + Sync, pressures: &mut Vec<f32>) {
    let bounds = field.bounds;
    let (slab, corners) = (bounds.slab(), bounds.corners());
    pressures.resize(bounds.nodes(), 0.0);
    pressures.par_chunks_mut(slab).enumerate().for_each(|(z, out)| {
        let first = z * slab;
        out.fill(0.0);
        if z + 1 >= bounds.dims[2] {
            return;
        }
        let cells = slab.saturating_sub(bounds.dims[0] + 1);
        for (c, p) in out.iter_mut().enumerate().take(cells) {
            let cell = first + c;
            if field.fill[cell] > 1.0 {
                let excess = excess(cell).min(MAX_EXCESS);
                if excess > 0.0 {
                    let mass = corners.iter().map(|k| field.nodes[cell + k][3]);
                    *p = excess * mass.fold(f32::INFINITY, f32::min);
                }
            }
        }
    });
}

/// Acceleration of the nodes from the cells' pressures, in the grid's axes [m/s²]. Waves have the speed
/// `speed` [m/s] in cells of `cell` [m] and intervals of `dt` [s].
pub struct Push<'a> {
    pressures: &'a [f32],
    corners: [usize; 8],
    /// c²/4h [m/s²].
    strength: f32,
}

impl<'a> Push<'a> {
    /// Creates the accelerations, see [`Push`].
    pub fn new(field: &Field, pressures: &'a [f32], speed: f32, cell: f32, dt: f32) -> Self {
        let speed = speed.min(cell / (MIN_CROSSING_TIME * dt));
        Self { pressures, corners: field.bounds.corners(), strength: speed * speed / (4.0 * cell) }
    }

    /// Returns the acceleration of node `n` with this mass. The node must not be in the outer ring of the
    /// bounds.
    pub fn at(&self, n: usize, mass: f32) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (k, corner) in self.corners.iter().enumerate() {
            // A node that is the upper corner of a cell is pushed upward.
            let p = self.pressures[n - corner];
            let along = |bit: usize| if k & bit == 0 { -p } else { p };
            sum += Vec3::new(along(1), along(2), along(4));
        }
        sum * (self.strength / mass)
    }
}
