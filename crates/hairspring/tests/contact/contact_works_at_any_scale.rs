//! Promise: colliders keep hair out at a tenth and at ten times the size of a head as at that size.
//!
//! Hair falls over each shape, moves with it, and comes to rest. Lengths, radii and gravity are multiplied
//! by a scale, and the fiber's stiffness by its square; then the motion is the same except for lengths. At
//! any scale, no point is deeper than a hundred-thousandth of the strand's length. A second later, every
//! point is where it is at the size of a head, within half a hundredth of that length.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, Hull, MovingCollider, ThinShell, voxelize},
    groom::Groom,
    material::Material,
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{REST, farthest, points, roots, step, translation};
use std::sync::Arc;

const LENGTH: f32 = 0.2;

/// Corners of a box around the origin, and its triangles.
fn cuboid(half: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner =
        |k: usize| Vec3::new([-1.0, 1.0][k & 1], [-1.0, 1.0][k >> 1 & 1], [-1.0, 1.0][k >> 2]) * half;
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    ((0..8).map(corner).collect(), triangles)
}

fn shapes(s: f32) -> [(&'static str, ColliderShape); 7] {
    let half = Vec3::new(0.08, 0.03, 0.05) * s;
    let (corners, triangles) = cuboid(half);
    let flat: Vec<Vec3> = corners.iter().map(|p| p.with_y(0.03 * s)).collect();
    [
        ("sphere", ColliderShape::Sphere { center: Vec3::Y * -0.03 * s, radius: 0.06 * s }),
        ("capsule", ColliderShape::Capsule { a: Vec3::X * -0.1 * s, b: Vec3::X * 0.1 * s, radius: 0.03 * s }),
        ("box", ColliderShape::Cuboid { center: Vec3::ZERO, half, axes: Mat3::IDENTITY }),
        ("plane", ColliderShape::Plane { point: Vec3::Y * 0.03 * s, normal: Vec3::new(0.0, 0.995, 0.0999) }),
        ("field", ColliderShape::Field(Arc::new(voxelize(&corners, &triangles, 0.004 * s)))),
        ("hull", ColliderShape::Hull(Arc::new(Hull::new(&corners).unwrap()))),
        ("sheet", ColliderShape::Sheet(Arc::new(ThinShell::new(&flat, &triangles[4..6], 0.004 * s)))),
    ]
}

/// The points after a second, and the largest penetration, divided by the scale.
fn fall(shape: &ColliderShape, s: f32) -> (Vec<Vec3>, f32) {
    let strands = (0..16).map(|k| {
        let root = Vec3::new((k as f32 - 7.5) * 0.004, 0.06, 0.0) * s;
        let way = Vec3::new(0.0, 0.3, 0.95).normalize() * (LENGTH * s / 19.0);
        (0..20).map(move |i| root + way * i as f32).collect::<Vec<_>>()
    });
    let groom = Groom::from_strands(strands, 40e-6 * s);
    let roots = roots(&groom, REST);
    let material = Material::default();
    let material =
        Material { young: material.young * s * s, shear: material.shear * s * s, drag: 0.0, ..material };
    let mut simulation = Simulation::builder(groom)
        .materials(&[material])
        .solver(Solver { sag_free: false, ..Solver::default() })
        .gravity(Vec3::Y * -9.81 * s)
        .build()
        .unwrap();
    let mut deepest = 0.0f32;
    for frame in 0..60 {
        let at = |frame: u32| {
            let phase = 0.1 * frame as f32;
            translation(Vec3::Z * (0.01 * s * (1.0 - phase.cos())))
        };
        let colliders = [MovingCollider::new(shape.clone(), at(frame), at(frame + 1))];
        step(&mut simulation, REST, &roots, &colliders);
        let measure = simulation.measure(&colliders);
        assert_eq!(measure.non_finite, 0);
        deepest = deepest.max(measure.max_depth as f32);
    }
    (points(&simulation).iter().map(|p| *p / s).collect(), deepest / s)
}

#[test]
fn every_shape_works_at_a_tenth_and_ten_times_the_size() {
    for (k, (name, shape)) in shapes(1.0).into_iter().enumerate() {
        let (usual, depth) = fall(&shape, 1.0);
        assert!(depth < 1e-5 * LENGTH, "{name}: {depth} m deep");
        for s in [0.1, 10.0] {
            let (points, depth) = fall(&shapes(s)[k].1, s);
            let offset = farthest(&points, &usual);
            println!("{name} at scale {s}: penetration {depth}, offset {offset}");
            assert!(depth < 1e-5 * LENGTH, "{name} at scale {s}: the penetration is {depth}");
            assert!(offset < 0.005 * LENGTH, "{name} at scale {s}: the offset is {offset}");
        }
    }
}
