//! Conjugate gradients for D M⁻¹ Dᵀ p = b, preconditioned by the diagonal; the matrix is never stored.
//!
//! Every sum is made slab by slab in f64 and the slabs' in their order, so any thread count gives the same bits.

use super::window::Window;
use glam::Vec3;
use rayon::prelude::*;

/// What is left of the residual when a solve ends, over the right-hand side [1]: a hundredth of the divergence is not seen.
const TOLERANCE: f64 = 0.01;

/// Most iterations of a solve; a head of hair of 30 cells across takes some 20 to 40.
const ITERATIONS: u32 = 60;

/// One system and its solution. All arrays have the shape of the window's nodes.
#[derive(Default)]
pub struct Solve {
    window: Window,
    /// Of the nodes; 0 where there is no hair and where it cannot move.
    pub inverse_mass: Vec<f32>,
    /// Inverse diagonal; 0 in cells that have no pressure.
    inverse_diagonal: Vec<f32>,
    /// Right-hand side, then the residual.
    residual: Vec<f32>,
    right: Vec<f32>,
    pressure: Vec<f32>,
    direction: Vec<f32>,
    image: Vec<f32>,
    /// M⁻¹ Dᵀ of what was applied last, a component each.
    flux: [Vec<f32>; 3],
    /// Whether a row of cells has any with pressure; shape `[z][y]`.
    rows: Vec<bool>,
    /// Sums of the slabs.
    partial: Vec<f64>,
}

impl Solve {
    /// Room for so many nodes ever.
    pub fn reserve(&mut self, nodes: usize) {
        let [fx, fy, fz] = &mut self.flux;
        let arrays = [
            &mut self.inverse_mass,
            &mut self.inverse_diagonal,
            &mut self.residual,
            &mut self.right,
            &mut self.pressure,
            &mut self.direction,
            &mut self.image,
            fx,
            fy,
            fz,
        ];
        arrays.into_iter().for_each(|array| array.reserve_exact(nodes));
        self.rows.reserve_exact(nodes);
        self.partial.reserve_exact(nodes);
    }

    /// A new system; what there was is gone.
    pub fn begin(&mut self, window: Window) {
        self.window = window;
        let nodes = window.nodes();
        let [fx, fy, fz] = &mut self.flux;
        for array in [
            &mut self.inverse_mass,
            &mut self.inverse_diagonal,
            &mut self.residual,
            &mut self.right,
            &mut self.pressure,
            &mut self.direction,
            &mut self.image,
            fx,
            fy,
            fz,
        ] {
            array.resize(nodes, 0.0);
        }
        self.rows.resize(window.dims[1] * window.dims[2], false);
        self.partial.resize(window.dims[2], 0.0);
    }

    /// Takes up the cells of which `flow` has a right-hand side; how many they are.
    pub fn fill(&mut self, flow: impl Fn(usize) -> Option<f32> + Sync) -> usize {
        let [nx, ny, nz] = self.window.dims;
        let (slab, corners, inverse_mass) = (nx * ny, self.window.corners(), &self.inverse_mass);
        let parts = self.inverse_diagonal.par_chunks_mut(slab).zip(self.right.par_chunks_mut(slab));
        let parts = parts.zip(self.rows.par_chunks_mut(ny)).enumerate();
        parts
            .map(|(z, ((diagonal, right), rows))| {
                diagonal.fill(0.0);
                right.fill(0.0);
                rows.fill(false);
                if z + 1 >= nz {
                    return 0;
                }
                let mut cells = 0;
                for (y, row) in rows.iter_mut().enumerate().take(ny - 1) {
                    for x in 0..nx - 1 {
                        let (c, cell) = (y * nx + x, z * slab + y * nx + x);
                        let Some(flow) = flow(cell) else { continue };
                        let sum: f32 = corners.iter().map(|k| inverse_mass[cell + k]).sum();
                        if sum > 0.0 {
                            // Three axes, each ±1 at every corner.
                            (diagonal[c], right[c], *row) = (1.0 / (3.0 * sum), flow, true);
                            cells += 1;
                        }
                    }
                }
                cells
            })
            .sum()
    }

