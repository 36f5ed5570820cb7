//! Colliders of open meshes: a cape, a leaf, a hand made of one surface. Hair is kept off the nearest
//! triangle, on both sides.
//!
//! ```text
//!        ______________________
//!       (  . . . . . . . . . . )   d(p) = min(|p − q|, 2 t) − t      q the nearest point of any triangle, t the thickness
//!       (______________________)
//! ```
//!
//! Each cell of a lattice lists the triangles within 2 t of it. Most cells list none, and points in them are
//! rejected at once. A distance field would be faster where hair touches the shell, but it has drawbacks: a
//! signed field needs triangles with consistent winding, an unsigned one needs cells finer than the
//! thickness, and either blurs the rim. Lists are exact for any set of triangles and just as fast to rebuild.

use super::lattice::Lattice;
use crate::{
    body::nearest_on_triangle,
    simd::lanes::{F, LANES, Mask, Row, Simd, V3, load},
};
use glam::{UVec3, Vec3};
use std::sync::Arc;

/// Distance up to which triangles are found, in thicknesses. It is larger than 1 so that a separating point
/// is still measured.
pub(super) const REACH: f32 = 2.0;

/// Maximum number of cells along the longest side.
const CELLS: f32 = 128.0;

/// Maximum number of nodes of the lattice.
const MAX_NODES: usize = 1 << 22;

/// A mesh that need not be closed, with a thickness.
///
/// # Missing
/// - A point that moves by more than the thickness in a substep may come out on the other side, because the
///   shell does not know where the point was before. (Motion of the shell itself does not cause this: frames
///   are divided into time slices and substeps that are short enough.)
/// - Between two layers that are closer than twice the thickness there is no free space, and a point there is
///   pushed from one layer to the other.
///
/// For an example, see [`collide`](crate::collide).
///
/// The default is an empty shell, which [`ThinShell::update`] fills. A query of an empty shell may panic.
#[derive(Clone, Debug, Default)]
pub struct ThinShell {
    /// Half-thickness: distance that it extends from its triangles on both sides [m].
    thickness: f32,
    corners: Vec<[Vec3; 3]>,
    /// Displacement of the corners during the last interval [m]; empty: the shell is rigid.
    moved: Vec<[Vec3; 3]>,
    lattice: Lattice,
    /// Start of each cell's list in `triangles`, by cell index, followed by the end of the last list.
    first: Vec<u32>,
    /// Triangles within reach, cell after cell.
    triangles: Vec<u32>,
    /// The shell at the end of each equal time slice of the last frame, except the last slice. Empty if it
    /// did not move far in that frame.
    pub(super) previous_slices: Vec<Arc<ThinShell>>,
}

