//! Builds the signed distance field of a closed triangle mesh, fast enough to repeat every frame for a
//! skinned body.
//!
//! Distances are exact in a band around the surface: each triangle visits the nodes near it. The sign comes
//! from counting oriented crossings along x, so overlapping closed pieces are united. Deep inside, distances
//! are extended ([`deep_interior`]), so that a point there is still led out. Far outside they stay at the
//! width of the band. The layout follows Bridson's SDFGen (*Fluid Simulation for Computer Graphics*, 2nd ed.,
//! §4).

use super::{
    SignedDistanceField, deep_interior,
    holes::Holes,
    lattice::{self, Lattice},
};
use crate::parallel::prelude::*;
use crate::simd::{
    dispatch::dispatch,
    lanes::{F, LANES, Simd, V3},
};
use fearless_simd::Level;
use glam::{DVec2, UVec3, Vec3};
use std::ops::Range;

/// Half-width of the band of exact distances, in cells.
pub(super) const BAND: f32 = 2.0;

/// Maximum number of nodes of a grid; the cell is enlarged until it fits. 4 Mi nodes take 16 MiB.
const MAX_NODES: usize = lattice::MAX_NODES / 2;

/// Smallest squared edge of a triangle that is divided by [cells²].
const MIN_SQUARED_EDGE: f32 = 1e-12;

/// Builds the field of a closed mesh with cells of about `cell` [m].
///
/// For an example, see [`collide`](crate::collide).
///
/// # Panics
/// If a triangle names a vertex that does not exist.
pub fn voxelize(positions: &[Vec3], triangles: &[[u32; 3]], cell: f32) -> SignedDistanceField {
    let mut grid = SignedDistanceField::default();
    Voxelizer::default().update(&mut grid, &VoxelizerInput::new(positions, triangles, cell));
    grid
}

/// Input of a [`Voxelizer`]: a closed mesh, and the grid of its field.
///
/// For an example, see [`Voxelizer`].
#[derive(Clone, Copy, Debug)]
pub struct VoxelizerInput<'a> {
    /// Vertices of the mesh [m].
    pub positions: &'a [Vec3],
    /// Vertices one interval ago in the same space [m], if the mesh deforms. The field then also stores how far the
    /// surface moved.
    pub previous_positions: Option<&'a [Vec3]>,
    /// Vertices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// Box to which the grid is clipped, (min, max) [m].
    pub within: Option<(Vec3, Vec3)>,
    /// Edge of a cell [m]. Cells are larger if there would be too many.
    pub cell: f32,
}

impl<'a> VoxelizerInput<'a> {
    /// Describes the field of a whole mesh that does not deform, with cells of `cell` [m].
    pub fn new(positions: &'a [Vec3], triangles: &'a [[u32; 3]], cell: f32) -> Self {
        Self { positions, previous_positions: None, triangles, within: None, cell }
    }
}

/// Builds fields repeatedly, without allocating once its buffers have grown.
///
/// ```
/// use glam::Vec3;
/// use hairspring::collide::{SignedDistanceField, Voxelizer, VoxelizerInput};
///
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let (mut voxelizer, mut field) = (Voxelizer::default(), SignedDistanceField::default());
/// voxelizer.update(&mut field, &VoxelizerInput::new(&corners, &triangles, 0.1));
/// assert!(field.distance_and_normal(Vec3::splat(0.1)).0 < 0.0);
/// ```
#[derive(Default)]
pub struct Voxelizer {
    triangles: Vec<Flat>,
    /// Triangles near each layer of nodes in z.
    layers: Vec<Vec<u32>>,
    benches: Vec<Bench>,
    holes: Holes,
}

impl std::fmt::Debug for Voxelizer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Voxelizer").finish_non_exhaustive()
    }
}

