//! Matrix-free conjugate gradients for D M⁻¹ Dᵀ p = b with diagonal preconditioning.
//!
//! Each sum is computed per slab in f64, and the slabs are added in order, so the result is bitwise identical
//! for any number of threads. In each row of cells, only the span between the first and the last cell with
//! pressure is processed.

use super::grid_bounds::GridBounds;
use crate::parallel::prelude::*;
use glam::{IVec3, Vec3};
use std::ops::Range;

/// Residual at which a solve ends, relative to the right-hand side [1]. A twentieth of the divergence is not
/// visible.
pub const TOLERANCE: f64 = 0.05;

/// Pressure, relative to the root mean square, below which a cell is softened when cells with negative
/// pressure are released [1].
const RELEASE_PRESSURE: f32 = 0.1;

/// Maximum number of iterations of a solve. Effects that spread farther than this many cells are left to the
/// next interval.
pub const MAX_ITERATIONS: u32 = 24;

/// A linear system and its solution. All arrays have the shape of the grid's nodes.
#[derive(Default)]
pub struct Solve {
    bounds: GridBounds,
    /// Inverse mass of the nodes; 0 where there is no hair and where it cannot move.
    pub inverse_mass: Vec<f32>,
    /// Inverse diagonal; 0 in cells that have no pressure.
    inverse_diagonal: Vec<f32>,
    /// Compliance of each cell, added to the diagonal.
    compliance: Vec<f32>,
    right: Vec<f32>,
    residual: Vec<f32>,
    pressure: Vec<f32>,
    /// Pressures of the last system with its bounds; empty at the start of a frame.
    last: (GridBounds, Vec<f32>),
    direction: Vec<f32>,
    image: Vec<f32>,
    /// Components of M⁻¹ Dᵀ applied to the last operand.
    flux: [Vec<f32>; 3],
    /// Span of cells with pressure in each row; shape `[z][y]`.
    spans: Vec<Span>,
    /// Partial sums of the slabs.
    partial: Vec<f64>,
}

/// A range of cells in a row.
#[derive(Clone, Copy, Default)]
struct Span {
    from: u32,
    to: u32,
}

impl Span {
    /// Returns the smallest span that contains both.
    fn with(self, other: Self) -> Self {
        match (self.from < self.to, other.from < other.to) {
            (true, true) => Self { from: self.from.min(other.from), to: self.to.max(other.to) },
            (true, false) => self,
            _ => other,
        }
    }

    fn range(self) -> Range<usize> {
        self.from as usize..self.to as usize
    }
}

/// Returns the index ranges of the spans in a slab with rows of length `nx`.
fn indices(spans: &[Span], nx: usize) -> impl Iterator<Item = Range<usize>> {
    let there = spans.iter().enumerate().filter(|(_, span)| span.from < span.to);
    there.map(move |(y, span)| y * nx + span.from as usize..y * nx + span.to as usize)
}

impl Solve {
    /// Returns all arrays of floats.
    fn arrays(&mut self) -> [&mut Vec<f32>; 11] {
        let [fx, fy, fz] = &mut self.flux;
        [
            &mut self.inverse_mass,
            &mut self.inverse_diagonal,
            &mut self.compliance,
            &mut self.right,
            &mut self.residual,
            &mut self.pressure,
            &mut self.direction,
            &mut self.image,
            fx,
            fy,
            fz,
        ]
    }

    /// Reserves memory for at most `nodes` nodes.
    pub fn reserve(&mut self, nodes: usize) {
        self.arrays().into_iter().for_each(|array| array.reserve_exact(nodes));
        self.last.1.reserve_exact(nodes);
        // Because of its empty ring, a grid has at most a third as many rows as nodes.
        self.spans.reserve_exact(nodes / 3);
        self.partial.reserve_exact(nodes / 9);
    }

    /// Discards the warm start of the next system.
    pub fn clear(&mut self) {
        self.pressure.clear();
    }

