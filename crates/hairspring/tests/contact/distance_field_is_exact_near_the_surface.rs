//! Promise: a distance field is exact at every node near its surface, and stores the motion of the surface
//! there.
//!
//! The voxelizer computes eight nodes at once from planes and edges. Here a bounding-volume tree checks
//! every node triangle by triangle, on a flattened ball with a degenerate triangle.

use glam::Vec3;
use hairspring::{
    body::{Mesh, NearestTree},
    collide::{SignedDistanceField, Voxelizer, VoxelizerInput},
};
use std::f32::consts::{PI, TAU};

/// Half-width of the band [cells].
const BAND: f32 = 2.0;

#[test]
fn nodes_near_the_surface_have_exact_distance_and_motion() {
    let (rows, columns) = (14, 23);
    let mut mesh = Mesh::default();
    for r in 0..=rows {
        for c in 0..columns {
            let (s, y) = (r as f32 * PI / rows as f32).sin_cos();
            let (z, x) = (c as f32 * TAU / columns as f32).sin_cos();
            mesh.positions.push(Vec3::new(0.1 * s * x + 0.01, 0.07 * y, 0.1 * s * z + 0.003));
        }
    }
    for r in 1..rows - 1 {
        for c in 0..columns {
            let i = |r: u32, c: u32| r * columns + c % columns;
            let [a, b, d, e] = [i(r, c), i(r, c + 1), i(r + 1, c), i(r + 1, c + 1)];
            mesh.triangles.extend([[a, b, e], [a, e, d]]);
        }
    }
    for c in 0..columns {
        let (top, bottom) = (columns, (rows - 1) * columns);
        mesh.triangles.push([0, top + (c + 1) % columns, top + c]);
        mesh.triangles.push([rows * columns, bottom + c, bottom + (c + 1) % columns]);
    }
    let tree = NearestTree::new(&mesh);
    let moved = |p: Vec3| Vec3::new(0.1 * p.y, 0.0, 0.002);
    let before: Vec<Vec3> = mesh.positions.iter().map(|p| *p - moved(*p)).collect();
    let mut triangles = mesh.triangles.clone();
    triangles.push([40, 40, 40]);
    let (mut grid, cell) = (SignedDistanceField::default(), 0.011);
    let input = VoxelizerInput::new(&mesh.positions, &triangles, cell);
    Voxelizer::default().update(&mut grid, &VoxelizerInput { previous_positions: Some(&before), ..input });
    let mut count = 0;
    for (i, d) in grid.distances().iter().enumerate() {
        let (i, size) = (i as u32, grid.size());
        let at = [i % size.x, i / size.x % size.y, i / size.x / size.y];
        let p = grid.origin() + Vec3::from(at.map(|n| n as f32)) * grid.cell();
        let nearest = tree.nearest(p, |_| true).unwrap();
        let exact = nearest.distance_squared.sqrt();
        if exact > 0.98 * BAND * cell {
            assert!(d.abs() > 0.97 * BAND * cell, "at {p}: {d} instead of {exact}");
            continue;
        }
        count += 1;
        assert!((d.abs() - exact).abs() < 1e-6, "at {p}: {d} instead of {exact}");
        let corners = mesh.corners(nearest.triangle as usize);
        let foot: Vec3 = corners.iter().zip(nearest.barycentric.to_array()).map(|(c, w)| *c * w).sum();
        let found = grid.displacement(p);
        assert!((found - moved(foot)).length() < 1e-5, "at {p}: {found} instead of {}", moved(foot));
    }
    assert!(count > 1000, "only {count} nodes");
}
