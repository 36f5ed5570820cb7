//! A signed distance field on a regular grid.

use super::{lattice::Lattice, voxelize::BAND};
use crate::body::nearest_on_triangle;
use crate::parallel::prelude::*;
use crate::simd::lanes::{F, LANES, Mask, Row, Simd, V3, load};
use fearless_simd::f32x4;
#[cfg(not(one_lane))]
use fearless_simd::prelude::*;
use glam::{UVec3, Vec3};
use std::sync::Arc;

/// Padding after the nodes' distances, so that four values can be loaded starting at the last node but one.
pub(super) const PADDING: usize = 2;

/// Signed distances at the nodes of a regular grid, negative inside, with trilinear interpolation.
///
/// For an example, see [`SignedDistanceField::from_samples`].
///
/// The default is an empty field, which a [`Voxelizer`](super::Voxelizer) fills. A query of an empty field panics.
#[derive(Clone, Default, PartialEq)]
pub struct SignedDistanceField {
    pub(super) lattice: Lattice,
    /// Distance at each node [m], followed by [`PADDING`] values of padding.
    pub(super) distances: Vec<f32>,
    /// Index of the nearest triangle for each node of the band; unspecified for other nodes. One for each
    /// node.
    pub(super) nearest: Vec<u32>,
    /// Corners of the triangles, in the field's space [m]. Empty: the field was not made from a mesh.
    pub(super) triangles: Vec<[Vec3; 3]>,
    /// Displacement of those corners during the last interval [m]. Empty: the surface is rigid.
    moved: Vec<[Vec3; 3]>,
    /// The field at the end of each equal time slice of the last frame, except the last slice. Empty if
    /// the surface did not move far in that frame.
    pub(super) previous_slices: Vec<Arc<SignedDistanceField>>,
    /// One bit for each cell that has a point inside, at the index of its lower node. Empty: any cell may.
    inside: Vec<u32>,
}

impl std::fmt::Debug for SignedDistanceField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SignedDistanceField")
            .field("origin", &self.origin())
            .field("cell", &self.cell())
            .field("size", &self.size())
            .field("triangles", &self.triangles.len())
            .finish_non_exhaustive()
    }
}

impl SignedDistanceField {
    /// Returns the position of node (0, 0, 0) [m].
    pub fn origin(&self) -> Vec3 {
        self.lattice.origin
    }

    /// Returns the distance between adjacent nodes [m].
    pub fn cell(&self) -> f32 {
        self.lattice.cell
    }

    /// Returns the number of nodes along each axis, each 2 or more; at most 2²³ in total.
    pub fn size(&self) -> UVec3 {
        self.lattice.size
    }

    /// Returns the distance at each node [m], x fastest; shape `[size.z][size.y][size.x]`.
    pub fn distances(&self) -> &[f32] {
        &self.distances[..self.lattice.nodes().min(self.distances.len())]
    }

    /// Returns whether the surface deformed in the field's own space.
    pub fn deforms(&self) -> bool {
        !self.moved.is_empty()
    }

    /// Resizes the grid to `lattice`; distances and nearest triangles are filled in later. `before` holds the
    /// vertices one interval ago.
    pub(super) fn begin(
        &mut self,
        lattice: Lattice,
        positions: &[Vec3],
        before: Option<&[Vec3]>,
        triangles: &[[u32; 3]],
    ) {
        self.lattice = lattice;
        self.distances.resize(lattice.nodes() + PADDING, 0.0);
        self.distances[lattice.nodes()..].fill(f32::MAX);
        self.nearest.resize(lattice.nodes(), 0);
        self.triangles.clear();
        self.triangles.extend(triangles.iter().map(|t| t.map(|i| positions[i as usize])));
        self.moved.clear();
        self.previous_slices.clear();
        if let Some(before) = before {
            let moved = |i: u32| positions[i as usize] - before[i as usize];
            self.moved.extend(triangles.iter().map(|t| t.map(moved)));
        }
    }

    /// Discards the deformation, as if the surface had stayed in place during the last interval.
    pub fn clear_motion(&mut self) {
        self.moved.clear();
    }

    /// Returns the bounding sphere of the closed grid: center and radius [m]. Nothing outside of it is inside
    /// the surface.
    pub fn bounds(&self) -> (Vec3, f32) {
        let half = (self.lattice.size - UVec3::ONE).as_vec3() * (0.5 * self.lattice.cell);
        (self.lattice.origin + half, half.length())
    }

