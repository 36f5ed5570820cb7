//! The electric field of charged hair, which spreads hair apart and makes it stand on end.
//!
//! ```text
//! E(x) = k Σ q_n (x − x_n) / (|x − x_n|² + ε²)^(3/2),   n: nodes of a lattice around all hair, 16 along its longest side, ε: its cell
//! ```
//!
//! Charge is distributed to the nodes with trilinear weights (cloud-in-cell: Hockney & Eastwood 1988,
//! *Computer Simulation Using Particles*, ch. 5). The field is summed from all nodes to all nodes, softened
//! by one cell (Plummer 1911), and interpolated at points with the same weights. A strand's own charge
//! therefore does not push it, and momentum is conserved. Charge is counted in electrons, as integers, so the
//! result does not depend on the order of threads.

use super::{
    FrameMotion, StrandBatch, StrandView,
    charge::{BREAKDOWN, COULOMB, LineCharge},
};
use crate::parallel::prelude::*;
use glam::Vec3;
use std::sync::atomic::{AtomicI32, AtomicI64, Ordering::Relaxed};

/// Cells along the longest side of the hair: about 3 cm each for long hair. Closer than that, contact between
/// hairs dominates. The number bounds the cost of the sum of all nodes over all nodes, about a million for a
/// ball of hair.
const CELLS_PER_SIDE: f32 = 15.0;

/// Smallest cell [m].
const MIN_CELL: f32 = 1e-6;

/// Charge of an electron [C].
const ELECTRON_CHARGE: f64 = 1.602e-19;

/// The charge of all hair on a lattice, and its field.
#[derive(Default)]
pub(crate) struct HairField {
    /// Lowest and highest coordinates of the points, as [`ordered`] integers.
    lo: [AtomicI32; 3],
    hi: [AtomicI32; 3],
    /// Position of the lowest node [m].
    origin: Vec3,
    /// Edge of a cell [m].
    cell: f32,
    dims: [usize; 3],
    /// Charge of each node, as the number of missing electrons.
    charges: Vec<AtomicI64>,
    /// Charged nodes: position, and charge [C].
    loaded: Vec<(Vec3, f32)>,
    /// Field at each node [V/m].
    field: Vec<Vec3>,
}