    /// Starts a new system. Everything is 0 except for the pressures, which are those of the last system.
    pub fn begin(&mut self, bounds: GridBounds) {
        self.last.0 = self.bounds;
        std::mem::swap(&mut self.last.1, &mut self.pressure);
        self.bounds = bounds;
        self.arrays().into_par_iter().for_each(|array| {
            array.clear();
            array.resize(bounds.nodes(), 0.0);
        });
        self.spans.clear();
        self.spans.resize(bounds.dims[1] * bounds.dims[2], Span::default());
        self.partial.clear();
        self.partial.resize(bounds.dims[2], 0.0);
        let (before, last) = &self.last;
        if last.is_empty() {
            return;
        }
        // Copies the rows that both bounds share, over their common range of x.
        let (from, to) = (before.lo.max(bounds.lo), before.end().min(bounds.end()));
        let count = usize::try_from(to.x - from.x).unwrap_or(0);
        for (z, y) in (from.z..to.z).flat_map(|z| (from.y..to.y).map(move |y| (z, y))) {
            let row = IVec3::new(from.x, y, z);
            if let (Some(old), Some(new)) = (before.index(row), bounds.index(row)) {
                self.pressure[new..new + count].copy_from_slice(&last[old..old + count]);
            }
        }
    }

    /// Adds the cells for which `cell` returns a right-hand side and a hardness, above 0 and at most 1.
    /// Returns their number. A cell with a hardness below 1 is compliant: its diagonal is divided by the
    /// hardness, so a softer cell takes less part in the system.
    pub fn fill(&mut self, cell: impl Fn(usize) -> Option<(f32, f32)> + Sync) -> usize {
        let [nx, ny, nz] = self.bounds.dims;
        let (slab, corners, inverse_mass) = (nx * ny, self.bounds.corners(), &self.inverse_mass);
        let parts = self.inverse_diagonal.par_chunks_mut(slab).zip(self.right.par_chunks_mut(slab));
        let parts = parts.zip(self.pressure.par_chunks_mut(slab)).zip(self.compliance.par_chunks_mut(slab));
        let parts = parts.zip(self.spans.par_chunks_mut(ny)).enumerate();
        parts
            .map(|(z, ((((diagonal, right), pressure), compliance), spans))| {
                let mut cells = 0;
                // The last slab and the last row have no cells.
                let rows = if z + 1 < nz { ny - 1 } else { 0 };
                for (y, span) in spans.iter_mut().enumerate().take(rows) {
                    for x in 0..nx - 1 {
                        let (c, at) = (y * nx + x, z * slab + y * nx + x);
                        let Some((flow, hardness)) = cell(at) else { continue };
                        // Three axes, each ±1 at every corner.
                        let stiff: f32 = 3.0 * corners.iter().map(|k| inverse_mass[at + k]).sum::<f32>();
                        if stiff > 0.0 {
                            (diagonal[c], right[c]) = (hardness / stiff, flow);
                            compliance[c] = stiff * (1.0 / hardness - 1.0);
                            *span = span.with(Span { from: x as u32, to: x as u32 + 1 });
                            cells += 1;
                        }
                    }
                }
                // Cells that are no longer part of the system get zero pressure.
                let of_none = pressure.iter_mut().zip(diagonal).filter(|(_, diagonal)| **diagonal == 0.0);
                of_none.for_each(|(pressure, _)| *pressure = 0.0);
                cells
            })
            .sum()
    }

    /// Releases the cells with negative pressure and softens those with a small one. Returns the number of
    /// remaining cells. Softening prevents the rounding of a position from deciding whether a cell has
    /// pressure after others are released.
    pub fn let_go(&mut self) -> usize {
        let slab = self.bounds.slab();
        let (square, cells) = (
            self.sum(|s, k| f64::from(s.pressure[k]) * f64::from(s.pressure[k])),
            self.sum(|s, k| f64::from(u8::from(s.inverse_diagonal[k] > 0.0))),
        );
        let hard = RELEASE_PRESSURE * (square / cells.max(1.0)).sqrt() as f32;
        let parts = self.inverse_diagonal.par_chunks_mut(slab).zip(self.right.par_chunks_mut(slab));
        parts
            .zip(self.pressure.par_chunks_mut(slab).zip(self.compliance.par_chunks_mut(slab)))
            .map(|((diagonal, right), (pressure, compliance))| {
                let mut cells = 0;
                let rows = diagonal.iter_mut().zip(right).zip(pressure.iter_mut().zip(compliance));
                for ((diagonal, right), (pressure, compliance)) in rows {
                    if *pressure <= 0.0 {
                        (*diagonal, *right, *pressure) = (0.0, 0.0, 0.0);
                    } else if *pressure < hard {
                        let softer = hard / *pressure;
                        *compliance += (softer - 1.0) / *diagonal;
                        *diagonal /= softer;
                    }
                    cells += usize::from(*diagonal > 0.0);
                }
                cells
            })
            .sum()
    }

