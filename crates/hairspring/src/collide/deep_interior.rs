//! Distances deep inside a closed mesh, beyond the band of exact distances.

use super::{SignedDistanceField, lattice::Lattice, voxelize::BAND};

/// Extends the distances beyond the band, through `runs` of deeper nodes in a row, in order (layer, row,
/// first and end). Every second node along each axis is computed by one round of fast sweeping for |∇d| = 1
/// (Zhao 2005); the nodes between are interpolated. This accuracy is enough, because so deep only the
/// direction out matters.
pub(super) fn extend(
    grid: &mut SignedDistanceField,
    runs: impl DoubleEndedIterator<Item = [u32; 4]> + Clone,
) {
    let SignedDistanceField { distances: d, lattice: Lattice { size, cell, .. }, .. } = grid;
    let [nx, ny, nz] = size.to_array().map(|n| n as usize);
    let h = 2.0 * *cell;
    // A value deeper than any depth in the grid.
    let far = -((nx + ny + nz) as f32 * *cell);
    let runs = || runs.clone().map(|run| run.map(|i| i as usize));
    for [z, y, first, end] in runs() {
        let row = (z * ny + y) * nx;
        d[row + first..row + end].fill(far);
    }
    let update = |d: &mut [f32], [z, y, x]: [usize; 3]| {
        let i = (z * ny + y) * nx + x;
        // The nearer of the two neighbors on each axis, as positive depths. If the grid cuts through the
        // mesh, inside nodes on its border have only one neighbor.
        let axis = |at: usize, n: usize, stride: usize| {
            let before = if at >= 2 { d[i - 2 * stride] } else { far };
            -before.max(if at + 2 < n { d[i + 2 * stride] } else { far })
        };
        let [a, b, c] = [axis(x, nx, 1), axis(y, ny, nx), axis(z, nz, nx * ny)];
        let (low, high) = (a.min(b), a.max(b));
        let [a, b, c] = [low.min(c), high.min(c).max(low), high.max(c)];
        let mut u = a + h;
        if u > b {
            u = 0.5 * (a + b + (2.0 * h * h - (a - b) * (a - b)).max(0.0).sqrt());
            if u > c {
                let s = a + b + c;
                let q = s * s - 3.0 * (a * a + b * b + c * c - h * h);
                u = (s + q.max(0.0).sqrt()) * (1.0 / 3.0);
            }
        }
        d[i] = d[i].max(-u);
    };
    let even = |first: usize, end: usize| (first.next_multiple_of(2)..end).step_by(2);
    let coarse = |run: &[usize; 4]| run[0].is_multiple_of(2) && run[1].is_multiple_of(2);
    for [z, y, first, end] in runs().filter(coarse) {
        even(first, end).for_each(|x| update(d, [z, y, x]));
    }
    for [z, y, first, end] in runs().rev().filter(coarse) {
        even(first, end).rev().for_each(|x| update(d, [z, y, x]));
    }

    // Interpolate the nodes between: along x, then y, then z. All neighbors of a deep node are inside.
    for [z, y, first, end] in runs().filter(coarse) {
        let row = (z * ny + y) * nx;
        for x in (first | 1..end).step_by(2) {
            d[row + x] = 0.5 * (d[row + x - 1] + d[row + (x + 1).min(nx - 1) / 2 * 2]);
        }
    }
    let mut between = |z: usize, y: usize, first: usize, end: usize, [above, below]: [usize; 2]| {
        let row = (z * ny + y) * nx;
        for x in first..end {
            d[row + x] = 0.5 * (d[above * nx + x] + d[below * nx + x]);
        }
    };
    for [z, y, first, end] in runs().filter(|run| run[0].is_multiple_of(2) && run[1] % 2 == 1) {
        between(z, y, first, end, [z * ny + y - 1, z * ny + (y + 1).min(ny - 1) / 2 * 2]);
    }
    for [z, y, first, end] in runs().filter(|run| run[0] % 2 == 1) {
        between(z, y, first, end, [(z - 1) * ny + y, (z + 1).min(nz - 1) / 2 * 2 * ny + y]);
    }
    // All of these nodes are at least as deep as the band is wide.
    for [z, y, first, end] in runs() {
        let row = (z * ny + y) * nx;
        d[row + first..row + end].iter_mut().for_each(|d| *d = d.min(-BAND * *cell));
    }
}

/// Adds the runs of nodes in the `distances` of a row (layer, row) that are deeper than the band, before
/// their depths are computed.
pub(super) fn push([z, y]: [u32; 2], distances: &[f32], cell: f32, deep: &mut Vec<[u32; 4]>) {
    let known = -(BAND - 0.01) * cell;
    let mut first = 0;
    for run in distances.chunk_by(|a, b| (*a <= known) == (*b <= known)) {
        let end = first + run.len() as u32;
        if run[0] <= known {
            deep.push([z, y, first, end]);
        }
        first = end;
    }
}