impl Voxelizer {
    /// Rebuilds `grid` as the field of the mesh. The grid covers the mesh with a margin of the band, clipped to
    /// `input.within`. A mesh without triangles gives a field in which every point is far outside.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist, also in `input.previous_positions`.
    pub fn update(&mut self, grid: &mut SignedDistanceField, input: &VoxelizerInput) {
        let VoxelizerInput { positions, previous_positions, triangles, within, cell } = *input;
        let used = || triangles.iter().flatten().map(|i| positions[*i as usize]).filter(|p| p.is_finite());
        let lo = used().fold(Vec3::splat(f32::MAX), Vec3::min);
        let hi = used().fold(Vec3::splat(f32::MIN), Vec3::max);
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        // If no part of the mesh is within the box, use a grid of a few nodes at a corner of the box, which
        // is then outside.
        let nowhere = within.map_or(Vec3::ZERO, |(a, _)| a);
        let (lo, hi) = if lo.cmple(hi).all() { (lo, hi) } else { (nowhere, nowhere) };
        let lattice = Lattice::covering(lo, hi, BAND + 0.5, cell, MAX_NODES);
        grid.begin(lattice, positions, previous_positions, triangles);
        let size = lattice.size.as_usizevec3();

        // Assign the triangles to the layers that they are near to.
        self.triangles.clear();
        self.layers.resize_with(size.z.max(self.layers.len()), Vec::new);
        self.layers.iter_mut().for_each(Vec::clear);
        for (number, t) in triangles.iter().enumerate() {
            let corners = t.map(|i| (positions[i as usize] - lattice.origin) / lattice.cell);
            let Some(flat) = Flat::new(corners, number as u32) else { continue };
            let [_, _, layers] = flat.near(lattice.size);
            if !layers.is_empty() {
                self.layers[layers].iter_mut().for_each(|layer| layer.push(self.triangles.len() as u32));
                self.triangles.push(flat);
            }
        }

        // Use a few scratch buffers for each thread, each for several consecutive layers. Layers are
        // independent, so the result does not depend on the threads.
        let each = size.z.div_ceil(4 * crate::parallel::current_num_threads());
        self.benches.resize_with(size.z.div_ceil(each), Bench::default);
        let (flats, layers, level) = (&self.triangles, &self.layers, Level::new());
        let span = each * size.x * size.y;
        let parts = grid.distances.par_chunks_mut(span).zip(grid.nearest.par_chunks_mut(span));
        self.benches.par_iter_mut().zip(parts).enumerate().for_each(
            |(part, (bench, (distances, nearest)))| {
                bench.deep.clear();
                bench.open.clear();
                let slabs = distances.chunks_mut(size.x * size.y).zip(nearest.chunks_mut(size.x * size.y));
                for (z, (distances, nearest)) in (part * each..).zip(slabs) {
                    bench.begin(lattice.size);
                    for t in &layers[z] {
                        let flat = &flats[*t as usize];
                        dispatch!(level, simd => bench.measure(simd, flat, z, lattice.size));
                        count_crossings(&flat.corners, z, (size.x, size.y), &mut bench.crossings);
                    }
                    bench.finish(&lattice, z, distances, nearest);
                }
            },
        );
        let (open, deep) =
            (self.benches.iter().flat_map(|b| &b.open), self.benches.iter().flat_map(|b| &b.deep));
        let deep = self.holes.mend(grid, open.copied(), deep.copied());
        deep_interior::extend(grid, deep.iter().copied());
        grid.mark_inside();
    }
}

/// A triangle in units of cells, with precomputed values.
struct Flat {
    corners: [Vec3; 3],
    /// Vectors from each corner to the next, and the reciprocals of their squared lengths.
    edges: [Vec3; 3],
    inverse: [f32; 3],
    /// Unit normal; zero if the corners are collinear.
    normal: Vec3,
    /// Outward across each edge, in the plane of the triangle.
    out: [Vec3; 3],
    /// Index of the triangle in the mesh.
    number: u32,
}

impl Flat {
    /// Returns `None` if a corner is not finite.
    fn new(corners: [Vec3; 3], number: u32) -> Option<Self> {
        let [a, b, c] = corners;
        let edges = [b - a, c - b, a - c];
        let normal = edges[0].cross(c - a).normalize_or_zero();
        let inverse = edges.map(|e| 1.0 / e.length_squared().max(MIN_SQUARED_EDGE));
        let out = edges.map(|e| e.cross(normal));
        corners.iter().all(|p| p.is_finite()).then_some(Self { corners, edges, inverse, normal, out, number })
    }