    /// Returns the length of the grid's shortest side [m].
    pub(super) fn shortest_side(&self) -> f32 {
        (self.lattice.size.min_element() - 1) as f32 * self.lattice.cell
    }

    /// Returns the distance [m] and outward unit normal at `p` [m]. For points outside the grid, the distance
    /// to the grid is added. An empty field is infinitely far away.
    pub fn distance_and_normal(&self, p: Vec3) -> (f32, Vec3) {
        if self.distances.is_empty() {
            return (f32::INFINITY, Vec3::Y);
        }
        let (out, cell, along) = self.lattice.locate(p);
        let c00 = self.corners(self.lattice.index(cell));
        let [fx, fy, fz] = along.to_array();
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let x = [0, 2, 4, 6].map(|k| mix(c00[k], c00[k + 1], fx));
        let y = [mix(x[0], x[1], fy), mix(x[2], x[3], fy)];
        let gx =
            mix(mix(c00[1] - c00[0], c00[3] - c00[2], fy), mix(c00[5] - c00[4], c00[7] - c00[6], fy), fz);
        let gradient = Vec3::new(gx, mix(x[1] - x[0], x[3] - x[2], fz), y[1] - y[0]);
        (mix(y[0], y[1], fz) + out.length() * self.lattice.cell, gradient.normalize_or(Vec3::Y))
    }

    /// Returns how far the surface nearest to `p` [m] moved in the last interval [m]; 0 if the surface is
    /// rigid or `p` is outside the band of exact distances.
    pub fn displacement(&self, p: Vec3) -> Vec3 {
        let top = (self.lattice.size - UVec3::ONE).as_vec3();
        let c = ((p - self.lattice.origin) / self.lattice.cell).max(Vec3::ZERO).min(top);
        let node = self.lattice.index(c.round().as_uvec3());
        let known = self.distances[node].abs() < 0.99 * BAND * self.lattice.cell;
        let triangle = self.nearest[node] as usize;
        let Some(moved) = self.moved.get(triangle).filter(|_| known) else { return Vec3::ZERO };
        let weights = nearest_on_triangle(p, self.triangles[triangle]);
        if !weights.is_finite() {
            // Degenerate triangle: its corners coincide or are collinear.
            return moved[0];
        }
        moved[0] * weights.x + moved[1] * weights.y + moved[2] * weights.z
    }

    /// Returns the eight corner distances of the cell with lower node `i`: x fastest, then y, then z.
    #[inline(always)]
    fn corners(&self, i: usize) -> [f32; 8] {
        let (dy, dz) = (self.lattice.size.x as usize, (self.lattice.size.x * self.lattice.size.y) as usize);
        let d = &self.distances[i..i + dz + dy + 2];
        [d[0], d[1], d[dy], d[dy + 1], d[dz], d[dz + 1], d[dz + dy], d[dz + dy + 1]]
    }

    /// [`Self::corners`] of eight cells. Each load reads four values of which two are kept. This needs fewer
    /// loads than reading each node, and no store of eight values has to be waited for.
    #[inline(always)]
    fn corners_lanes<S: Simd>(&self, simd: S, [a, b, c, d, e, f, g, h]: [usize; LANES]) -> [F<S>; 8] {
        let (dy, dz) = (self.lattice.size.x as usize, (self.lattice.size.x * self.lattice.size.y) as usize);
        // One bounds check for each cell: the compiler sees that all four loads of four values are within it.
        let cell = |i: usize| &self.distances[i..i + dz + dy + 4];
        let cells = [cell(a), cell(b), cell(c), cell(d), cell(e), cell(f), cell(g), cell(h)];
        let ([k0, k1], [k2, k3]) = (pairs(simd, &cells, 0), pairs(simd, &cells, dy));
        let ([k4, k5], [k6, k7]) = (pairs(simd, &cells, dz), pairs(simd, &cells, dz + dy));
        [k0, k1, k2, k3, k4, k5, k6, k7]
    }