    /// Lets go of the cells that pull; how many are left.
    pub fn let_go(&mut self) -> usize {
        let slab = self.window.slab();
        let parts = self.inverse_diagonal.par_chunks_mut(slab).zip(self.right.par_chunks_mut(slab));
        parts
            .zip(self.pressure.par_chunks(slab))
            .map(|((diagonal, right), pressure)| {
                let mut cells = 0;
                for ((diagonal, right), pressure) in diagonal.iter_mut().zip(right).zip(pressure) {
                    if *pressure <= 0.0 {
                        (*diagonal, *right) = (0.0, 0.0);
                    }
                    cells += usize::from(*diagonal > 0.0);
                }
                cells
            })
            .sum()
    }

    /// Solves from 0: iterations taken and what is left of the residual over the right-hand side.
    pub fn run(&mut self) -> (u32, f64) {
        let slab = self.window.slab();
        self.pressure.fill(0.0);
        self.residual.copy_from_slice(&self.right);
        let of = |a: &[f32], b: &[f32], partial: &mut [f64]| dot(slab, a, b, partial);
        let start = of(&self.right, &self.right, &mut self.partial);
        if start <= 0.0 {
            return (0, 0.0);
        }
        let preconditioned = |out: &mut [f32], residual: &[f32], diagonal: &[f32], beta: f32| {
            let parts = out.par_chunks_mut(slab).zip(residual.par_chunks(slab)).zip(diagonal.par_chunks(slab));
            parts.for_each(|((out, r), d)| {
                for ((out, r), d) in out.iter_mut().zip(r).zip(d) {
                    *out = r * d + beta * *out;
                }
            });
        };
        preconditioned(&mut self.direction, &self.residual, &self.inverse_diagonal, 0.0);
        let mut energy = of(&self.residual, &self.direction, &mut self.partial);
        let mut left = 1.0;
        for iteration in 1..=ITERATIONS {
            self.apply();
            let curvature = of(&self.direction, &self.image, &mut self.partial);
            // What no pressure can change is left.
            if curvature <= 0.0 || energy <= 0.0 {
                return (iteration, left);
            }
            let alpha = (energy / curvature) as f32;
            let parts = self.pressure.par_chunks_mut(slab).zip(self.residual.par_chunks_mut(slab));
            let parts = parts.zip(self.direction.par_chunks(slab).zip(self.image.par_chunks(slab)));
            let parts = parts.zip(self.inverse_diagonal.par_chunks(slab)).zip(self.partial.par_iter_mut());
            parts.for_each(|((((p, r), (d, image)), diagonal), sum)| {
                for ((p, r), (d, image)) in p.iter_mut().zip(r.iter_mut()).zip(d.iter().zip(image)) {
                    *p += alpha * d;
                    *r -= alpha * image;
                }
                *sum = r.iter().zip(diagonal).map(|(r, d)| f64::from(*r) * f64::from(*r * d)).sum();
            });
            let next: f64 = self.partial.iter().sum();
            left = (of(&self.residual, &self.residual, &mut self.partial) / start).sqrt();
            if left < TOLERANCE {
                return (iteration, left);
            }
            preconditioned(&mut self.direction, &self.residual, &self.inverse_diagonal, (next / energy) as f32);
            energy = next;
        }
        (ITERATIONS, left)
    }

    /// Leaves the flux of the pressures, without what still pulls.
    pub fn press(&mut self) {
        let parts = self.direction.par_iter_mut().zip(&self.pressure).zip(&self.inverse_diagonal);
        parts.for_each(|((out, p), d)| *out = if *d > 0.0 { p.max(0.0) } else { 0.0 });
        self.apply();
    }