    /// Returns the range of nodes along each axis that may lie in its band.
    fn near(&self, size: UVec3) -> [Range<usize>; 3] {
        let [a, b, c] = self.corners;
        let (lo, hi) = ((a.min(b).min(c) - BAND).ceil(), (a.max(b).max(c) + BAND).floor());
        std::array::from_fn(|k| {
            let end = (hi[k] + 1.0).clamp(0.0, size[k] as f32) as usize;
            (lo[k].max(0.0) as usize).min(end)..end
        })
    }
}

/// Scratch buffers for several layers of a field. The layers are processed one after the other, so that the
/// buffers stay in cache.
#[derive(Default)]
struct Bench {
    /// Squared distance to the surface [cells²]. Rows are padded, so that eight nodes can be accessed from
    /// any node on.
    squared: Vec<f32>,
    /// Index of the nearest triangle, stored as the bits of an `f32`. It is only selected, never used in
    /// arithmetic.
    nearest: Vec<f32>,
    /// Entries (+) and exits (−) of the surface before each node along x, and after the last node.
    crossings: Vec<i16>,
    /// Rows that a triangle is near to.
    seen: Vec<bool>,
    /// Runs of nodes in a row that are deeper than the band: layer, row, first and end.
    deep: Vec<[u32; 4]>,
    /// Rows that pass through a hole: layer, row.
    open: Vec<[u32; 2]>,
}

impl Bench {
    /// Starts an empty layer.
    fn begin(&mut self, size: UVec3) {
        let (nx, ny) = (size.x as usize, size.y as usize);
        let places = ny * (nx + LANES);
        self.squared.clear();
        self.squared.resize(places, BAND * BAND);
        // Nodes outside the band have no nearest triangle, and their value is never read.
        self.nearest.resize(places, 0.0);
        self.crossings.clear();
        self.crossings.resize((nx + 1) * ny, 0);
        self.seen.clear();
        self.seen.resize(ny, false);
    }

    /// Computes exact distances from the triangle to the nodes of layer `z` in its band, eight nodes of a row
    /// at a time: the distance to the plane if the node projects onto the triangle, else that to the nearest
    /// edge.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn measure<S: Simd>(&mut self, simd: S, flat: &Flat, z: usize, size: UVec3) {
        let stride = size.x as usize + LANES;
        let [columns, rows, _] = flat.near(size);
        let normal = flat.normal;
        let lane = F::from_slice(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let number = F::splat(simd, f32::from_bits(flat.number));
        let (zero, one) = (F::splat(simd, 0.0), F::splat(simd, 1.0));
        for y in rows {
            // Most nodes of the box are too far from the plane and are skipped.
            let row = Vec3::new(0.0, y as f32, z as f32);
            let (off, slack) = (normal.dot(row - flat.corners[0]), BAND + 1e-3);
            let (mut first, mut end) = (columns.start as f32, columns.end as f32);
            if normal.x.abs() > 1e-3 {
                let (p, q) = ((-slack - off) / normal.x, (slack - off) / normal.x);
                (first, end) = (first.max(p.min(q).ceil()), end.min(p.max(q).floor() + 1.0));
            } else if off.abs() > slack + 1e-3 * stride as f32 {
                continue;
            }
            self.seen[y] |= first < end;
            let mut x = first;
            while x < end {
                let mut squared = F::splat(simd, f32::MAX);
                let mut within = zero.simd_eq(zero);
                // Only x varies along a row.
                for k in 0..3 {
                    let from = row + Vec3::X * x - flat.corners[k];
                    let (edge, out) = (flat.edges[k], flat.out[k]);
                    let along = lane.mul_add(edge.x * flat.inverse[k], from.dot(edge) * flat.inverse[k]);
                    let share = along.max(zero).min(one);
                    let d = V3 {
                        x: share.mul_add(-edge.x, lane + from.x),
                        y: share.mul_add(-edge.y, from.y),
                        z: share.mul_add(-edge.z, from.z),
                    };
                    squared = squared.min(d.dot(d));
                    within &= lane.mul_add(out.x, from.dot(out)).simd_lt(zero);
                }
                let above = lane.mul_add(normal.x, off + normal.x * x);
                squared = within.select(above * above, squared);
                let place = y * stride + x as usize;
                let best = F::from_slice(simd, &self.squared[place..place + LANES]);
                let nearer = squared.simd_lt(best);
                if nearer.any_true() {
                    let who = F::from_slice(simd, &self.nearest[place..place + LANES]);
                    nearer.select(squared, best).store_slice(&mut self.squared[place..place + LANES]);
                    nearer.select(number, who).store_slice(&mut self.nearest[place..place + LANES]);
                }
                x += LANES as f32;
            }
        }
    }