    /// Marks the cells that contain a point inside. These are the cells with a corner inside, since the
    /// interpolation is trilinear. Must be called after `distances` have changed.
    pub(super) fn mark_inside(&mut self) {
        self.distances
            .par_chunks(u32::BITS as usize)
            .with_min_len(1024)
            .map(|nodes| {
                // Most words are uniform. A NaN counts as inside, so that unknown cells are tested.
                let outside: u32 = nodes.iter().map(|d| u32::from(*d > 0.0)).sum();
                if outside == 0 || outside == u32::BITS {
                    return if outside == 0 { u32::MAX } else { 0 };
                }
                let bits = nodes.iter().zip(0..).fold(0, |bits, (d, k)| bits | u32::from(*d > 0.0) << k);
                !bits
            })
            .collect_into_vec(&mut self.inside);
        // A cell extends to the next node along each axis. Going forward, each word is read before it is
        // overwritten.
        let (count, slab) = (self.inside.len(), self.lattice.size.x * self.lattice.size.y);
        for step in [1, self.lattice.size.x, slab] {
            let (words, bits) = ((step / u32::BITS) as usize, step % u32::BITS);
            for w in 0..count {
                let next = |k: usize| u64::from(self.inside.get(w + words + k).copied().unwrap_or(0));
                self.inside[w] |= ((next(1) << u32::BITS | next(0)) >> bits) as u32;
            }
        }
    }

    /// Returns whether the cell of `p` contains a point inside.
    pub(crate) fn may_be_inside_at(&self, p: Vec3) -> bool {
        let (_, cell, _) = self.lattice.locate(p);
        let size = self.lattice.size;
        let index = ((cell.z * size.y + cell.y) * size.x + cell.x) as usize;
        self.inside
            .get(index / u32::BITS as usize)
            .is_none_or(|bits| bits >> (index as u32 % u32::BITS) & 1 == 1)
    }

    /// Returns which of eight points are in a cell that contains a point inside. The others are outside.
    #[inline(always)]
    pub(crate) fn may_be_inside<S: Simd>(&self, simd: S, p: V3<S>) -> Mask<S> {
        let mut may = Row([1.0; LANES]);
        if !self.inside.is_empty() {
            let (_, index, _) = self.lattice.locate_lanes(simd, p);
            for (may, index) in may.0.iter_mut().zip(index) {
                let bits = self.inside[index / u32::BITS as usize] >> (index as u32 % u32::BITS);
                *may = (bits & 1) as f32;
            }
        }
        load(simd, &may).simd_gt(0.0)
    }

    /// [`Self::distance_and_normal`] for eight points.
    #[inline(always)]
    pub(crate) fn distance_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (distance, gradient) = self.between_nodes(simd, p);
        (distance, gradient.length_and_unit().1)
    }

    /// Returns the distance of eight points [m] and its gradient [1]. The gradient is that of the
    /// interpolation; where walls are close to each other, its length is up to 3.
    #[inline(always)]
    pub(crate) fn slope_lanes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (distance, gradient) = self.between_nodes(simd, p);
        (distance, gradient * F::splat(simd, 1.0 / self.lattice.cell))
    }

    /// Returns the distance [m] and its gradient per cell [m].
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn between_nodes<S: Simd>(&self, simd: S, p: V3<S>) -> (F<S>, V3<S>) {
        let (out, index, along) = self.lattice.locate_lanes(simd, p);
        let k = self.corners_lanes(simd, index);
        let V3 { x: fx, y: fy, z: fz } = along;
        let x = [mix(k[0], k[1], fx), mix(k[2], k[3], fx), mix(k[4], k[5], fx), mix(k[6], k[7], fx)];
        let y = [mix(x[0], x[1], fy), mix(x[2], x[3], fy)];
        let gradient = V3 {
            x: mix(mix(k[1] - k[0], k[3] - k[2], fy), mix(k[5] - k[4], k[7] - k[6], fy), fz),
            y: mix(x[1] - x[0], x[3] - x[2], fz),
            z: y[1] - y[0],
        };
        let beyond = out.dot(out).sqrt() * self.lattice.cell;
        // Where the gradient vanishes, such as halfway through a wall or beyond the band, use +Y, as the
        // scalar version does.
        let level = gradient.dot(gradient).simd_lt(1e-30);
        let gradient = V3::select(level, V3::splat(simd, Vec3::Y * self.lattice.cell), gradient);
        (mix(y[0], y[1], fz) + beyond, gradient)
    }
}

