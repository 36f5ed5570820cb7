//! From a closed triangle mesh to its signed distance field, fast enough to do anew each frame for a skinned body.
//!
//! Exact distances in a band around the surface (each triangle visits the nodes near it), the sign by counting oriented
//! crossings along x, so that overlapping closed pieces unite; deep inside, distances are extended by fast sweeping
//! (Zhao 2005), so that a point that got there still knows the way out; far outside they stay at the band's width.
//! The layout follows Bridson's SDFGen (*Fluid Simulation for Computer Graphics*, 2nd ed., §4).

use super::{
    Grid,
    lattice::{self, Lattice},
};
use crate::body::nearest_on_triangle;
use glam::{DVec2, Vec3};
use rayon::prelude::*;

/// Half-width of the band of exact distances, in cells.
const BAND: f32 = 2.0;

/// Largest number of nodes of a grid; the cell grows until it fits. 4 Mi nodes: 16 MiB.
const MAX_NODES: usize = lattice::MAX_NODES / 2;

/// Builds the field of a closed mesh with cells of about `cell` [m].
pub fn voxelize(positions: &[Vec3], triangles: &[[u32; 3]], cell: f32) -> Grid {
    let mut grid = Grid::default();
    Voxelizer::default().update(&mut grid, positions, None, triangles, None, cell);
    grid
}

/// Builds fields again and again without allocating, once its buffers have grown.
#[derive(Default)]
pub struct Voxelizer {
    /// Triangles that come near each layer of nodes in z.
    layers: Vec<Vec<u32>>,
    /// Entries (+) and exits (−) of the surface before each node, along x.
    crossings: Vec<i16>,
}

