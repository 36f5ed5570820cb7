//! Promise: measurements include the penetration of segments between their points: how many segments
//! penetrate, how many of them by more than a millimeter, and the deepest, relative to their authored
//! penetration.
//!
//! The strand is straight and has segments of 2 cm along X. Shapes are placed at the middle of one segment,
//! so that the penetration there is known.

use glam::{Mat3, Quat, Vec3};
use hairspring::{
    collide::{ColliderShape, MovingCollider, voxelize},
    groom::Groom,
    material::{Material, Model},
    simulation::{Measure, Simulation},
};
use hairspring_test::REST;
use proptest::prelude::*;
use std::sync::Arc;

const SEGMENT: f32 = 0.02;

/// The middle of the fifth segment.
const MIDDLE: Vec3 = Vec3::new(4.5 * SEGMENT, 0.0, 0.0);

/// Measures the strand as authored against `shape`. The penetration is authored if `at_rest`: then the shape is
/// one of the colliders at rest.
fn measure(model: Model, shape: &ColliderShape, at_rest: bool) -> Measure {
    let points = (0..12).map(|i| Vec3::X * (SEGMENT * i as f32));
    let groom = Groom::from_strands([points.collect::<Vec<_>>()], 40e-6);
    let collider = MovingCollider::at_rest(shape.clone(), REST);
    let rest = collider.end_pose();
    let simulation = Simulation::builder(groom)
        .materials(&[Material { model, ..Material::default() }])
        .colliders_at_rest(if at_rest { std::slice::from_ref(&rest) } else { &[] })
        .build()
        .unwrap();
    simulation.measure(&[collider])
}