    /// Computes the signed distances [m] and nearest triangles of layer `z`. The sign comes from the winding
    /// along x: a node is inside if more surfaces were entered than left.
    fn finish(&mut self, lattice: &Lattice, z: usize, distances: &mut [f32], nearest: &mut [u32]) {
        let nx = lattice.size.x as usize;
        let rows = self.squared.chunks(nx + LANES).zip(self.nearest.chunks(nx + LANES));
        let rows = rows.zip(self.crossings.chunks(nx + 1)).enumerate();
        let out = distances.chunks_mut(nx).zip(nearest.chunks_mut(nx));
        for ((y, ((squared, who), crossings)), (distances, nearest)) in rows.zip(out) {
            if self.seen[y] {
                distances.iter_mut().zip(squared).for_each(|(d, squared)| *d = squared.sqrt() * lattice.cell);
                nearest.copy_from_slice(bytemuck::cast_slice(&who[..nx]));
            } else {
                distances.fill(BAND * lattice.cell);
            }
            if crossings.iter().fold(0, |any, c| any | c) == 0 {
                continue;
            }
            let mut winding = 0;
            for (d, crossing) in distances.iter_mut().zip(crossings) {
                winding += crossing;
                if winding > 0 {
                    *d = -*d;
                }
            }
            // A row through a closed mesh leaves as many surfaces as it enters.
            let at = [z, y].map(|i| i as u32);
            if winding + crossings[nx] == 0 {
                deep_interior::push(at, distances, lattice.cell, &mut self.deep);
            } else {
                self.open.push(at);
            }
        }
    }
}

/// Adds the oriented crossings of one triangle with the lines y = const of layer `z`.
fn count_crossings(c: &[Vec3; 3], z: usize, (nx, ny): (usize, usize), crossings: &mut [i16]) {
    if c.iter().all(|v| v.z < z as f32) || c.iter().all(|v| v.z > z as f32) {
        return;
    }
    // Uses f64 and a fixed vertex order, so that an edge shared by two triangles gives the same result for
    // both.
    let p = c.map(|v| DVec2::new(v.y as f64, v.z as f64));
    let y0 = p[0].x.min(p[1].x).min(p[2].x).ceil().max(0.0) as usize;
    let y1 = p[0].x.max(p[1].x).max(p[2].x).floor().min(ny as f64 - 1.0);
    if y1 < 0.0 {
        return;
    }
    for y in y0..=(y1 as usize) {
        let q = DVec2::new(y as f64, z as f64);
        let w = [side(p[1], p[2], q), side(p[2], p[0], q), side(p[0], p[1], q)];
        let all = |s: bool| w.iter().all(|(positive, _)| *positive == s);
        if !all(true) && !all(false) {
            continue;
        }
        let sum = w[0].1 + w[1].1 + w[2].1;
        if sum == 0.0 {
            continue;
        }
        let x = (w[0].1 * c[0].x as f64 + w[1].1 * c[1].x as f64 + w[2].1 * c[2].x as f64) / sum;
        let node = x.ceil().clamp(0.0, nx as f64) as usize;
        // The x component of the normal is the signed area of the projected triangle: positive exits,
        // negative enters.
        crossings[y * (nx + 1) + node] += if all(true) { -1 } else { 1 };
    }
}

