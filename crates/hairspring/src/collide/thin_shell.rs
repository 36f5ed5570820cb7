//! Open meshes: a cape, a leaf, a hand made of one surface. Hair is kept off the nearest triangle, on both sides.
//!
//! ```text
//!        ______________________
//!       (  . . . . . . . . . . )   d(p) = min(|p − q|, 2 t) − t      q the nearest place of any triangle, t the thickness
//!       (______________________)
//! ```
//!
//! Each cell of a lattice lists the triangles that come within 2 t of it: most cells list none, and there no point is looked at
//! twice. A distance field would be faster where hair touches, but one with a sign needs triangles that all wind alike, one without needs
//! cells finer than the thickness, and either blurs the rim; lists are exact for any set of triangles, and as quick to make anew.

use super::lattice::Lattice;
use crate::{
    body::nearest_on_triangle,
    simd::lanes::{F, LANES, Mask, Row, Simd, V3, load},
};
use glam::{UVec3, Vec3};
use std::sync::Arc;

/// How far triangles are known, in thicknesses: far enough that a point that leaves is seen to leave.
const REACH: f32 = 2.0;

/// Most cells along the longest side.
const CELLS: f32 = 128.0;

/// Most nodes of the lattice.
const MAX_NODES: usize = 1 << 22;

/// A mesh that need not be closed, with a thickness.
///
/// # Missing
/// - A point that moves by more than the thickness in a substep may come out on the other side: nothing here knows where it was. (Of what the sheet itself moves,
///   frames are cut into parts and substeps so that it does not.)
/// - Between two layers nearer to each other than twice the thickness there is no room, and a point there is pushed from one to the other.
#[derive(Clone, Debug, Default)]
pub struct ThinShell {
    /// How far it reaches from its triangles, on both sides [m].
    thickness: f32,
    corners: Vec<[Vec3; 3]>,
    /// How far the corners moved during the last interval [m]; empty: it is rigid.
    moved: Vec<[Vec3; 3]>,
    lattice: Lattice,
    /// Where in `triangles` a cell's list begins, by the cell's index, and at last where the last one ends.
    first: Vec<u32>,
    /// Triangles that come within reach, cell after cell.
    triangles: Vec<u32>,
    /// What it was at equal parts of the last interval, before the last of them, where it moved far in that; empty: this all along.
    pub(super) previous_slices: Vec<Arc<ThinShell>>,
}

impl ThinShell {
    /// Its triangles [m], as they are now.
    pub fn triangles(&self) -> &[[Vec3; 3]] {
        &self.corners
    }

    /// How far it reaches from its triangles [m].
    pub(super) fn thickness(&self) -> f32 {
        self.thickness
    }

    /// Distance between neighbouring nodes of its lattice [m].
    pub(super) fn cell(&self) -> f32 {
        self.lattice.cell
    }

    /// The sheet of a mesh that reaches `thickness` from its triangles, to both sides [m], above 0.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], thickness: f32) -> Self {
        let mut sheet = Self::default();
        sheet.update(positions, None, triangles, None, thickness);
        sheet
    }

    /// Makes it the sheet of a mesh, in the memory that it has. `before`, where given, holds the vertices one interval ago in the same space.
    /// Only what lies in the box `within` (min, max) [m] needs to be known, where that is given. Triangles that are not finite are left out.
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
        // A cell is no shorter than the reach, so that a margin of one holds all of it.
        self.lattice = Lattice::covering(lo, hi, 1.0, cell, MAX_NODES);

        // Sorted by counting: how many in each cell, where each list ends, and from there down what is in it.
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

    /// Cells that triangle `t` comes within `reach` [m] of, and few others.
    fn near_cells(&self, t: usize, reach: f32) -> impl Iterator<Item = usize> + use<> {
        let lattice = self.lattice;
        let corners = self.corners[t].map(|p| (p - lattice.origin) / lattice.cell);
        let reach = reach / lattice.cell;
        let [a, b, c] = corners;
        let last = (lattice.size - 2).as_ivec3();
        let lo = (a.min(b).min(c) - reach).floor().as_ivec3().max(glam::IVec3::ZERO);
        let hi = (a.max(b).max(c) + reach).floor().as_ivec3().min(last);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // The plane's distance from a cell's middle, and as far as a cell's corners are from there along the normal.
        let far = reach + 0.5 * normal.abs().element_sum() + 1e-3;
        (lo.z..=hi.z)
            .flat_map(move |z| (lo.y..=hi.y).flat_map(move |y| (lo.x..=hi.x).map(move |x| [x, y, z])))
            .map(|at| UVec3::from(at.map(|k| k as u32)))
            .filter(move |cell| normal.dot(cell.as_vec3() + 0.5 - a).abs() <= far)
            .map(move |cell| lattice.index(cell))
    }

    /// The triangles within reach of cell `cell`, and perhaps others.
    fn listed(&self, cell: usize) -> &[u32] {
        &self.triangles[self.first[cell] as usize..self.first[cell + 1] as usize]
    }

    /// A ball around it: its middle and radius [m].
    pub(super) fn bounds(&self) -> (Vec3, f32) {
        let half = (self.lattice.size - UVec3::ONE).as_vec3() * (0.5 * self.lattice.cell);
        (self.lattice.origin + half, half.length())
    }

    /// Whether it moved in its own space.
    pub fn deforms(&self) -> bool {
        !self.moved.is_empty()
    }

    /// It is where it was an interval ago.
    pub fn hold_still(&mut self) {
        self.moved.clear();
    }

    /// The way from the nearest place of a triangle to `p` [m], that triangle and the place's barycentric coordinates; `None` out of reach.
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

    /// Distance [m], negative inside, and outward unit normal at `p` [m]; farther than its thickness from it, at least that and +Y.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        let (_, cell, _) = self.lattice.locate(p);
        self.in_cell(self.lattice.index(cell), p)
    }

    fn in_cell(&self, cell: usize, p: Vec3) -> (f32, Vec3) {
        let Some((way, t, _)) = self.nearest(cell, p) else {
            return ((REACH - 1.0) * self.thickness, Vec3::Y);
        };
        let distance = way.length();
        // On the sheet itself, to the side that its triangle faces.
        let normal = if distance > 1e-4 * self.thickness {
            way / distance
        } else {
            let [a, b, c] = self.corners[t];
            (b - a).cross(c - a).normalize_or(Vec3::Y)
        };
        (distance - self.thickness, normal)
    }

    /// How far the triangle nearest to `p` [m] moved there in the last interval [m]; 0 out of reach, or where it is rigid.
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

    /// Of eight points, those in a cell that a triangle comes near to; the others are outside.
    #[inline(always)]
    pub(super) fn may_be_inside<S: Simd>(&self, simd: S, p: V3<S>) -> Mask<S> {
        let (_, cells, _) = self.lattice.locate_lanes(simd, p);
        let may = Row(cells.map(|cell| if self.first[cell] < self.first[cell + 1] { 1.0 } else { 0.0 }));
        load(simd, &may).simd_gt(0.0)
    }

    /// [`ThinShell::distance_and_normal`] of eight points.
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