/// Shapes that reach `depth` [m] above the middle of the fifth segment from below, and touch nothing else.
fn shapes(depth: f32) -> [(&'static str, ColliderShape); 3] {
    let top = MIDDLE + Vec3::Y * depth;
    let radius = 0.008;
    let below = top - Vec3::Y * radius;
    // A box on its edge: at a distance d below the edge, both faces are d/√2 away.
    let (half, edge) = (0.05, MIDDLE + Vec3::Y * (depth * 2f32.sqrt()));
    [
        ("ball", ColliderShape::Sphere { center: below, radius }),
        ("rod", ColliderShape::Capsule { a: below - Vec3::Z, b: below + Vec3::Z, radius }),
        (
            "edge",
            ColliderShape::Cuboid {
                center: edge - Vec3::Y * (half * 2f32.sqrt()),
                half: Vec3::splat(half),
                axes: Mat3::from_quat(Quat::from_rotation_z(std::f32::consts::FRAC_PI_4)),
            },
        ),
    ]
}

#[test]
fn penetration_at_the_middle_of_a_segment_is_measured() {
    for model in Model::ALL {
        for (depth, deep) in [(4e-4, 0), (1.5e-3, 1), (3e-3, 1)] {
            for (name, shape) in shapes(depth) {
                let found = measure(model, &shape, false);
                assert_eq!(found.inside_points, 0, "{name}, {model:?}: points are inside: {found:?}");
                let counts = (found.inside_segments, found.deep_segments);
                assert_eq!(counts, (1, deep), "{name}, {model:?}, {depth} m: {found:?}");
                let error = (found.segment_depth - f64::from(depth)).abs();
                assert!(error < 2e-7, "{name}, {model:?}: {} m instead of {depth}", found.segment_depth);
            }
        }
    }
}

#[test]
fn authored_penetration_is_not_counted() {
    for model in Model::ALL {
        for (name, shape) in shapes(3e-3) {
            let found = measure(model, &shape, true);
            let counts = (found.inside_segments, found.deep_segments, found.segment_depth);
            assert_eq!(counts, (0, 0, 0.0), "{name}, {model:?}: authored penetration is counted");
        }
    }
}

#[test]
fn separate_shapes_are_not_counted() {
    for (name, shape) in shapes(-1e-4) {
        let found = measure(Model::Auto, &shape, false);
        assert_eq!(
            (found.inside_segments, found.segment_depth),
            (0, 0.0),
            "{name}: a separate shape is counted"
        );
    }
}

#[test]
fn penetration_held_by_the_root_is_counted_separately() {
    let ball =
        |x: f32, y: f32| ColliderShape::Sphere { center: Vec3::new(SEGMENT + x, y, 0.0), radius: 0.008 };
    for model in Model::ALL {
        // The fixed end is the deepest point, 3 mm. At the first eighth, the distance from the center is
        // √(5² + 2.5²) mm.
        let found = measure(model, &ball(0.0, -0.005), false);
        let counts = (found.inside_segments, found.deep_segments, found.held_segments);
        assert_eq!(counts, (0, 0, 1), "{model:?}: wrong counts: {found:?}");
        assert!((found.held_depth - 0.002_409_8).abs() < 1e-6, "{model:?}: wrong depth: {found:?}");
        // The point at a quarter is 6 mm deep, and the start is √(5² + 2²) mm from the center. Only the
        // penetration beyond that of the start can be corrected.
        let found = measure(model, &ball(0.005, -0.002), false);
        assert_eq!((found.deep_segments, found.held_segments), (1, 0), "{model:?}: wrong counts: {found:?}");
        assert!((found.segment_depth - 0.003_385_2).abs() < 1e-6, "{model:?}: wrong depth: {found:?}");
        // If a segment begins outside, none of its penetration is due to the fixed end.
        let found = measure(model, &ball(0.01, -0.005), false);
        assert_eq!((found.deep_segments, found.held_segments), (1, 0), "{model:?}: wrong counts: {found:?}");
    }
}

proptest! {
    /// The nearest point of a segment to a ball's center is known. The result is never deeper than that,
    /// and by at most an eighth of the segment less deep. It is on the correct side of the surface where
    /// the whole segment is outside.
    #[test]
    fn penetration_of_a_ball_is_found_anywhere_on_a_segment(ends in prop::array::uniform6(-1.0f32..1.0), radius in 0.01f32..0.8) {
        let [a, b] = [Vec3::from_slice(&ends[..3]), Vec3::from_slice(&ends[3..])];
        let e = b - a;
        let at = (-a.dot(e) / e.length_squared().max(1e-12)).clamp(0.0, 1.0);
        let exact = a.lerp(b, at).length() - radius;
        let found = ColliderShape::Sphere { center: Vec3::ZERO, radius }.least_distance(a, b);
        prop_assert!(found > exact - 1e-6, "{found} is less than the exact {exact}");
        prop_assert!(exact > 0.0 || found < exact + e.length() / 8.0 + 1e-6, "{found} instead of {exact}");
    }
}

#[test]
fn penetration_across_a_corner_is_exact() {
    // A segment from one face of a box to the other across its edge: the middle is half as deep as either
    // end is far from the edge.
    let shape = ColliderShape::Cuboid { center: Vec3::ZERO, half: Vec3::splat(0.1), axes: Mat3::IDENTITY };
    for cut in [0.001f32, 0.01, 0.05] {
        let [a, b] = [Vec3::new(0.1 - 2.0 * cut, 0.1, 0.02), Vec3::new(0.1, 0.1 - 2.0 * cut, 0.02)];
        let found = shape.least_distance(a, b);
        assert!((found + cut).abs() < 1e-6, "{found}, but the corner is cut by {cut}");
    }
}

#[test]
fn penetration_of_a_mesh_includes_its_edges() {
    // A cube of 4 cm, rotated relative to the grid of its field. One edge crosses the fifth segment 1.5 mm
    // above its middle.
    let turn = Quat::from_rotation_x(0.3) * Quat::from_rotation_z(std::f32::consts::FRAC_PI_4);
    let half = 0.02;
    let depth = 1.5e-3;
    let center = MIDDLE + Vec3::Y * depth - turn * Vec3::new(half, half, 0.0);
    let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) - 0.5;
    let positions: Vec<Vec3> = (0..8).map(|k| center + turn * corner(k) * (2.0 * half)).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let field = ColliderShape::Field(Arc::new(voxelize(&positions, &triangles, 0.004)));
    let cuboid = ColliderShape::Cuboid { center, half: Vec3::splat(half), axes: Mat3::from_quat(turn) };
    let [of_field, of_cuboid] = [field, cuboid].map(|shape| measure(Model::Auto, &shape, false));
    assert_eq!(of_cuboid.surface_depth, of_cuboid.segment_depth, "an analytic shape must be exact");
    let (exact, solver) = (of_cuboid.segment_depth, of_field.segment_depth);
    assert!((of_field.surface_depth - exact).abs() < 5e-5, "{} m instead of {exact}", of_field.surface_depth);
    assert!(
        exact - solver > 2e-4,
        "the field does not round the edge, so this test shows nothing: {solver} m"
    );
}