    /// M⁻¹ Dᵀ p at node `n`, after [`Solve::press`].
    pub fn change(&self, n: usize) -> Vec3 {
        let [x, y, z] = &self.flux;
        Vec3::new(x[n], y[n], z[n])
    }

    /// `flux` and `image` of `direction`.
    fn apply(&mut self) {
        let [nx, ny, nz] = self.window.dims;
        let (slab, rows, p) = (nx * ny, &self.rows, &self.direction);
        let [fx, fy, fz] = &mut self.flux;
        let active = |y: usize, z: usize| y < ny && z < nz && rows[z * ny + y];
        let parts = fx.par_chunks_mut(slab).zip(fy.par_chunks_mut(slab)).zip(fz.par_chunks_mut(slab));
        let parts = parts.zip(self.inverse_mass.par_chunks(slab)).enumerate().skip(1);
        parts.for_each(|(z, (((fx, fy), fz), inverse))| {
            for y in 1..ny {
                let of = y * nx..(y + 1) * nx;
                let [fx, fy, fz] = [&mut fx[of.clone()], &mut fy[of.clone()], &mut fz[of.clone()]];
                let near = [(y - 1, z - 1), (y, z - 1), (y - 1, z), (y, z)];
                if !near.into_iter().any(|(y, z)| active(y, z)) {
                    [fx, fy, fz].into_iter().for_each(|row| row.fill(0.0));
                    continue;
                }
                let [a, b, c, d] = near.map(|(y, z)| &p[z * slab + y * nx..][..nx]);
                let inverse = &inverse[of];
                for x in 1..nx {
                    let sum = |row: &[f32]| row[x - 1] + row[x];
                    let (a2, b2, c2, d2) = (sum(a), sum(b), sum(c), sum(d));
                    let across = |row: &[f32]| row[x - 1] - row[x];
                    fx[x] = inverse[x] * (across(a) + across(b) + across(c) + across(d));
                    fy[x] = inverse[x] * ((a2 + c2) - (b2 + d2));
                    fz[x] = inverse[x] * ((a2 + b2) - (c2 + d2));
                }
            }
        });
        let [fx, fy, fz] = &self.flux;
        let parts = self.image.par_chunks_mut(slab).zip(self.inverse_diagonal.par_chunks(slab)).enumerate();
        parts.for_each(|(z, (image, diagonal))| {
            for y in 0..ny {
                let out = &mut image[y * nx..(y + 1) * nx];
                if !active(y, z) {
                    out.fill(0.0);
                    continue;
                }
                let row = |f: &'_ Vec<f32>, dy: usize, dz: usize| {
                    let first = (z + dz) * slab + (y + dy) * nx;
                    first..(first + nx).min(f.len())
                };
                let [x0, x1, x2, x3] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dy, dz)| &fx[row(fx, dy, dz)]);
                let [y0, y1, y2, y3] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dy, dz)| &fy[row(fy, dy, dz)]);
                let [z0, z1, z2, z3] = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dy, dz)| &fz[row(fz, dy, dz)]);
                let diagonal = &diagonal[y * nx..(y + 1) * nx];
                for x in 0..nx - 1 {
                    let across = |row: &[f32]| row[x + 1] - row[x];
                    let sum = |row: &[f32]| row[x + 1] + row[x];
                    let flow = across(x0) + across(x1) + across(x2) + across(x3) - sum(y0) + sum(y1) - sum(y2)
                        + sum(y3)
                        - sum(z0)
                        - sum(z1)
                        + sum(z2)
                        + sum(z3);
                    out[x] = if diagonal[x] > 0.0 { flow } else { 0.0 };
                }
            }
        });
    }
}

/// The scalar product of two arrays.
fn dot(slab: usize, a: &[f32], b: &[f32], partial: &mut [f64]) -> f64 {
    let parts = a.par_chunks(slab).zip(b.par_chunks(slab)).zip(partial.par_iter_mut());
    parts.for_each(|((a, b), sum)| *sum = a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum());
    partial.iter().sum()
}