impl Voxelizer {
    /// Makes `grid` the field of the mesh. `before`, where given, holds the vertices one interval ago in the same
    /// space: the grid then also carries how far the surface moved.
    ///
    /// The grid covers the mesh with a margin of the band, but no more than the box `within` (min, max) [m] where that is
    /// given, in cells of `cell` [m] or larger where that would be too many. A mesh without triangles gives a field that
    /// is far from everything.
    pub fn update(
        &mut self,
        grid: &mut Grid,
        positions: &[Vec3],
        before: Option<&[Vec3]>,
        triangles: &[[u32; 3]],
        within: Option<(Vec3, Vec3)>,
        cell: f32,
    ) {
        let used = || triangles.iter().flatten().map(|i| positions[*i as usize]).filter(|p| p.is_finite());
        let lo = used().fold(Vec3::splat(f32::MAX), Vec3::min);
        let hi = used().fold(Vec3::splat(f32::MIN), Vec3::max);
        let (lo, hi) = within.map_or((lo, hi), |(a, b)| (lo.max(a), hi.min(b)));
        // Nothing of the mesh within: a grid of a few nodes, at a corner of the box, which then lies outside.
        let nowhere = within.map_or(Vec3::ZERO, |(a, _)| a);
        let (lo, hi) = if lo.cmple(hi).all() { (lo, hi) } else { (nowhere, nowhere) };
        let lattice = Lattice::covering(lo, hi, BAND + 0.5, cell, MAX_NODES);
        (grid.origin, grid.cell, grid.size) = (lattice.origin, lattice.cell, lattice.size);
        let cell = grid.cell;
        let (nx, ny, nz) = (grid.size.x as usize, grid.size.y as usize, grid.size.z as usize);
        let count = nx * ny * nz;
        grid.distances.clear();
        grid.distances.resize(count, BAND * cell);
        grid.displacements.clear();
        grid.displacements.resize(if before.is_some() { count } else { 0 }, Vec3::ZERO);
        self.crossings.clear();
        self.crossings.resize(count, 0);

        // Which triangles come near which layer.
        self.layers.resize_with(nz.max(self.layers.len()), Vec::new);
        self.layers.iter_mut().for_each(Vec::clear);
        let origin = grid.origin;
        let corners = |t: u32| triangles[t as usize].map(|i| (positions[i as usize] - origin) / cell);
        for t in 0..triangles.len() as u32 {
            let c = corners(t);
            if !c.iter().all(|p| p.is_finite()) {
                continue;
            }
            let z0 = (c[0].z.min(c[1].z).min(c[2].z) - BAND).max(0.0) as usize;
            let z1 = c[0].z.max(c[1].z).max(c[2].z) + BAND;
            if z1 >= 0.0 && z0 < nz {
                self.layers[z0..=(z1 as usize).min(nz - 1)].iter_mut().for_each(|l| l.push(t));
            }
        }

        // Distances and crossings, a layer at a time.
        let moved = |t: u32, weights: Vec3| {
            let before = before.expect("displacements are only kept with a pose before");
            let own = |k: usize| {
                let i = triangles[t as usize][k] as usize;
                (positions[i] - before[i]) * weights[k]
            };
            own(0) + own(1) + own(2)
        };
        let mut no_displacements: Vec<[Vec3; 0]> = vec![[]; nz];
        let displaced: Vec<&mut [Vec3]> = if before.is_some() {
            grid.displacements.chunks_mut(nx * ny).collect()
        } else {
            no_displacements.iter_mut().map(|e| e.as_mut_slice()).collect()
        };
        let layers = &self.layers;
        grid.distances
            .par_chunks_mut(nx * ny)
            .zip(self.crossings.par_chunks_mut(nx * ny))
            .zip(displaced)
            .enumerate()
            .for_each(|(z, ((distances, crossings), displaced))| {
                for &t in &layers[z] {
                    let c = corners(t);
                    let [lo, hi] = [c[0].min(c[1]).min(c[2]), c[0].max(c[1]).max(c[2])];
                    let range = |lo: f32, hi: f32, n: usize| {
                        (lo - BAND).ceil().max(0.0) as usize
                            ..((hi + BAND).max(-1.0) + 1.0).min(n as f32) as usize
                    };
                    let normal = (c[1] - c[0]).cross(c[2] - c[0]).normalize_or_zero();
                    for y in range(lo.y, hi.y, ny) {
                        for x in range(lo.x, hi.x, nx) {
                            let p = Vec3::new(x as f32, y as f32, z as f32);
                            // Most nodes of the box are too far from the plane to be looked at closer.
                            if normal.dot(p - c[0]).abs() > BAND {
                                continue;
                            }
                            let weights = nearest_on_triangle(p, c);
                            let d =
                                (c[0] * weights.x + c[1] * weights.y + c[2] * weights.z).distance(p) * cell;
                            let at = y * nx + x;
                            if d < distances[at] {
                                distances[at] = d;
                                if let Some(slot) = displaced.get_mut(at) {
                                    *slot = moved(t, weights);
                                }
                            }
                        }
                    }
                    if lo.z <= z as f32 && z as f32 <= hi.z {
                        count_crossings(&c, z, (nx, ny), crossings);
                    }
                }
                // Winding along x: inside where more surfaces were entered than left.
                for (row, crossing) in distances.chunks_mut(nx).zip(crossings.chunks(nx)) {
                    let mut winding = 0;
                    for (d, c) in row.iter_mut().zip(crossing) {
                        winding += *c;
                        if winding > 0 {
                            *d = -*d;
                        }
                    }
                }
            });
        sweep_inside(grid);
        grid.mark_inside();
    }
}

