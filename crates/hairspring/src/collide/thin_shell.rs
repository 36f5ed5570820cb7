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
    simd::lanes::{F, LANES, Mask, Row, Simd, V3, load, store},
};
use glam::{UVec3, Vec3};
use std::sync::Arc;

/// Distance up to which triangles are found, in thicknesses. It is larger than 1 so that a separating point
/// is still measured.
pub(super) const REACH: f32 = 2.0;

/// Factor on a distance from a triangle that is compared with one from its plane: 1 and a margin for rounding.
const NEAR_PLANE: f32 = 1.01;

/// Maximum number of cells along the longest side.
const MAX_CELLS_PER_SIDE: f32 = 128.0;

/// Maximum number of samples of a segment. A longer one counts as near the shell.
const MAX_SAMPLES: u32 = 64;

/// Maximum number of nodes of the lattice.
const MAX_NODES: usize = 1 << 22;

/// A mesh that need not be closed, with a thickness.
///
/// # Limitations
/// - A point that moves by more than the thickness in a substep may come out on the other side, because the
///   shell does not know where the point was before. (Motion of the shell itself does not cause this: frames
///   are divided into time slices and substeps that are short enough.)
/// - Between two layers that are closer than twice the thickness there is no free space, and a point there is
///   pushed from one layer to the other.
///
/// For an example, see [`collide`](crate::collide).
///
/// The default is an empty shell, which [`ThinShell::update`] fills. A query of an empty shell may panic.
#[derive(Clone, Default)]
pub struct ThinShell {
    /// Half-thickness: distance that it extends from its triangles on both sides [m].
    thickness: f32,
    corners: Vec<[Vec3; 3]>,
    /// Unit normal of each triangle; 0 for a triangle without area.
    normals: Vec<Vec3>,
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

impl std::fmt::Debug for ThinShell {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ThinShell")
            .field("thickness", &self.thickness)
            .field("triangles", &self.corners.len())
            .finish_non_exhaustive()
    }
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
        self.rebuild((positions, before), triangles, within, thickness, MAX_CELLS_PER_SIDE);
    }

    /// [`ThinShell::update`] with at most so many `cells` along the longest side. Fewer cells are faster to build, and
    /// queries are slower.
    pub(super) fn rebuild(
        &mut self,
        (positions, before): (&[Vec3], Option<&[Vec3]>),
        triangles: &[[u32; 3]],
        within: Option<(Vec3, Vec3)>,
        thickness: f32,
        cells: f32,
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
        self.normals.clear();
        self.normals.extend(self.corners.iter().map(|[a, b, c]| (b - a).cross(c - a).normalize_or_zero()));
        let reach = REACH * thickness;
        let all = || self.corners.iter().flatten();
        let lo = all().fold(Vec3::splat(f32::MAX), |lo, p| lo.min(*p));
        let hi = all().fold(Vec3::splat(f32::MIN), |hi, p| hi.max(*p));
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        let nowhere = within.map_or(Vec3::ZERO, |(a, _)| a);
        let (lo, hi) = if lo.cmple(hi).all() { (lo, hi) } else { (nowhere, nowhere) };
        let cell = reach.max((hi - lo).max_element() / cells);
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
        let normal = self.normals[t];
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
            let off_plane = self.normals[t as usize].dot(p - a);
            if off_plane * off_plane > least * (NEAR_PLANE * NEAR_PLANE) {
                continue;
            }
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

    /// Returns which of eight points may be inside. The others are not.
    #[inline(always)]
    pub(super) fn may_be_inside<S: Simd>(&self, simd: S, p: V3<S>) -> Mask<S> {
        let (_, cells, _) = self.lattice.locate_lanes(simd, p);
        let p = points(p);
        let may = |lane: usize| self.may_touch(cells[lane], [p[lane]; 2]);
        load(simd, &Row(std::array::from_fn(|lane| f32::from(may(lane))))).simd_gt(0.0)
    }

    /// Returns which of the segments in `may`, from `a` to `a + e`, may have a place inside. The others have none. Not
    /// inlined: all kernels share one copy.
    #[inline(never)]
    pub(super) fn segments_may_be_inside<S: Simd>(
        &self,
        simd: S,
        segments: (V3<S>, V3<S>),
        may: Mask<S>,
    ) -> Mask<S> {
        simd.vectorize(
            #[cfg_attr(not(any(test, unoptimized)), inline(always))]
            || self.sample_segments(simd, segments, may),
        )
    }

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn sample_segments<S: Simd>(&self, simd: S, (a, e): (V3<S>, V3<S>), may: Mask<S>) -> Mask<S> {
        // A cell lists all triangles within reach of it. A place inside is within the thickness of one, and no
        // farther from a sample than half of their spacing.
        let spacing = 2.0 * (REACH - 1.0) * self.thickness;
        let length = may.select(e.length_and_unit().0, F::splat(simd, 0.0));
        let mut samples = 1;
        while length.simd_gt(samples as f32 * spacing).any_true() {
            samples += 1;
            if samples > MAX_SAMPLES {
                return may;
            }
        }
        let (zero, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        let (mut left, mut found) = (Row::default(), Row::default());
        store(may.select(one, zero), &mut left);
        let ends = [points(a), points(a + e)];
        for k in 0..samples {
            let at = F::splat(simd, (k as f32 + 0.5) / samples as f32);
            let (_, cells, _) = self.lattice.locate_lanes(simd, e.mul_add(at, a));
            for lane in 0..LANES {
                if left.0[lane] > 0.0 && self.may_touch(cells[lane], [ends[0][lane], ends[1][lane]]) {
                    (left.0[lane], found.0[lane]) = (0.0, 1.0);
                }
            }
        }
        load(simd, &found).simd_gt(0.0)
    }

    /// Returns whether the line between `ends` [m] may come within the thickness of a triangle that `cell` lists.
    #[inline(never)]
    fn may_touch(&self, cell: usize, ends: [Vec3; 2]) -> bool {
        let near = NEAR_PLANE * self.thickness;
        self.listed(cell).iter().any(|&t| !self.misses_plane(t as usize, ends, near))
    }

    /// Returns whether both `ends` of a line are farther than `near` [m] from the plane of triangle `t`, on the same
    /// side. Not if they are not finite.
    #[inline(always)]
    pub(super) fn misses_plane(&self, t: usize, ends: [Vec3; 2], near: f32) -> bool {
        let (corner, normal) = (self.corners[t][0], self.normals[t]);
        let [a, b] = ends.map(|p| normal.dot(p - corner));
        a.min(b) > near || a.max(b) < -near
    }

    /// [`ThinShell::distance_and_normal`] for eight points.
    #[inline(always)]
    pub(super) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (_, cells, _) = self.lattice.locate_lanes(simd, p);
        let mut rows = [Row::default(); 4];
        for ((lane, cell), p) in (0..LANES).zip(cells).zip(points(p)) {
            let (distance, normal) = self.in_cell(cell, p);
            for (row, v) in rows.iter_mut().zip([normal.x, normal.y, normal.z, distance]) {
                row.0[lane] = v;
            }
        }
        (load(simd, &rows[3]), V3::load(simd, &rows))
    }
}

