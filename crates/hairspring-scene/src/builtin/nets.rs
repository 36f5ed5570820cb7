//! Meshing by naive surface nets (Gibson 1998) over a grid with variable spacing.

use glam::{USizeVec3, Vec3, usizevec3};
use hairspring::body::Mesh;
use rayon::prelude::*;

/// Returns the positions of a grid's planes along one axis: from `from` to `to`, spaced by
/// `spacing(position)` (all [m]).
pub fn planes(from: f32, to: f32, spacing: impl Fn(f32) -> f32) -> Vec<f32> {
    let mut planes = vec![from];
    let mut at = from;
    while at < to {
        at += spacing(at);
        planes.push(at);
    }
    planes
}

/// Meshes the surface where `distance` is 0. The mesh is closed if the grid's border is outside the surface.
///
/// `axes` are the planes along x, y and z [m]. `distance` must not exceed the true distance by half or more.
/// The vertices lie on the surface; normals come from `normal`.
pub fn mesh(
    axes: &[Vec<f32>; 3],
    distance: impl Fn(Vec3) -> f32 + Sync,
    normal: impl Fn(Vec3) -> Vec3 + Sync,
) -> Mesh {
    let nodes = usizevec3(axes[0].len(), axes[1].len(), axes[2].len());
    let at = |n: USizeVec3| Vec3::new(axes[0][n.x], axes[1][n.y], axes[2][n.z]);
    let values = sample(nodes, at, &distance);
    let index = |n: USizeVec3| (n.z * nodes.y + n.y) * nodes.x + n.x;

    // One vertex in every cell that the surface crosses, at the mean of the crossings of its edges.
    let cells = nodes - 1;
    let mut vertex_of = vec![u32::MAX; values.len()];
    let mut mesh = Mesh::default();
    for cell in each(cells) {
        let corner = |c: usize| cell + usizevec3(c & 1, (c >> 1) & 1, c >> 2);
        let inside = (0..8).filter(|c| values[index(corner(*c))] < 0.0).count();
        if inside == 0 || inside == 8 {
            continue;
        }
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for a in 0..8usize {
            for b in [a | 1, a | 2, a | 4] {
                let (va, vb) = (values[index(corner(a))], values[index(corner(b))]);
                if (va < 0.0) != (vb < 0.0) {
                    sum += at(corner(a)).lerp(at(corner(b)), va / (va - vb));
                    count += 1.0;
                }
            }
        }
        vertex_of[index(cell)] = mesh.positions.len() as u32;
        mesh.positions.push(sum / count);
    }

    // One quad for every grid edge that crosses the surface, split into two triangles along the shorter
    // diagonal.
    for node in each(nodes) {
        for (axis, u, v) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            if node[axis] + 1 >= nodes[axis] || node[u] == 0 || node[v] == 0 {
                continue;
            }
            let mut next = node;
            next[axis] += 1;
            let (a, b) = (values[index(node)] < 0.0, values[index(next)] < 0.0);
            if a == b {
                continue;
            }
            let cell = |du: usize, dv: usize| {
                let mut c = node;
                c[u] -= du;
                c[v] -= dv;
                vertex_of[index(c)]
            };
            let mut quad = [cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)];
            if b {
                quad.reverse();
            }
            let p = quad.map(|i| mesh.positions[i as usize]);
            let split = if p[0].distance_squared(p[2]) < p[1].distance_squared(p[3]) { 0 } else { 1 };
            let q = |i: usize| quad[(i + split) % 4];
            mesh.triangles.push([q(0), q(1), q(2)]);
            mesh.triangles.push([q(0), q(2), q(3)]);
        }
    }
    settle(&mut mesh, distance, normal);
    mesh
}

/// Moves every vertex onto the surface and computes the normals.
pub fn settle(mesh: &mut Mesh, distance: impl Fn(Vec3) -> f32 + Sync, normal: impl Fn(Vec3) -> Vec3 + Sync) {
    mesh.positions.par_iter_mut().for_each(|p| {
        // Newton's method along the normal: two iterations are enough from within half a cell of a smooth
        // surface. Steps are limited so that a vertex at a crease stays in its cell.
        for _ in 0..2 {
            *p -= normal(*p) * distance(*p).clamp(-1e-3, 1e-3);
        }
    });
    mesh.normals = mesh.positions.par_iter().map(|p| normal(*p)).collect();
}

/// Iterates over all grid coordinates below `size`, x fastest.
fn each(size: USizeVec3) -> impl Iterator<Item = USizeVec3> {
    (0..size.z).flat_map(move |z| (0..size.y).flat_map(move |y| (0..size.x).map(move |x| usizevec3(x, y, z))))
}

/// Samples the distance at every node. Blocks of nodes far from the surface are filled with the value at
/// their center.
fn sample(
    nodes: USizeVec3,
    at: impl Fn(USizeVec3) -> Vec3 + Sync,
    distance: impl Fn(Vec3) -> f32 + Sync,
) -> Vec<f32> {
    /// Nodes along a block's edge.
    const BLOCK: usize = 6;
    let mut values = vec![0.0; nodes.x * nodes.y * nodes.z];
    values.par_chunks_mut(nodes.x * nodes.y * BLOCK).enumerate().for_each(|(slab, values)| {
        let z0 = slab * BLOCK;
        for y0 in (0..nodes.y).step_by(BLOCK) {
            for x0 in (0..nodes.x).step_by(BLOCK) {
                let (lo, hi) = (usizevec3(x0, y0, z0), (usizevec3(x0, y0, z0) + (BLOCK - 1)).min(nodes - 1));
                let (a, b) = (at(lo), at(hi));
                let middle = distance((a + b) * 0.5);
                // Factor 1.5: away from the surface, the shapes' distance may be wrong by that factor in
                // either direction.
                let far = middle.abs() > 0.75 * a.distance(b);
                for z in lo.z..=hi.z {
                    for y in lo.y..=hi.y {
                        for x in lo.x..=hi.x {
                            let value = if far { middle } else { distance(at(usizevec3(x, y, z))) };
                            values[((z - z0) * nodes.y + y) * nodes.x + x] = value;
                        }
                    }
                }
            }
        }
    });
    values
}