impl ThinShell {
    /// Returns its current triangles [m].
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.corners
    }

    /// Returns the distance that it extends from its triangles on each side [m].
    pub fn thickness(&self) -> f32 {
        self.thickness
    }

    /// Returns the distance between adjacent nodes of its lattice [m].
    pub(super) fn cell(&self) -> f32 {
        self.lattice.cell
    }

    /// Creates the shell of a mesh. It extends by `thickness` [m], above 0, to both sides of the triangles.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], thickness: f32) -> Self {
        let mut sheet = Self::default();
        sheet.update(positions, None, triangles, None, thickness);
        sheet
    }

    /// Rebuilds the shell from a mesh, reusing its buffers. `before`, if given, holds the vertices one
    /// interval ago in the same space. If `within` (min, max) [m] is given, only that box needs to be
    /// covered. Triangles that are not finite are ignored.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist, also in `before`.
    pub fn update(
        &mut self,
        positions: &[Vec3],
        before: Option<&[Vec3]>,
        triangles: &[[u32; 3]],
        within: Option<(Vec3, Vec3)>,
        thickness: f32,
    ) {
        self.thickness = thickness;
        self.previous_slices.clear();
        self.corners.clear();
        self.moved.clear();
        for t in triangles {
            let now = t.map(|i| positions[i as usize]);
            if now.iter().all(|p| p.is_finite()) {
                self.corners.push(now);
                self.moved.extend(before.map(|b| t.map(|i| positions[i as usize] - b[i as usize])));
            }
        }
        let reach = REACH * thickness;
        let all = || self.corners.iter().flatten();
        let lo = all().fold(Vec3::splat(f32::MAX), |lo, p| lo.min(*p));
        let hi = all().fold(Vec3::splat(f32::MIN), |hi, p| hi.max(*p));
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        let nowhere = within.map_or(Vec3::ZERO, |(a, _)| a);
        let (lo, hi) = if lo.cmple(hi).all() { (lo, hi) } else { (nowhere, nowhere) };
        let cell = reach.max((hi - lo).max_element() / CELLS);
        // A cell is at least as long as the reach, so a margin of one cell covers it.
        self.lattice = Lattice::covering(lo, hi, 1.0, cell, MAX_NODES);

        // Counting sort: count the triangles of each cell, find where each list ends, then fill the lists
        // from their ends.
        self.first.clear();
        self.first.resize(self.lattice.nodes() + 1, 0);
        for t in 0..self.corners.len() {
            self.near_cells(t, reach).for_each(|cell| self.first[cell] += 1);
        }
        let mut end = 0;
        for first in &mut self.first {
            end += *first;
            *first = end;
        }
        self.triangles.clear();
        self.triangles.resize(end as usize, 0);
        for t in (0..self.corners.len()).rev() {
            for cell in self.near_cells(t, reach) {
                self.first[cell] -= 1;
                self.triangles[self.first[cell] as usize] = t as u32;
            }
        }
    }

    /// Returns the cells within `reach` [m] of triangle `t`, and few others.
    fn near_cells(&self, t: usize, reach: f32) -> impl Iterator<Item = usize> + use<> {
        let lattice = self.lattice;
        let corners = self.corners[t].map(|p| (p - lattice.origin) / lattice.cell);
        let reach = reach / lattice.cell;
        let [a, b, c] = corners;
        let last = (lattice.size - 2).as_ivec3();
        let lo = (a.min(b).min(c) - reach).floor().as_ivec3().max(glam::IVec3::ZERO);
        let hi = (a.max(b).max(c) + reach).floor().as_ivec3().min(last);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // The distance of the plane from the cell's center is compared with the reach plus the cell's extent
        // along the normal.
        let far = reach + 0.5 * normal.abs().element_sum() + 1e-3;
        (lo.z..=hi.z)
            .flat_map(move |z| (lo.y..=hi.y).flat_map(move |y| (lo.x..=hi.x).map(move |x| [x, y, z])))
            .map(|at| UVec3::from(at.map(|k| k as u32)))
            .filter(move |cell| normal.dot(cell.as_vec3() + 0.5 - a).abs() <= far)
            .map(move |cell| lattice.index(cell))
    }

    /// Returns the triangles within reach of cell `cell`, and possibly others.
    fn listed(&self, cell: usize) -> &[u32] {
        &self.triangles[self.first[cell] as usize..self.first[cell + 1] as usize]
    }

    /// Returns the triangles within reach of the cell that contains `p` [m], and possibly others.
    pub(super) fn listed_at(&self, p: Vec3) -> &[u32] {
        let (_, cell, _) = self.lattice.locate(p);
        self.listed(self.lattice.index(cell))
    }

    /// Returns a bounding sphere: center and radius [m].
    pub(super) fn bounds(&self) -> (Vec3, f32) {
        let half = (self.lattice.size - UVec3::ONE).as_vec3() * (0.5 * self.lattice.cell);
        (self.lattice.origin + half, half.length())
    }

    /// Returns whether it deformed in its own space.
    pub fn deforms(&self) -> bool {
        !self.moved.is_empty()
    }

    /// Discards its deformation, as if it had stayed in place during the last interval.
    pub fn clear_motion(&mut self) {
        self.moved.clear();
    }

    /// Returns the offset from the nearest point of any triangle to `p` [m], that triangle, and the
    /// barycentric coordinates of the point; `None` out of reach.
    fn nearest(&self, cell: usize, p: Vec3) -> Option<(Vec3, usize, Vec3)> {
        let mut best = (Vec3::ZERO, usize::MAX, Vec3::X);
        let mut least = (REACH * self.thickness).powi(2);
        for &t in self.listed(cell) {
            let [a, b, c] = self.corners[t as usize];
            let at = nearest_on_triangle(p, [a, b, c]);
            let way = p - (a * at.x + b * at.y + c * at.z);
            if way.length_squared() < least {
                (least, best) = (way.length_squared(), (way, t as usize, at));
            }
        }
        (best.1 < usize::MAX).then_some(best)
    }

    /// Returns the distance [m], negative inside, and the outward unit normal at `p` [m]. Out of reach of the
    /// triangles, it returns a distance of one thickness, which is a lower bound, and +Y.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let (_, cell, _) = self.lattice.locate(p);
        self.in_cell(self.lattice.index(cell), p)
    }

    fn in_cell(&self, cell: usize, p: Vec3) -> (f32, Vec3) {
        let Some((way, t, _)) = self.nearest(cell, p) else {
            return ((REACH - 1.0) * self.thickness, Vec3::Y);
        };
        let distance = way.length();
        // On a triangle itself, use the triangle's own normal.
        let normal = if distance > 1e-4 * self.thickness {
            way / distance
        } else {
            let [a, b, c] = self.corners[t];
            (b - a).cross(c - a).normalize_or(Vec3::Y)
        };
        (distance - self.thickness, normal)
    }

    /// Returns how far the triangle nearest to `p` [m] moved there in the last interval [m]; 0 if it is out
    /// of reach or the shell is rigid.
    pub fn displacement(&self, p: Vec3) -> Vec3 {
        let (_, cell, _) = self.lattice.locate(p);
        match self.nearest(self.lattice.index(cell), p) {
            Some((_, t, at)) if self.deforms() => {
                let [a, b, c] = self.moved[t];
                a * at.x + b * at.y + c * at.z
            }
            _ => Vec3::ZERO,
        }
    }

    /// Returns which of eight points are in a cell that has triangles within reach. The others are outside.
    #[inline(always)]
    pub(super) fn may_be_inside<S: Simd>(&self, simd: S, p: V3<S>) -> Mask<S> {
        let (_, cells, _) = self.lattice.locate_lanes(simd, p);
        let may = Row(cells.map(|cell| if self.first[cell] < self.first[cell + 1] { 1.0 } else { 0.0 }));
        load(simd, &may).simd_gt(0.0)
    }

    /// [`ThinShell::distance_and_normal`] for eight points.
    #[inline(always)]
    pub(super) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (_, cells, _) = self.lattice.locate_lanes(simd, p);
        let mut rows = [Row::default(); 4];
        for (lane, cell) in (0..LANES).zip(cells) {
            let (distance, normal) =
                self.in_cell(cell, Vec3::new(p.x.lane(lane), p.y.lane(lane), p.z.lane(lane)));
            for (row, v) in rows.iter_mut().zip([normal.x, normal.y, normal.z, distance]) {
                row.0[lane] = v;
            }
        }
        (load(simd, &rows[3]), V3::load(simd, &rows))
    }
}
