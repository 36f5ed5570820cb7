//! Sign repair for rows of nodes that pass through a hole in the mesh. Counting crossings along such a row
//! would mark everything behind the hole as inside.
//!
//! ```text
//!     ┌──────┐  neighboring row: enters once, leaves once
//!     │ ▓▓▓▓ │
//!   ──│▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓▓   row through a hole on the far side: never leaves, and would be a wall in the air
//!     │ ▓▓▓▓ │
//! ```
//!
//! If either of two adjacent nodes is more than half a cell from every triangle, no surface passes between
//! them, so both have the same sign. Rows next to a row with known signs copy them, one row after the other.
//! Nodes near a surface keep the sign from counting.

use super::{SignedDistanceField, deep_interior};

/// Rows of a field that pass through holes of its mesh. Its buffers are reused.
#[derive(Default)]
pub(super) struct Holes {
    /// Rows whose signs are not known yet: layer, row.
    open: Vec<[u32; 2]>,
    /// Whether the signs of a row are known, layer after layer.
    known: Vec<bool>,
    /// Runs of deep nodes: layer, row, first and end.
    deep: Vec<[u32; 4]>,
}

impl Holes {
    /// Corrects the signs of the `open` rows of `grid` (layer, row) from the rows next to them. Returns, in
    /// order, the runs of nodes deeper than the band in these rows, together with the `closed` runs.
    pub fn mend(
        &mut self,
        grid: &mut SignedDistanceField,
        open: impl Iterator<Item = [u32; 2]>,
        closed: impl Iterator<Item = [u32; 4]>,
    ) -> &[[u32; 4]] {
        let Self { open: rows, known, deep: runs } = self;
        rows.clear();
        rows.extend(open);
        runs.clear();
        runs.extend(closed);
        if rows.is_empty() {
            return runs;
        }
        let [nx, ny, nz] = grid.size().to_array().map(|n| n as usize);
        let row = |[z, y]: [u32; 2]| z as usize * ny + y as usize;
        known.clear();
        known.resize(ny * nz, true);
        rows.iter().for_each(|at| known[row(*at)] = false);
        let mut left = rows.len() + 1;
        while rows.len() < left {
            left = rows.len();
            rows.retain(|&at| {
                let [z, y] = at.map(|i| i as usize);
                let beside = [
                    (y > 0).then(|| z * ny + y - 1),
                    (y + 1 < ny).then(|| z * ny + y + 1),
                    (z > 0).then(|| (z - 1) * ny + y),
                    (z + 1 < nz).then(|| (z + 1) * ny + y),
                ];
                let beside = beside.map(|row| row.filter(|row| known[*row]));
                if beside == [None; 4] {
                    return true;
                }
                take_after(grid, row(at) * nx, beside.map(|row| row.map(|row| row * nx)));
                deep_interior::push(at, &grid.distances[row(at) * nx..][..nx], grid.cell(), runs);
                known[row(at)] = true;
                false
            });
        }
        for &at in &*rows {
            deep_interior::push(at, &grid.distances[row(at) * nx..][..nx], grid.cell(), runs);
        }
        runs.sort_unstable();
        runs
    }
}

/// Gives the nodes of the row that starts at node `row` the sign of the majority of the rows `beside` it.
fn take_after(grid: &mut SignedDistanceField, row: usize, beside: [Option<usize>; 4]) {
    let far = 0.5 * grid.cell();
    for x in 0..grid.size().x as usize {
        let d = grid.distances[row + x].abs();
        let sides = beside.iter().flatten().map(|row| grid.distances[row + x]);
        let side: i32 = sides.filter(|d| d.abs() > far).map(|d| if d > 0.0 { 1 } else { -1 }).sum();
        if d > far && side != 0 {
            grid.distances[row + x] = d * side.signum() as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::collide::voxelize;
    use glam::Vec3;

    /// A box of 10 cm with a slit of 3 mm in its far face. One layer of nodes passes through the slit.
    #[test]
    fn points_behind_a_slit_are_outside() {
        let at = |x: f32, y: f32, z: f32| 0.1 * Vec3::new(x, y, z);
        let (low, high) = (0.51, 0.54);
        let quads = [
            [at(0., 0., 0.), at(0., 0., 1.), at(0., 1., 1.), at(0., 1., 0.)],
            [at(0., 0., 0.), at(1., 0., 0.), at(1., 0., 1.), at(0., 0., 1.)],
            [at(0., 1., 0.), at(0., 1., 1.), at(1., 1., 1.), at(1., 1., 0.)],
            [at(0., 0., 0.), at(0., 1., 0.), at(1., 1., 0.), at(1., 0., 0.)],
            [at(0., 0., 1.), at(1., 0., 1.), at(1., 1., 1.), at(0., 1., 1.)],
            [at(1., 0., 0.), at(1., 1., 0.), at(1., 1., low), at(1., 0., low)],
            [at(1., 0., high), at(1., 1., high), at(1., 1., 1.), at(1., 0., 1.)],
        ];
        let triangles: Vec<[u32; 3]> =
            (0..7).map(|q| 4 * q).flat_map(|q| [[q, q + 1, q + 2], [q, q + 2, q + 3]]).collect();
        let grid = voxelize(&quads.concat(), &triangles, 0.005);
        let z = 0.0525;
        for x in [0.106, 0.108, 0.11] {
            let d = grid.distance_and_normal(Vec3::new(x, 0.05, z)).0;
            assert!(d > 0.004, "{d} m at {x} behind the slit");
        }
        assert!(grid.distance_and_normal(Vec3::new(0.05, 0.05, z)).0 < -0.02, "the box is hollow");
    }
}