    /// Solves, starting from the current pressures. Returns the number of iterations and the residual
    /// relative to the right-hand side.
    pub fn run(&mut self) -> (u32, f64) {
        let [nx, ny, _] = self.bounds.dims;
        let slab = nx * ny;
        self.direction.copy_from_slice(&self.pressure);
        self.apply();
        let start = self.sum(|s, k| f64::from(s.right[k]) * f64::from(s.right[k]));
        if start <= 0.0 {
            return (0, 0.0);
        }
        let (mut energy, mut left) = (0.0, 1.0);
        for iteration in 0..=MAX_ITERATIONS {
            // In the first iteration, the image is that of the initial pressures and is subtracted entirely.
            let alpha = match iteration {
                0 => 1.0,
                _ => {
                    self.apply();
                    let curvature = self.sum(|s, k| f64::from(s.direction[k]) * f64::from(s.image[k]));
                    // No pressure can reduce the residual further.
                    if curvature <= 0.0 || energy <= 0.0 {
                        return (iteration, left);
                    }
                    (energy / curvature) as f32
                }
            };
            let step = if iteration == 0 { 0.0 } else { alpha };
            let (direction, image, right, spans) = (&self.direction, &self.image, &self.right, &self.spans);
            let parts =
                self.pressure.par_chunks_mut(slab).zip(self.residual.par_chunks_mut(slab)).enumerate();
            parts.for_each(|(z, (pressure, residual))| {
                let (from, spans) = (z * slab, &spans[z * ny..(z + 1) * ny]);
                for k in indices(spans, nx).flatten() {
                    let before = if iteration == 0 { right[from + k] } else { residual[k] };
                    pressure[k] += step * direction[from + k];
                    residual[k] = before - alpha * image[from + k];
                }
            });
            left = (self.sum(|s, k| f64::from(s.residual[k]) * f64::from(s.residual[k])) / start).sqrt();
            if left < TOLERANCE {
                return (iteration, left);
            }
            let next = self.sum(|s, k| {
                let r = s.residual[k];
                f64::from(r) * f64::from(r * s.inverse_diagonal[k])
            });
            let beta = if iteration == 0 { 0.0 } else { (next / energy) as f32 };
            energy = next;
            let (residual, diagonal, spans) = (&self.residual, &self.inverse_diagonal, &self.spans);
            self.direction.par_chunks_mut(slab).enumerate().for_each(|(z, direction)| {
                let (from, spans) = (z * slab, &spans[z * ny..(z + 1) * ny]);
                for k in indices(spans, nx).flatten() {
                    direction[k] = residual[from + k] * diagonal[from + k] + beta * direction[k];
                }
            });
        }
        (MAX_ITERATIONS, left)
    }

    /// Computes the flux of the pressures, with negative pressures clamped to 0.
    pub fn press(&mut self) {
        self.direction.par_iter_mut().zip(&self.pressure).for_each(|(out, p)| *out = p.max(0.0));
        self.apply();
    }

    /// Returns M⁻¹ Dᵀ p at node `n`, after [`Solve::press`].
    pub fn change(&self, n: usize) -> Vec3 {
        let [x, y, z] = &self.flux;
        Vec3::new(x[n], y[n], z[n])
    }

    /// Returns a sum over all cells with pressure.
    fn sum(&mut self, of: impl Fn(&Self, usize) -> f64 + Sync) -> f64 {
        let [nx, ny, _] = self.bounds.dims;
        let mut partial = std::mem::take(&mut self.partial);
        partial.par_iter_mut().enumerate().for_each(|(z, sum)| {
            let spans = &self.spans[z * ny..(z + 1) * ny];
            *sum = indices(spans, nx).flatten().map(|k| of(self, z * nx * ny + k)).sum();
        });
        self.partial = partial;
        self.partial.iter().sum()
    }

