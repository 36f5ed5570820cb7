//! Finds the cell of a regular lattice that contains a point, for one point and for eight.

use crate::simd::lanes::{F, LANES, Row, Simd, V3, store};
use glam::{UVec3, Vec3};

/// Maximum number of nodes of a lattice. Node indices are computed in `f32`, which represents all integers up
/// to here.
pub(super) const MAX_NODES: usize = 1 << 23;

/// A regular lattice of nodes. A cell is identified by the index of its lower node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Lattice {
    /// Position of node (0, 0, 0) [m].
    pub origin: Vec3,
    /// Distance between adjacent nodes [m].
    pub cell: f32,
    /// Nodes along each axis, each 2 or more.
    pub size: UVec3,
    /// Precomputed for `locate_lanes`: the largest point inside, just below the last nodes [cells], the last
    /// cell, and the number of nodes in a row and of rows in a layer.
    top: Vec3,
    last: Vec3,
    rows: [f32; 2],
}

impl Lattice {
    /// Creates a lattice of `size` nodes, each 2 or more.
    pub fn new(origin: Vec3, cell: f32, size: UVec3) -> Self {
        let (top, last) = ((size - UVec3::ONE).as_vec3() - Vec3::splat(1e-3), (size - 2).as_vec3());
        Self { origin, cell, size, top, last, rows: [size.x as f32, size.y as f32] }
    }

    /// Creates a lattice that covers the box from `lo` to `hi` [m] and `margin` cells around it, with cells
    /// of `cell` [m]. If this would take more than `most` nodes, the cell is enlarged by a power of 1.1.
    pub fn covering(lo: Vec3, hi: Vec3, margin: f32, cell: f32, most: usize) -> Self {
        let mut cell = cell.max(f32::MIN_POSITIVE);
        while ((hi - lo) / cell + (2.0 * margin + 2.0)).element_product() > most as f32 {
            cell *= 1.1;
        }
        let margin = Vec3::splat(margin * cell);
        let cells = ((hi - lo + 2.0 * margin) / cell).ceil().as_uvec3();
        Self::new(lo - margin, cell, cells.max(UVec3::ONE) + UVec3::ONE)
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.size.as_usizevec3().element_product()
    }

    /// Returns the index of a node, x fastest.
    pub fn index(&self, at: UVec3) -> usize {
        ((at.z * self.size.y + at.y) * self.size.x + at.x) as usize
    }

    /// Clamps `p` [m] to the lattice. Returns the offset of `p` from the clamped point, the cell of that
    /// point, and its offset from the cell's lower node, all in cells.
    pub fn locate(&self, p: Vec3) -> (Vec3, UVec3, Vec3) {
        let g = (p - self.origin) / self.cell;
        // `max` comes first, so that a NaN becomes 0.
        let c = g.max(Vec3::ZERO).min(self.top);
        let cell = c.as_uvec3().min(self.size - 2);
        (g - c, cell, c - cell.as_vec3())
    }

    /// [`Lattice::locate`] for eight points. Cells are returned by their index.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn locate_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (V3<S>, [usize; LANES], V3<S>) {
        let (top, last) = (self.top, self.last);
        let g = (p - V3::splat(simd, self.origin)) * F::splat(simd, 1.0 / self.cell);
        let c = V3 {
            x: g.x.max_precise(0.0).min(top.x),
            y: g.y.max_precise(0.0).min(top.y),
            z: g.z.max_precise(0.0).min(top.z),
        };
        let cell = V3 { x: c.x.floor().min(last.x), y: c.y.floor().min(last.y), z: c.z.floor().min(last.z) };
        let [nx, ny] = self.rows;
        // From this value on the spacing of `f32` is 1, so the low bits of its pattern are the index. This
        // avoids converting lane by lane.
        let index = cell.z.mul_add(ny, cell.y).mul_add(nx, cell.x) + MAX_NODES as f32;
        let mut row = Row::default();
        store(index, &mut row);
        (g - c, row.0.map(|index| index.to_bits() as usize & (MAX_NODES - 1)), c - cell)
    }
}