/// Returns the side of the line a→b on which `q` lies, and twice the signed area. Points on the line are
/// assigned to one side by the order of the ends (simulation of simplicity).
fn side(a: DVec2, b: DVec2, q: DVec2) -> (bool, f64) {
    let swap = (a.x, a.y) > (b.x, b.y);
    let (s, t) = if swap { (b, a) } else { (a, b) };
    let area = (t - s).perp_dot(q - s);
    let area = if swap { -area } else { area };
    (if area == 0.0 { !swap } else { area > 0.0 }, area)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A subdivided octahedron projected onto the sphere of `radius` around `center`.
    fn ball(center: Vec3, radius: f32, levels: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let v = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
        let mut faces: Vec<[Vec3; 3]> =
            [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
                .map(|f: [usize; 3]| f.map(|i| v[i]))
                .to_vec();
        for _ in 0..levels {
            faces = faces
                .iter()
                .flat_map(|&[a, b, c]| {
                    let m = |p: Vec3, q: Vec3| (p + q).normalize();
                    let (ab, bc, ca) = (m(a, b), m(b, c), m(c, a));
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        let positions = faces.iter().flatten().map(|p| *p * radius + center).collect();
        (positions, (0..faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect())
    }

    #[test]
    fn a_ball_has_the_distances_of_a_ball_inside_and_out() {
        let (center, radius) = (Vec3::new(0.3, 1.2, -0.1), 0.1);
        let (positions, triangles) = ball(center, radius, 4);
        let grid = voxelize(&positions, &triangles, 0.005);
        for i in 0..2000u32 {
            let hash = |k: u32| ((i * 4 + k).wrapping_mul(0x9E37_79B9) >> 8) as f32 / (1 << 24) as f32 - 0.5;
            let p = center + Vec3::new(hash(0), hash(1), hash(2)) * 0.24;
            let (d, n) = grid.distance_and_normal(p);
            let exact = p.distance(center) - radius;
            let tolerance = if exact.abs() < 0.003 { 0.0005 } else { 0.004 };
            if exact < 0.009 {
                assert!((d - exact).abs() < tolerance, "at {p}: {d} instead of {exact}");
            } else {
                assert!(d > 0.008, "at {p}: {d} instead of {exact}");
            }
            if exact.abs() < 0.003 {
                assert!(n.dot((p - center).normalize()) > 0.995, "normal at {p}: {n}");
            }
        }
    }

    #[test]
    fn two_overlapping_balls_unite() {
        let (mut positions, mut triangles) = ball(Vec3::ZERO, 0.1, 3);
        let (other, more) = ball(Vec3::new(0.1, 0.0, 0.0), 0.1, 3);
        let first = positions.len() as u32;
        positions.extend(other);
        triangles.extend(more.iter().map(|t| t.map(|i| i + first)));
        let grid = voxelize(&positions, &triangles, 0.005);
        assert!(grid.distance_and_normal(Vec3::new(0.05, 0.0, 0.0)).0 < 0.0);
        assert!(grid.distance_and_normal(Vec3::new(0.05, 0.12, 0.0)).0 > 0.0);
    }

    #[test]
    fn a_box_that_cuts_through_a_ball_has_the_same_distances_within() {
        let (positions, triangles) = ball(Vec3::ZERO, 0.1, 4);
        let whole = voxelize(&positions, &triangles, 0.005);
        // The box cuts the ball on every side, so no surface left or right of it shows where the inside
        // begins.
        let within = (Vec3::new(-0.05, -0.02, -0.06), Vec3::new(0.04, 0.3, 0.05));
        let mut part = SignedDistanceField::default();
        let input = VoxelizerInput::new(&positions, &triangles, 0.005);
        Voxelizer::default().update(&mut part, &VoxelizerInput { within: Some(within), ..input });
        assert!(part.distances.len() * 3 < whole.distances.len());
        for i in 0..2000u32 {
            let hash = |k: u32| ((i * 4 + k).wrapping_mul(0x9E37_79B9) >> 8) as f32 / (1 << 24) as f32;
            let p = Vec3::new(-0.05, -0.02, -0.06)
                + Vec3::new(hash(0), hash(1), hash(2)) * Vec3::new(0.09, 0.13, 0.11);
            let (a, b) = (whole.distance_and_normal(p).0, part.distance_and_normal(p).0);
            // Deep inside, the distance to the surface within the box may be longer.
            assert!(
                (a - b).abs() < 0.0015 || (a < -0.009 && b <= a + 0.0015 && b > -0.2),
                "at {p}: {a} and {b}"
            );
        }
        let away = Some((Vec3::splat(1.0), Vec3::splat(2.0)));
        Voxelizer::default().update(&mut part, &VoxelizerInput { within: away, ..input });
        assert!(part.distance_and_normal(Vec3::splat(1.5)).0 > 0.0);
    }

    #[test]
    fn an_empty_mesh_is_far_from_everything() {
        let grid = voxelize(&[], &[], 0.01);
        assert!(grid.distance_and_normal(Vec3::splat(0.3)).0 > 0.0);
    }
}
