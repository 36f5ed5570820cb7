//! Optical depth toward a lamp, for every voxel at once.
//!
//! Yuksel & Keyser 2008 ("Deep Opacity Maps") store the amount of hair in front of each depth along the
//! light's rays. Here the same sum is propagated through the density grid slice by slice, away from the lamp.
//! Each voxel adds its own density to the value of the previous slice, interpolated bilinearly where its ray
//! crosses that slice. There are no visible layers, and the cost is one pass over the grid for a lamp of any
//! direction. The slight widening of the shadow from slice to slice acts as a penumbra.

use super::density::Grid;
use fearless_simd::{f32x8, prelude::*};
use glam::Vec3;

/// How one direction is swept through a grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sweep {
    /// Weights of four voxels of the previous slice: the first, the next in the row, the one in the next row,
    /// and the diagonal one.
    pub weights: [f32; 4],
    /// Offset in memory to the first of them, in voxels.
    pub offset: isize,
    /// Strides in memory: along a row, to the next row, to the next slice.
    pub side: usize,
    pub across: usize,
    pub along: usize,
    /// First and past-the-end voxel of a row, and row of a slice, whose four neighbors are in the grid. The
    /// rest is padding and stays clear.
    pub row: [usize; 2],
    pub rows: [usize; 2],
    /// Number of slices, and whether they are traversed from the last one.
    pub slices: usize,
    pub down: bool,
    /// Length of a ray from slice to slice [voxels].
    pub length: f32,
}

impl Sweep {
    /// A sweep toward `direction`; `None` if the direction has no length, so that there is nothing to sweep.
    pub fn new(grid: &Grid, direction: Vec3) -> Option<Self> {
        let unit = direction.try_normalize()?;
        let strides = [1, grid.size[0], grid.size[0] * grid.size[1]];
        let d = unit.to_array();
        let axis = (0..3).max_by(|a, b| d[*a].abs().total_cmp(&d[*b].abs())).unwrap_or(0);
        let (u, v) = if axis == 0 {
            (1, 2)
        } else if axis == 1 {
            (0, 2)
        } else {
            (0, 1)
        };
        // Per slice toward the lamp, the ray moves by (du, dv) voxels and covers `length` voxels.
        let length = 1.0 / d[axis].abs();
        let (du, dv) = (d[u] * length, d[v] * length);
        let (iu, iv) = (du.floor(), dv.floor());
        let (fu, fv) = (du - iu, dv - iv);
        let (su, sv) = (strides[u] as isize, strides[v] as isize);
        let toward = if d[axis] > 0.0 { strides[axis] as isize } else { -(strides[axis] as isize) };
        let inside = |n: usize, i: f32| {
            [(-i).max(0.0) as usize, (n as isize - 1 - i.max(0.0) as isize - 1).max(0) as usize]
        };
        Some(Self {
            weights: [(1.0 - fu) * (1.0 - fv), fu * (1.0 - fv), (1.0 - fu) * fv, fu * fv],
            offset: toward + iu as isize * su + iv as isize * sv,
            side: strides[u],
            across: strides[v],
            along: strides[axis],
            row: inside(grid.size[u], iu),
            rows: inside(grid.size[v], iv),
            slices: grid.size[axis],
            down: d[axis] > 0.0,
            length,
        })
    }
}

/// Fills `depth` with the optical depth from each voxel's center toward `direction`. Must be called inside a
/// `dispatch!`.
#[inline(always)]
pub(crate) fn sweep<S: Simd>(simd: S, grid: &Grid, density: &[f32], direction: Vec3, depth: &mut Vec<f32>) {
    depth.clear();
    depth.resize(density.len(), 0.0);
    let Some(sweep) = Sweep::new(grid, direction) else {
        return;
    };
    let Sweep { weights, offset, side, across, length, .. } = sweep;
    let ([u0, u1], [v0, v1], n) = (sweep.row, sweep.rows, sweep.slices);
    for k in 1..n {
        let slice = if sweep.down { n - 1 - k } else { k };
        for j in v0..v1 {
            let row = slice * sweep.along + j * across;
            let mut i = u0;
            // Eight adjacent voxels at a time, unless the light falls along x. The row that they read is a
            // different one.
            while side == 1 && i + 8 <= u1 {
                let at = row + i;
                let from = (at as isize + offset) as usize;
                let here = f32x8::from_slice(simd, &density[at..at + 8]);
                let (mut before, mut there) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 0.0));
                for (w, f) in weights.into_iter().zip([from, from + 1, from + across, from + 1 + across]) {
                    before += f32x8::from_slice(simd, &depth[f..f + 8]) * w;
                    there += f32x8::from_slice(simd, &density[f..f + 8]) * w;
                }
                (before + (here + there) * (0.5 * length)).store_slice(&mut depth[at..at + 8]);
                i += 8;
            }
            for i in i..u1 {
                let at = row + i * side;
                let from = (at as isize + offset) as usize;
                let (mut before, mut there) = (0.0, 0.0);
                for (w, f) in weights.iter().zip([from, from + side, from + across, from + side + across]) {
                    before += w * depth[f];
                    there += w * density[f];
                }
                depth[at] = before + 0.5 * length * (density[at] + there);
            }
        }
    }
}