/// Extends distances through the inside beyond the band: one round of fast sweeping for |∇d| = 1 (Zhao 2005).
fn sweep_inside(grid: &mut Grid) {
    let (nx, ny, nz) = (grid.size.x as usize, grid.size.y as usize, grid.size.z as usize);
    let known = -(BAND - 0.01) * grid.cell;
    // Deeper than any way out of the grid.
    let far = -((nx + ny + nz) as f32 * grid.cell);
    let inside: Vec<usize> = (0..grid.distances.len()).filter(|i| grid.distances[*i] <= known).collect();
    inside.iter().for_each(|i| grid.distances[*i] = far);
    let (sy, sz) = (nx, nx * ny);
    let mut update = |i: usize| {
        let d = &grid.distances;
        // The nearer of both neighbours on each axis, as positive depths; a grid that cuts through the mesh has inside
        // nodes on its border, which have one.
        let axis = |at: usize, n: usize, stride: usize| {
            let before = if at > 0 { d[i - stride] } else { far };
            before.max(if at + 1 < n { d[i + stride] } else { far })
        };
        let mut a = [axis(i % nx, nx, 1), axis(i / nx % ny, ny, sy), axis(i / sz, nz, sz)].map(|d| -d);
        a.sort_by(f32::total_cmp);
        let h = grid.cell;
        let mut u = a[0] + h;
        if u > a[1] {
            u = 0.5 * (a[0] + a[1] + (2.0 * h * h - (a[0] - a[1]).powi(2)).max(0.0).sqrt());
            if u > a[2] {
                let s = a[0] + a[1] + a[2];
                let q = s * s - 3.0 * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2] - h * h);
                u = (s + q.max(0.0).sqrt()) / 3.0;
            }
        }
        if u < -grid.distances[i] {
            grid.distances[i] = -u;
        }
    };
    inside.iter().for_each(|i| update(*i));
    inside.iter().rev().for_each(|i| update(*i));
}

/// Adds the oriented crossings of one triangle with the lines y = const of layer `z`.
fn count_crossings(c: &[Vec3; 3], z: usize, (nx, ny): (usize, usize), crossings: &mut [i16]) {
    // In f64 and with the vertices in a fixed order, so that an edge shared by two triangles is decided alike.
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
        let node = x.ceil().max(0.0) as usize;
        if node < nx {
            // The normal's x is the projected triangle's signed area: positive leaves, negative enters.
            crossings[y * nx + node] += if all(true) { -1 } else { 1 };
        }
    }
}

/// On which side of the line a→b `q` lies, with points on the line given to one side by the order of the ends
/// (simulation of simplicity), and twice the signed area.
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

    /// An octahedron's surface, subdivided onto the sphere of `radius` around `center`.
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
        // Cut on every side: no surface left or right of the box tells where the inside begins.
        let within = (Vec3::new(-0.05, -0.02, -0.06), Vec3::new(0.04, 0.3, 0.05));
        let mut part = Grid::default();
        Voxelizer::default().update(&mut part, &positions, None, &triangles, Some(within), 0.005);
        assert!(part.distances.len() * 3 < whole.distances.len());
        for i in 0..2000u32 {
            let hash = |k: u32| ((i * 4 + k).wrapping_mul(0x9E37_79B9) >> 8) as f32 / (1 << 24) as f32;
            let p = Vec3::new(-0.05, -0.02, -0.06)
                + Vec3::new(hash(0), hash(1), hash(2)) * Vec3::new(0.09, 0.13, 0.11);
            let (a, b) = (whole.distance_and_normal(p).0, part.distance_and_normal(p).0);
            // Deep inside, the way out within the box may be longer.
            assert!(
                (a - b).abs() < 0.0015 || (a < -0.009 && b <= a + 0.0015 && b > -0.2),
                "at {p}: {a} and {b}"
            );
        }
        let away = Some((Vec3::splat(1.0), Vec3::splat(2.0)));
        Voxelizer::default().update(&mut part, &positions, None, &triangles, away, 0.005);
        assert!(part.distance_and_normal(Vec3::splat(1.5)).0 > 0.0);
    }

    #[test]
    fn an_empty_mesh_is_far_from_everything() {
        let grid = voxelize(&[], &[], 0.01);
        assert!(grid.distance_and_normal(Vec3::splat(0.3)).0 > 0.0);
    }
}