    /// Computes `flux` and `image` of `direction`.
    fn apply(&mut self) {
        let [nx, ny, nz] = self.bounds.dims;
        let (slab, spans, p) = (nx * ny, &self.spans, &self.direction);
        let [fx, fy, fz] = &mut self.flux;
        let parts = fx.par_chunks_mut(slab).zip(fy.par_chunks_mut(slab)).zip(fz.par_chunks_mut(slab));
        let parts = parts.zip(self.inverse_mass.par_chunks(slab)).enumerate();
        // Rayon's `skip` and `take` would allocate.
        parts.filter(|(z, _)| *z > 0).for_each(|(z, (((fx, fy), fz), inverse))| {
            for y in 1..ny {
                let near = [(y - 1, z - 1), (y, z - 1), (y - 1, z), (y, z)];
                let span = near.map(|(y, z)| spans[z * ny + y]).into_iter().fold(Span::default(), Span::with);
                if span.from >= span.to {
                    continue;
                }
                // The nodes at both ends of its cells; for each, the cells before and after it.
                let (from, count) = (span.from as usize, (span.to - span.from) as usize + 1);
                let first = y * nx + from;
                let before = near.map(|(y, z)| &p[z * slab + y * nx + from - 1..][..count]);
                let after = near.map(|(y, z)| &p[z * slab + y * nx + from..][..count]);
                let inverse = &inverse[first..][..count];
                let [fx, fy, fz] = [&mut *fx, &mut *fy, &mut *fz].map(|f| &mut f[first..first + count]);
                for x in 0..count {
                    let sum = [0, 1, 2, 3].map(|k| before[k][x] + after[k][x]);
                    let across = [0, 1, 2, 3].map(|k| before[k][x] - after[k][x]);
                    fx[x] = inverse[x] * ((across[0] + across[1]) + (across[2] + across[3]));
                    fy[x] = inverse[x] * ((sum[0] + sum[2]) - (sum[1] + sum[3]));
                    fz[x] = inverse[x] * ((sum[0] + sum[1]) - (sum[2] + sum[3]));
                }
            }
        });
        let [fx, fy, fz] = &self.flux;
        let parts = self.image.par_chunks_mut(slab).zip(self.inverse_diagonal.par_chunks(slab));
        let parts = parts.zip(self.compliance.par_chunks(slab)).enumerate();
        parts.filter(|(z, _)| z + 1 < nz).for_each(|(z, ((image, diagonal), compliance))| {
            for (y, span) in spans[z * ny..(z + 1) * ny].iter().enumerate().filter(|(_, s)| s.from < s.to) {
                let (from, count) = (y * nx + span.from as usize, span.range().len());
                let corners = [0, nx, slab, slab + nx].map(|corner| z * slab + from + corner);
                let rows = corners.map(|at| at..at + count + 1);
                let [x0, x1, x2, x3] = [0, 1, 2, 3].map(|k| &fx[rows[k].clone()]);
                let [y0, y1, y2, y3] = [0, 1, 2, 3].map(|k| &fy[rows[k].clone()]);
                let [z0, z1, z2, z3] = [0, 1, 2, 3].map(|k| &fz[rows[k].clone()]);
                let (image, diagonal) = (&mut image[from..from + count], &diagonal[from..from + count]);
                let (compliance, p) = (&compliance[from..from + count], &p[z * slab + from..][..count]);
                for x in 0..count {
                    let across = |row: &[f32]| row[x + 1] - row[x];
                    let sum = |row: &[f32]| row[x + 1] + row[x];
                    let along_x = (across(x0) + across(x1)) + (across(x2) + across(x3));
                    let along_y = (sum(y1) - sum(y0)) + (sum(y3) - sum(y2));
                    let along_z = (sum(z2) - sum(z0)) + (sum(z3) - sum(z1));
                    let out = along_x + along_y + along_z + compliance[x] * p[x];
                    image[x] = if diagonal[x] > 0.0 { out } else { 0.0 };
                }
            }
        });
    }
}