impl HairField {
    /// Computes the field. `charge` returns the charge of a strand, including all hairs that it represents.
    pub fn find<'c>(
        &mut self,
        strands: &mut StrandBatch,
        frame: &FrameMotion,
        charge: impl Fn(usize) -> LineCharge<'c> + Sync,
    ) {
        self.clear();
        strands.each(frame, &|strand| self.reach(strand));
        self.lay_out();
        strands.each(frame, &|strand| self.load(&charge(strand.strand), strand));
        self.solve();
    }

    /// Resets to an empty lattice.
    fn clear(&mut self) {
        self.lo = [i32::MAX; 3].map(AtomicI32::new);
        self.hi = [i32::MIN; 3].map(AtomicI32::new);
        self.dims = [0; 3];
    }

    /// Extends the bounds to include a strand.
    fn reach(&self, strand: &StrandView) {
        let root = strand.roots()[0].translation;
        let places = || strand.points().map(|(x, _)| root + x).filter(|p| p.is_finite());
        let lo = places().fold(Vec3::INFINITY, Vec3::min).to_array();
        let hi = places().fold(Vec3::NEG_INFINITY, Vec3::max).to_array();
        for k in 0..3 {
            self.lo[k].fetch_min(ordered(lo[k]), Relaxed);
            self.hi[k].fetch_max(ordered(hi[k]), Relaxed);
        }
    }

    /// Sizes the lattice to the bounds of all strands.
    fn lay_out(&mut self) {
        let [lo, hi] =
            [&self.lo, &self.hi].map(|k| Vec3::from([0, 1, 2].map(|i| number(k[i].load(Relaxed)))));
        let size = hi - lo;
        // False for NaN, which means there is no strand.
        let any = size.min_element() >= 0.0 && size.max_element() < f32::MAX;
        if !any {
            return;
        }
        self.cell = (size.max_element() / CELLS_PER_SIDE).max(MIN_CELL);
        self.origin = lo;
        self.dims = (size / self.cell).to_array().map(|n| n.ceil().max(1.0) as usize + 1);
        // Reserve memory for the largest lattice, so that later frames do not allocate. Rounding may add a
        // cell.
        let most = (CELLS_PER_SIDE as usize + 2).pow(3);
        self.loaded.reserve(most.saturating_sub(self.loaded.len()));
        self.field.reserve(most.saturating_sub(self.field.len()));
        self.charges.resize_with(most, AtomicI64::default);
        self.charges.iter_mut().for_each(|charge| *charge.get_mut() = 0);
    }

    /// Distributes the charge of a strand to the lattice.
    fn load(&self, charge: &LineCharge, strand: &StrandView) {
        let root = strand.roots()[0].translation;
        for ((x, _), (per_length, length)) in strand.points().zip(charge.at_points(strand)) {
            let electrons = f64::from(per_length) * f64::from(length) / ELECTRON_CHARGE;
            for (node, weight) in self.around(root + x).into_iter().flatten() {
                self.charges[node].fetch_add((electrons * f64::from(weight)) as i64, Relaxed);
            }
        }
    }

    /// Computes the field of the charges on the lattice.
    fn solve(&mut self) {
        let nodes: usize = self.dims.iter().product();
        let ([nx, ny, _], origin, cell) = (self.dims, self.origin, self.cell);
        let place =
            |n: usize| origin + Vec3::new((n % nx) as f32, (n / nx % ny) as f32, (n / nx / ny) as f32) * cell;
        let charges = &self.charges[..nodes];
        let charge = |n: usize| (charges[n].load(Relaxed) as f64 * ELECTRON_CHARGE) as f32;
        self.loaded.clear();
        self.loaded.extend((0..nodes).map(|n| (place(n), charge(n))).filter(|(_, charge)| *charge != 0.0));
        self.field.clear();
        self.field.resize(nodes, Vec3::ZERO);
        let loaded = &self.loaded;
        self.field.par_iter_mut().with_min_len(64).enumerate().for_each(|(n, field)| {
            // Points only read nodes that they charge.
            if charges[n].load(Relaxed) == 0 {
                return;
            }
            let at = place(n);
            let sum: Vec3 = loaded
                .iter()
                .map(|(from, charge)| {
                    let d = at - *from;
                    let r2 = d.length_squared() + cell * cell;
                    d * (charge / (r2 * r2.sqrt()))
                })
                .sum();
            *field = (sum * COULOMB).clamp_length_max(BREAKDOWN);
        });
    }

    /// Returns the field at `place` in world space [V/m].
    pub fn field(&self, place: Vec3) -> Vec3 {
        self.around(place).into_iter().flatten().map(|(node, weight)| self.field[node] * weight).sum()
    }

    /// Returns the corner nodes of the cell that contains `place`, with their weights; `None` outside the
    /// lattice.
    fn around(&self, place: Vec3) -> Option<[(usize, f32); 8]> {
        let [nx, ny, nz] = self.dims;
        let at = (place - self.origin) / self.cell;
        let last = Vec3::new(nx as f32, ny as f32, nz as f32) - 1.0;
        // False for NaN, and if there is no lattice.
        let inside = at.min_element() >= 0.0 && (last - at).min_element() >= 0.0;
        if !inside {
            return None;
        }
        let floor = at.floor().min(last - 1.0);
        let f = at - floor;
        let first = (floor.z as usize * ny + floor.y as usize) * nx + floor.x as usize;
        Some(std::array::from_fn(|corner| {
            let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let side = |upper: usize, f: f32| if upper == 1 { f } else { 1.0 - f };
            (first + x + nx * (y + ny * z), side(x, f.x) * side(y, f.y) * side(z, f.z))
        }))
    }
}

/// Maps a float to an integer with the same order.
fn ordered(x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    if bits < 0 { bits ^ i32::MAX } else { bits }
}

/// Inverse of [`ordered`].
fn number(ordered: i32) -> f32 {
    f32::from_bits((if ordered < 0 { ordered ^ i32::MAX } else { ordered }) as u32)
}
