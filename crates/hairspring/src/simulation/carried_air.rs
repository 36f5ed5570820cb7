//! The air inside dense hair, which moves with the hair.
//!
//! A point that the share e of the outer air reaches (`exposure.rs`) moves relative to the air at
//!
//! ```text
//! u = e w + (1 − e) (V + ½ (v − v₀)) − v      w: velocity of the air outside the hair      v: velocity of the point
//!                                             V, v₀: mean velocity around the point, and its own, at the start of the frame
//!   = s (w + δ − v),   s = ½ (1 + e)          s: `rest::SLIP`                              δ: `wind_delta`
//! ```
//!
//! A head of hair that moves as one thus has little drag, while a hair that moves relative to its neighbors has that of a lone
//! hair. If the inner hair had only e times the drag, each hair would swing by itself for half a minute.
//!
//! V is the mean in a cell of the groom at rest, weighted by length, multiplicity and 1 − e, so the drag against it hardly changes
//! the momentum of the cell. Inside the cell, V rotates with the hair's root. Within a frame, the air follows half of the change of a point's velocity. If it
//! followed all of it, fast vibrations could gain energy; if it followed none, it would hold back hair that speeds up.
//!
//! # Limitations
//! Neighbors are those at rest. Hair that is combed to the other side keeps them.

use super::strand_model::StrandModel;
use crate::{
    forces::StrandView,
    parallel::prelude::*,
    simd::lanes::LANES,
    strand::tile::{StateRows, rest, state},
};
use glam::Vec3;
use std::collections::BTreeMap;

/// Edge length of a cell [m]: about the size of a lock.
const CELL: f32 = 0.02;

/// Largest share of the outer air at which a point counts as in hair [1].
const MOST_EXPOSED: f32 = 0.99;

/// No cell.
const NONE: u32 = u32::MAX;

/// Cells of dense hair at rest.
#[derive(Clone, Default)]
pub(super) struct CarriedAir {
    /// Cell of each point of each tile; `NONE` where the air is that outside. Empty if it is everywhere.
    pub cell: Vec<[u32; LANES]>,
    cells: Vec<Cell>,
}

/// Dense hair at one place.
#[derive(Clone)]
struct Cell {
    /// Its points: row, lane, and share of the weight of all.
    points: Vec<(u32, u8, f32)>,
    /// The mean of the positions at rest [m].
    middle: Vec3,
}

impl Cell {
    /// The mean velocity of its points [m/s].
    fn velocity(&self, points: &[StateRows]) -> Vec3 {
        let velocity = |row: u32, lane: u8| {
            let v = Vec3::from([0, 1, 2].map(|k| points[row as usize][state::V + k].0[lane as usize]));
            // A strand that is reset because it is not finite does not spread.
            if v.is_finite() { v } else { Vec3::ZERO }
        };
        self.points.iter().map(|&(row, lane, weight)| velocity(row, lane) * weight).sum()
    }
}

/// Returns the share of slip of a point that the share `exposure` of the outer air reaches [1].
pub(super) fn slip(exposure: f32) -> f32 {
    if exposure > MOST_EXPOSED { 1.0 } else { 0.5 * (1.0 + exposure) }
}

impl CarriedAir {
    /// Whether no air is carried.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Finds the cells of hair at rest, from the shares of slip in the rest shapes.
    pub fn new(model: &StrandModel) -> Self {
        let mut cell = vec![[NONE; LANES]; model.rest.len()];
        let mut cells: Vec<Cell> = Vec::new();
        let mut found: BTreeMap<[i32; 3], u32> = BTreeMap::new();
        for (place, s) in model.groom_strands.iter().enumerate().filter(|(_, s)| **s != u32::MAX) {
            let (tile, lane) = (model.tiles[place / LANES], place % LANES);
            let hairs = model.multiplicity[*s as usize];
            let mut before = 0.0;
            for (i, point) in model.groom.strand(*s as usize).iter().enumerate() {
                let row = tile.first as usize + i * tile.model.stride();
                let after = model.rest[row][rest::LENGTH].0[lane];
                let length = 0.5 * (after + std::mem::replace(&mut before, after));
                let carried = 2.0 * (1.0 - model.rest[row][rest::SLIP].0[lane]);
                // The root moves the first two points.
                if i < 2 || carried == 0.0 {
                    continue;
                }
                let key = (*point / CELL).floor().as_ivec3().to_array();
                let number = *found.entry(key).or_insert_with(|| {
                    cells.push(Cell { points: Vec::new(), middle: Vec3::ZERO });
                    cells.len() as u32 - 1
                });
                cell[row][lane] = number;
                let weight = carried * length * hairs;
                let held = &mut cells[number as usize];
                held.points.push((row as u32, lane as u8, weight));
                held.middle += *point * weight;
            }
        }
        for cell in &mut cells {
            let sum = cell.points.iter().map(|(_, _, weight)| *weight).sum::<f32>().max(f32::MIN_POSITIVE);
            cell.middle /= sum;
            cell.points.iter_mut().for_each(|(_, _, weight)| *weight /= sum);
        }
        if cells.is_empty() {
            cell.clear();
        }
        Self { cell, cells }
    }
}

/// The air inside the hair in a frame.
#[derive(Default)]
pub(super) struct AirInHair {
    /// Of each cell [m/s].
    velocities: Vec<Vec3>,
    /// Rotation of the hair [rad/s].
    spin: Vec3,
}

impl AirInHair {
    /// Finds the air from the velocities of the points at the start of a frame in which the hair rotates by `spin` [rad/s].
    pub fn measure(&mut self, carried: &CarriedAir, points: &[StateRows], spin: Vec3) {
        self.spin = spin;
        self.velocities.resize(carried.cells.len(), Vec3::ZERO);
        self.velocities.par_iter_mut().zip(&carried.cells).with_min_len(64).for_each(|(mean, cell)| {
            *mean = cell.velocity(points);
        });
    }

    /// Changes the air at the points of a strand from that outside to that inside the hair. `rest` has the points at rest [m],
    /// and `uniform` is the directional wind [m/s].
    pub fn apply(&self, carried: &CarriedAir, rest: &[Vec3], uniform: Vec3, strand: &mut StrandView) {
        let turn = strand.roots()[0].rotation;
        for (i, rest) in rest.iter().enumerate().skip(2) {
            let cell = strand.air_cell(i);
            if cell == NONE {
                continue;
            }
            let off = turn * (*rest - carried.cells[cell as usize].middle);
            let inside = self.velocities[cell as usize] + self.spin.cross(off);
            strand.shelter_air(i, inside, uniform);
        }
    }
}
