//! The part of the grid that holds the hair of a frame, and the positions of eight points in it.
//!
//! The grid is fixed to the anchor (the head). Hair that moves with it stays in the same cells in every pose,
//! so that measurements at rest apply cell by cell. A cell is identified by its lowest corner, a node of the
//! grid.

use crate::{
    math::RigidTransform,
    simd::lanes::{LANES, Row},
    strand::tile::{RootRows, StateRows, root, state},
};
use glam::{IVec3, Mat3, Vec3};

/// A box of nodes, x fastest. A ring of cells around the hair is empty, so that sums over the neighbors of a
/// cell or node stay within the box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridBounds {
    /// Lowest node on the grid.
    pub lo: IVec3,
    /// Number of nodes along x, y, z.
    pub dims: [usize; 3],
}

impl GridBounds {
    /// Creates the bounds of hair between `lo` and `hi` [cells].
    pub fn around(lo: Vec3, hi: Vec3) -> Self {
        let lo = lo.floor().as_ivec3() - 2;
        let dims = (hi.floor().as_ivec3() - lo + 4).to_array().map(|n| n.max(0) as usize);
        Self { lo, dims }
    }

    /// Returns the node one past the highest along every axis.
    pub fn end(&self) -> IVec3 {
        self.lo + IVec3::from(self.dims.map(|n| n as i32))
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.dims.iter().product()
    }

    /// Returns the number of nodes in a slab of constant z.
    pub fn slab(&self) -> usize {
        self.dims[0] * self.dims[1]
    }

    /// Returns the index offsets from a node to the eight corners of the cell with the same index; x fastest,
    /// then y, then z.
    pub fn corners(&self) -> [usize; 8] {
        let (row, slab) = (self.dims[0], self.slab());
        [0, 1, row, row + 1, slab, slab + 1, slab + row, slab + row + 1]
    }

    /// Returns the index of a node or cell of the grid; `None` if it is outside.
    pub fn index(&self, at: IVec3) -> Option<usize> {
        let [x, y, z] = (at - self.lo).to_array().map(|k| usize::try_from(k).unwrap_or(usize::MAX));
        let [nx, ny, nz] = self.dims;
        (x < nx && y < ny && z < nz).then(|| (z * ny + y) * nx + x)
    }

    /// Returns the grid coordinates of an index.
    pub fn place(&self, index: usize) -> IVec3 {
        let [nx, ny, _] = self.dims;
        self.lo + IVec3::new((index % nx) as i32, (index / nx % ny) as i32, (index / nx / ny) as i32)
    }
}

/// Transform of points to the grid: rotation to the anchor's axes, scaled to cells.
#[derive(Clone, Copy)]
pub struct GridTransform {
    /// Rotation from world axes to the anchor's, divided by the cell [1/m].
    turn: Mat3,
    /// Reciprocal of the cell [1/m].
    scale: f32,
    /// Fraction of the frame's motion that roots have completed [1].
    gone: f32,
}

impl GridTransform {
    /// Creates the transform for cells of `cell` [m] with the anchor at `anchor`, and roots at the end of the
    /// frame.
    pub fn new(anchor: &RigidTransform, cell: f32) -> Self {
        Self::on_the_way(anchor, cell, 1.0)
    }

    /// Like [`Self::new`], with roots at the fraction `gone` of their motion in the frame.
    pub fn on_the_way(anchor: &RigidTransform, cell: f32, gone: f32) -> Self {
        let scale = 1.0 / cell;
        Self { turn: Mat3::from_quat(anchor.rotation).transpose() * scale, scale, gone }
    }

    /// Returns the roots of eight strands relative to the node `from` [cells].
    pub fn roots(&self, rows: &RootRows, from: IVec3) -> [[f32; LANES]; 3] {
        let from = from.as_vec3().to_array();
        std::array::from_fn(|k| {
            let [start, end] = [root::START, root::END].map(|at| &rows[at + k].0);
            std::array::from_fn(|lane| {
                (start[lane] * (1.0 - self.gone) + end[lane] * self.gone) * self.scale - from[k]
            })
        })
    }

    /// Advances eight positions [cells] from one point of their strands to the next.
    #[inline(always)]
    pub fn advance(&self, places: &mut [[f32; LANES]; 3], next: &StateRows) {
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

/// Eight points in the grid bounds.
pub struct Placed {
    /// Lowest corner of each point's cell.
    pub cell: [i32; LANES],
    /// Trilinear weight of each point at the eight corners of its cell, in the order of
    /// [`GridBounds::corners`] [1].
    pub weights: [[f32; LANES]; 8],
    /// 1 for points inside, 0 for points outside or not finite.
    pub inside: [f32; LANES],
}

/// Adding and subtracting this constant rounds a number below 2²² to the nearest integer. The low bits of the
/// intermediate sum are that integer.
pub const ROUND: f32 = 1.5 * (1 << 23) as f32;

/// Returns the integer nearest to `x`, which must be below 2²² in absolute value.
#[inline(always)]
pub fn nearest(x: f32) -> i32 {
    ((x + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Returns the coordinate of the lowest corner of the cell that contains `x`, which must be below 2²² in absolute
/// value. A point on a node may be assigned to the previous cell; its weight is still entirely at that node.
#[inline(always)]
pub fn lowest_corner(x: f32) -> f32 {
    (x - 0.5 + ROUND) - ROUND
}

/// Returns the trilinear weights of a point at the corners of its cell, in the order of [`GridBounds::corners`], from
/// its position in the cell [1].
#[inline(always)]
pub fn trilinear([x, y, z]: [f32; 3]) -> [f32; 8] {
    let (u, v, w) = (1.0 - x, 1.0 - y, 1.0 - z);
    let [a, b, c, d] = [v * w, y * w, v * z, y * z];
    [u * a, x * a, u * b, x * b, u * c, x * c, u * d, x * d]
}

/// Lowest and highest coordinate of a point inside, as distances from the two ends of the bounds [cells]. Hair that the
/// bounds were made for is at least 2 cells from either; a point nearer to the ring is one that they do not cover.
const MARGIN: f32 = 1.5;

impl Placed {
    /// Locates points, which are relative to the lowest node of the bounds [cells].
    #[inline(always)]
    pub fn new(points: &[[f32; LANES]; 3], bounds: &GridBounds) -> Self {
        let strides = [1, bounds.dims[0] as i32, bounds.slab() as i32];
        let (mut cell, mut inside) = ([0; LANES], [1.0; LANES]);
        let mut f = [[0.0; LANES]; 3];
        for k in 0..3 {
            let last = (bounds.dims[k] - 1) as f32 - MARGIN;
            for lane in 0..LANES {
                let at = points[k][lane];
                // Comparisons that are false for a NaN.
                let low = if at > MARGIN { at } else { MARGIN };
                let clamped = if low < last { low } else { last };
                inside[lane] = if at == clamped { inside[lane] } else { 0.0 };
                let floor = lowest_corner(clamped);
                f[k][lane] = clamped - floor;
                cell[lane] += nearest(floor) * strides[k];
            }
        }
        let mut weights = [[0.0; LANES]; 8];
        for lane in 0..LANES {
            let of_lane = trilinear([f[0][lane], f[1][lane], f[2][lane]]);
            (0..8).for_each(|k| weights[k][lane] = of_lane[k]);
        }
        Self { cell, weights, inside }
    }
}