/// Returns the values at index `at` of eight slices, and the values after them. Reads two more values of each
/// slice.
#[inline(always)]
fn pairs<S: Simd>(simd: S, [a, b, c, d, e, f, g, h]: &[&[f32]; LANES], at: usize) -> [F<S>; 2] {
    let (low, high) = (pairs_of_four(simd, [a, b, c, d], at), pairs_of_four(simd, [e, f, g, h], at));
    [low.0.combine(high.0), low.1.combine(high.1)].map(|eight| F::from_native(simd, eight))
}

/// [`pairs`] for four slices.
#[inline(always)]
fn pairs_of_four<S: Simd>(
    simd: S,
    [a, b, c, d]: [&[f32]; 4],
    at: usize,
) -> (f32x4<S::Native>, f32x4<S::Native>) {
    let (a, b) = (four(simd, a, at), four(simd, b, at));
    let (c, d) = (four(simd, c, at), four(simd, d, at));
    a.zip_low(c).interleave(b.zip_low(d))
}

#[inline(always)]
fn four<S: Simd>(simd: S, numbers: &[f32], first: usize) -> f32x4<S::Native> {
    f32x4::from_slice(simd.native(), &numbers[first..first + 4])
}

/// Linear interpolation: `a` at `t` = 0, `b` at 1.
#[inline(always)]
fn mix<S: Simd>(a: F<S>, b: F<S>, t: F<S>) -> F<S> {
    (b - a).mul_add(t, a)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{
        air::Air,
        collide::{ColliderShape, MovingCollider, Voxelizer, VoxelizerInput, voxelize},
        groom::Groom,
        material::Material,
        math::RigidTransform,
        settings::Solver,
        simd::dispatch::dispatch,
        simulation::{Simulation, StepInput},
    };
    use fearless_simd::Level;
    use glam::Quat;
    use std::sync::Arc;

    /// Balls of many triangles, rotated and overlapping; `closed`: without holes.
    pub fn balls(seed: u32, closed: bool) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let hash = |k: u32| ((seed * 977 + k).wrapping_mul(0x9E37_79B9) >> 8) as f32 / (1 << 24) as f32;
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for ball in 0..3 {
            let at = Vec3::new(hash(ball), hash(ball + 10), hash(ball + 20)) * 0.1;
            let turn = Quat::from_scaled_axis(at * 60.0);
            let first = positions.len() as u32;
            let (rows, columns) = (9, 14);
            for r in 0..=rows {
                for c in 0..columns {
                    let (s, y) = (r as f32 * std::f32::consts::PI / rows as f32).sin_cos();
                    let (z, x) = (c as f32 * std::f32::consts::TAU / columns as f32).sin_cos();
                    positions.push(at + turn * Vec3::new(s * x, y, s * z) * (0.02 + 0.04 * hash(ball + 30)));
                }
            }
            for r in 0..rows {
                for c in 0..columns {
                    let i = |r: u32, c: u32| first + r * columns + c % columns;
                    let [a, b, d, e] = [i(r, c), i(r, c + 1), i(r + 1, c), i(r + 1, c + 1)];
                    if closed || hash(r * 31 + c + 40) > 0.1 {
                        triangles.extend([[a, b, e], [a, e, d]]);
                    }
                }
            }
        }
        (positions, triangles)
    }

    fn assert_marked(grid: &SignedDistanceField, what: &str) {
        let lattice = grid.lattice;
        let mut marked = 0;
        for z in 0..grid.lattice.size.z - 1 {
            for y in 0..grid.lattice.size.y - 1 {
                for x in 0..grid.lattice.size.x - 1 {
                    let i = lattice.index(UVec3::new(x, y, z));
                    let holds = grid.corners(i).iter().any(|d| *d <= 0.0);
                    let mark = grid.inside[i / 32] >> (i % 32) & 1 == 1;
                    assert_eq!(mark, holds, "{what}: cell {x}, {y}, {z} of {}", grid.lattice.size);
                    marked += u32::from(mark);
                }
            }
        }
        assert!(marked > 100, "{what}: {marked} cells with an inside");
    }

    #[test]
    fn cells_are_marked_that_hold_a_place_inside_and_no_others() {
        for seed in 0..12 {
            for closed in [true, false] {
                let (positions, triangles) = balls(seed, closed);
                let mut grid = voxelize(&positions, &triangles, 0.003 + 0.0003 * seed as f32);
                assert_marked(&grid, &format!("balls {seed}, closed: {closed}"));
                // A deforming one, in a box that cuts through it.
                let now: Vec<Vec3> = positions.iter().map(|p| *p * (1.0 + 3.0 * p.y)).collect();
                let within = Some((Vec3::splat(-0.01), Vec3::new(0.06, 0.2, 0.07)));
                let input = VoxelizerInput::new(&now, &triangles, 0.003);
                let input = VoxelizerInput { previous_positions: Some(&positions), within, ..input };
                Voxelizer::default().update(&mut grid, &input);
                assert_marked(&grid, &format!("deforming balls {seed}, closed: {closed}"));
            }
        }
    }

    /// Halfway through a wall the distance has no gradient. A point there must still be led out.
    #[test]
    fn the_middle_of_a_wall_has_a_way_out() {
        let grid = SignedDistanceField {
            lattice: Lattice::new(Vec3::ZERO, 0.01, UVec3::new(3, 3, 3)),
            distances: vec![-0.02; 27 + PADDING],
            nearest: vec![0; 27],
            ..SignedDistanceField::default()
        };
        let p = Vec3::new(0.012, 0.007, 0.003);
        let (distance, normal) = grid.distance_and_normal(p);
        let [lanes, up, steep] = dispatch!(Level::new(), simd => {
            let p = V3::splat(simd, p);
            let ((d, n), (_, slope)) = (grid.distance_lanes(simd, p), grid.slope_lanes(simd, p));
            [d, n.y, slope.y].map(|v| v.lane(3))
        });
        assert_eq!((distance, normal), (-0.02, Vec3::Y));
        assert_eq!((lanes, up), (-0.02, 1.0));
        // The slope is that of a distance, and no steeper: otherwise a segment there would seem to penetrate
        // deeply.
        assert!((steep - 1.0).abs() < 1e-6, "{steep}");
    }

    #[test]
    fn skipped_cells_change_no_bit() {
        let strands = (0..24).map(|s| {
            let root = Vec3::new(0.0, 0.2, 0.004 * s as f32);
            (0..20).map(move |i| root - Vec3::Y * (0.012 * i as f32)).collect::<Vec<_>>()
        });
        let groom = Arc::new(Groom::from_strands(strands, 40e-6));
        let all: Vec<u32> = (0..24).collect();
        let roots: Vec<RigidTransform> = (0..24)
            .map(|s| RigidTransform { translation: groom.strand(s)[0], rotation: Quat::IDENTITY })
            .collect();
        let (positions, triangles) = balls(3, true);
        let grid = voxelize(&positions, &triangles, 0.004);
        let all_cells = SignedDistanceField { inside: Vec::new(), ..grid.clone() };
        let [skipped, unskipped] = [grid, all_cells].map(|grid| {
            let shape = ColliderShape::Field(Arc::new(grid));
            let gravity = Vec3::new(0.0, -9.81, 0.0);
            let (material, solver) = (Material::default(), Solver { sag_free: false, ..Solver::default() });
            let anchor = RigidTransform::default();
            let mut simulation = Simulation::builder(groom.clone())
                .strands(&all)
                .materials(&[material])
                .solver(solver)
                .gravity(gravity)
                .anchor(anchor)
                .build()
                .unwrap();
            let mut points = vec![Vec3::ZERO; simulation.point_count()];
            let mut touched = 0;
            for frame in 0..40 {
                let at = |frame: u32| RigidTransform {
                    translation: Vec3::X * (0.008 * frame as f32 - 0.25),
                    ..anchor
                };
                let colliders = [MovingCollider::new(shape.clone(), at(frame), at(frame + 1))];
                let air = Air::default();
                simulation.step(&StepInput {
                    dt: 1.0 / 60.0,
                    anchor,
                    roots: &roots,
                    colliders: &colliders,
                    air,
                });
                simulation.write_points(&mut points);
                let distance =
                    |p: &&Vec3| shape.distance(colliders[0].end.inverse_transform_point(**p)).abs();
                touched += points.iter().filter(|p| distance(p) < 1e-4).count();
            }
            assert!(touched > 100, "{touched} points in contact");
            points
        });
        assert_eq!(skipped, unskipped);
    }
}