/// Returns eight points, one by one.
#[inline(always)]
fn points<S: Simd>(p: V3<S>) -> [Vec3; LANES] {
    let mut rows = [Row::default(); 3];
    p.store(&mut rows);
    std::array::from_fn(|lane| Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::dispatch::dispatch;
    use fearless_simd::Level;
    use proptest::prelude::*;

    fn vector(size: f32) -> impl Strategy<Value = Vec3> {
        (-size..size, -size..size, -size..size).prop_map(Vec3::from)
    }

    proptest! {
        /// Triangles that are skipped by their planes change no distance, and no point or segment inside is missed.
        #[test]
        fn no_triangle_in_reach_is_skipped(
            triangles in prop::collection::vec([vector(0.1), vector(0.1), vector(0.1)], 1..12),
            thickness in 0.002f32..0.02, ends in [vector(0.12), vector(0.12)],
        ) {
            let corners: Vec<Vec3> = triangles.iter().flatten().copied().collect();
            let numbers: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let shell = ThinShell::new(&corners, &numbers, thickness);
            let exact = |p: Vec3| {
                let way = |t: &[Vec3; 3]| {
                    let at = nearest_on_triangle(p, *t);
                    p.distance(t[0] * at.x + t[1] * at.y + t[2] * at.z)
                };
                triangles.iter().map(way).fold(REACH * thickness, f32::min) - thickness
            };
            let [a, b] = ends;
            let mut inside = false;
            for k in 0..=32 {
                let p = a.lerp(b, k as f32 / 32.0);
                let distance = exact(p);
                prop_assert!((shell.distance_and_normal(p).0 - distance).abs() < 1e-5, "{p}");
                inside |= distance < -1e-5;
                if distance < -1e-5 {
                    prop_assert!(dispatch!(Level::new(), simd => shell.may_be_inside(simd, V3::splat(simd, p)).any_true()));
                }
            }
            let may = dispatch!(Level::new(), simd => {
                let (a, e) = (V3::splat(simd, a), V3::splat(simd, b - a));
                shell.segments_may_be_inside(simd, (a, e), Mask::splat(simd, true)).any_true()
            });
            prop_assert!(may || !inside, "a segment inside is skipped");
        }
    }
}
