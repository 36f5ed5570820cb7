//! The part of the lattice that holds the hair of this frame, and where eight points lie in it.
//!
//! The lattice is fixed to the anchor (the head), so that hair that is carried along lies in the same cells in every pose, and what was
//! measured at rest can be told cell by cell. A cell has the index of its lowest corner, a node of the lattice.

use crate::{
    math::RigidTransform,
    simd::lanes::{LANES, Row},
    strand::tile::{StateRows, StrandRows, state, strand},
};
use glam::{IVec3, Mat3, Vec3};

/// A box of nodes, x fastest. A ring of cells around its hair is empty: no sum over a cell's or a node's neighbours looks past the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridBounds {
    /// Its lowest node on the lattice.
    pub lo: IVec3,
    /// Nodes along x, y, z.
    pub dims: [usize; 3],
}

impl GridBounds {
    /// The window of hair between `lo` and `hi` [cells].
    pub fn around(lo: Vec3, hi: Vec3) -> Self {
        let lo = lo.floor().as_ivec3() - 2;
        let dims = (hi.floor().as_ivec3() - lo + 4).to_array().map(|n| n.max(0) as usize);
        Self { lo, dims }
    }

    /// The node after its highest along every axis.
    pub fn end(&self) -> IVec3 {
        self.lo + IVec3::from(self.dims.map(|n| n as i32))
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.dims.iter().product()
    }

    /// Nodes in a slab of one z.
    pub fn slab(&self) -> usize {
        self.dims[0] * self.dims[1]
    }

    /// From a node to the eight corners of the cell that has its index; x, then y, then z.
    pub fn corners(&self) -> [usize; 8] {
        let (row, slab) = (self.dims[0], self.slab());
        [0, 1, row, row + 1, slab, slab + 1, slab + row, slab + row + 1]
    }

    /// The index of a node or cell of the lattice; `None`: it is not inside.
    pub fn index(&self, at: IVec3) -> Option<usize> {
        let [x, y, z] = (at - self.lo).to_array().map(|k| usize::try_from(k).unwrap_or(usize::MAX));
        let [nx, ny, nz] = self.dims;
        (x < nx && y < ny && z < nz).then(|| (z * ny + y) * nx + x)
    }

    /// The lattice coordinates of an index.
    pub fn place(&self, index: usize) -> IVec3 {
        let [nx, ny, _] = self.dims;
        self.lo + IVec3::new((index % nx) as i32, (index / nx % ny) as i32, (index / nx / ny) as i32)
    }
}

/// How points are taken to the lattice: turned with the anchor, in cells.
#[derive(Clone, Copy)]
pub struct GridTransform {
    /// World axes to the anchor's, over the cell [1/m].
    turn: Mat3,
    /// Over the cell [1/m].
    scale: f32,
    /// The part of their way in a frame that roots have gone [1].
    gone: f32,
}

impl GridTransform {
    /// With cells of `cell` [m], where the anchor is at `anchor` and roots are at the end of their way.
    pub fn new(anchor: &RigidTransform, cell: f32) -> Self {
        Self::on_the_way(anchor, cell, 1.0)
    }

    /// The same where roots have gone a part of their way.
    pub fn on_the_way(anchor: &RigidTransform, cell: f32, gone: f32) -> Self {
        let scale = 1.0 / cell;
        Self { turn: Mat3::from_quat(anchor.rotation).transpose() * scale, scale, gone }
    }

    /// Roots of eight strands, from the node `from` [cells].
    pub fn roots(&self, rows: &StrandRows, from: IVec3) -> [[f32; LANES]; 3] {
        let from = from.as_vec3().to_array();
        std::array::from_fn(|k| {
            let [start, end] = [strand::ROOT_START, strand::ROOT_END].map(|at| &rows[at + k].0);
            std::array::from_fn(|lane| {
                (start[lane] * (1.0 - self.gone) + end[lane] * self.gone) * self.scale - from[k]
            })
        })
    }

    /// Takes eight places [cells] from a point of their strands to the next.
    #[inline(always)]
    pub fn walk(&self, places: &mut [[f32; LANES]; 3], next: &StateRows) {
        let [Row(x), Row(y), Row(z)] =
            &next[state::EDGE..].first_chunk::<3>().expect("an edge is three rows");
        let [a, b, c] = [self.turn.x_axis, self.turn.y_axis, self.turn.z_axis].map(|axis| axis.to_array());
        for (k, row) in places.iter_mut().enumerate() {
            for lane in 0..LANES {
                row[lane] += a[k] * x[lane] + b[k] * y[lane] + c[k] * z[lane];
            }
        }
    }
}

/// Eight points in a window.
pub struct Placed {
    /// Lowest corner of each one's cell.
    pub cell: [i32; LANES],
    /// Share of each point in the eight corners of its cell (trilinear), in the order of [`Window::corners`] [1].
    pub weights: [[f32; LANES]; 8],
    /// 1 for points that are inside, 0 for those that are not and those that are not finite.
    pub inside: [f32; LANES],
}

/// Added to a number below 2²² and taken away again, this rounds it to the nearest whole one; the bits in between hold that number.
pub const ROUND: f32 = 1.5 * (1 << 23) as f32;

/// The whole number nearest to `x`, below 2²² in size.
#[inline(always)]
pub fn nearest(x: f32) -> i32 {
    ((x + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

impl Placed {
    /// Where points [cells, from the window's lowest node] are.
    #[inline(always)]
    pub fn new(points: &[[f32; LANES]; 3], window: &GridBounds) -> Self {
        let strides = [1, window.dims[0] as i32, window.slab() as i32];
        let (mut cell, mut inside) = ([0; LANES], [1.0; LANES]);
        let mut f = [[0.0; LANES]; 3];
        for k in 0..3 {
            let last = (window.dims[k] - 2) as f32;
            for lane in 0..LANES {
                let at = points[k][lane];
                // Comparisons that a NaN fails.
                let low = if at > 0.0 { at } else { 0.0 };
                let clamped = if low < last { low } else { last };
                inside[lane] = if at == clamped { inside[lane] } else { 0.0 };
                // A point on a node may count to the cell before it, with all of its weight at that node.
                let floor = (clamped - 0.5 + ROUND) - ROUND;
                f[k][lane] = clamped - floor;
                cell[lane] += nearest(floor) * strides[k];
            }
        }
        let mut weights = [[0.0; LANES]; 8];
        for lane in 0..LANES {
            let [x, y, z] = [f[0][lane], f[1][lane], f[2][lane]];
            let (u, v, w) = (1.0 - x, 1.0 - y, 1.0 - z);
            for (k, yz) in [v * w, y * w, v * z, y * z].into_iter().enumerate() {
                weights[2 * k][lane] = u * yz;
                weights[2 * k + 1][lane] = x * yz;
            }
        }
        Self { cell, weights, inside }
    }
}
