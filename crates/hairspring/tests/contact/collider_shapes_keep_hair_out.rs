//! Promise: hair stays outside of every collider shape, both at rest and swept through the hair at 1 m/s,
//! and is released afterward.
//!
//! A curtain of strands hangs from a rail. The shape moves through it and comes to rest in it. In every
//! frame, no point is deeper than 0.1 mm and no segment is stretched by more than 1.1 %. Five seconds after
//! the shape has left, the hair hangs where it hung before.
//!
//! Hair that falls on a thin shell lies on it, from either side. Hair that begins inside a hull or a thin
//! shell gets no deeper than it was authored, including its roots.

use glam::{Mat3, Quat, Vec3};
use hairspring::{
    collide::{ColliderShape, Hull, MovingCollider, ThinShell},
    groom::Groom,
    material::{Material, Model},
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{FRAME, REST, farthest, line, points, roots, step, translation};
use std::sync::Arc;

fn shapes() -> [(&'static str, ColliderShape); 6] {
    // Twelve points on a ball of 6 cm radius, all on the convex hull: a hull of twenty faces.
    let points: Vec<Vec3> = (0..12)
        .map(|k| {
            let y = 1.0 - (k as f32 + 0.5) / 6.0;
            let (z, x) = (2.4 * k as f32).sin_cos();
            Vec3::new(x * (1.0 - y * y).sqrt(), y, z * (1.0 - y * y).sqrt()) * 0.06
        })
        .collect();
    // A square of cloth, bent about X. At 1 m/s it moves 4.2 mm in a substep.
    let bent = |i: u32, k: u32| {
        let (u, v) = (i as f32 / 6.0 - 0.5, k as f32 / 6.0 - 0.5);
        Vec3::new(0.2 * u, 0.16 * v, -0.2 * v * v)
    };
    let square: Vec<Vec3> = (0..7).flat_map(|k| (0..7).map(move |i| bent(i, k))).collect();
    let triangles: Vec<[u32; 3]> = (0..36u32)
        .map(|q| q / 6 * 7 + q % 6)
        // Every other triangle has the opposite orientation, because a thin shell has no outside.
        .flat_map(|a| [[a, a + 1, a + 8], [a, a + 7, a + 8]])
        .collect();
    let turned = Mat3::from_quat(Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.8, 0.2));
    [
        ("sphere", ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.06 }),
        ("capsule", ColliderShape::Capsule { a: Vec3::X * -0.1, b: Vec3::X * 0.1, radius: 0.03 }),
        (
            "box",
            ColliderShape::Cuboid {
                center: Vec3::ZERO,
                half: Vec3::new(0.08, 0.05, 0.06),
                axes: Mat3::IDENTITY,
            },
        ),
        (
            "box on its corner",
            ColliderShape::Cuboid { center: Vec3::ZERO, half: Vec3::splat(0.05), axes: turned },
        ),
        ("hull", ColliderShape::Hull(Arc::new(Hull::new(&points).unwrap()))),
        ("sheet", ColliderShape::Sheet(Arc::new(ThinShell::new(&square, &triangles, 0.005)))),
    ]
}

#[test]
fn a_shape_swept_through_a_curtain_keeps_hair_out() {
    let strands = (0..48).map(|s| {
        let root = Vec3::new((s as f32 - 23.5) * 0.004, 0.3, 0.0);
        line(root, root - Vec3::Y * 0.6, 32)
    });
    let groom = Arc::new(Groom::from_strands(strands, 40e-6));
    let roots = roots(&groom, REST);
    for ((name, shape), model) in
        shapes().into_iter().flat_map(|s| Model::ALL.map(|model| (s.clone(), model)))
    {
        let mut simulation = Simulation::builder(groom.clone())
            .materials(&[Material { model, ..Material::default() }])
            .build()
            .unwrap();
        // The shape enters at 1 m/s, stays in the hair for a second, and leaves the reach of all strands.
        let at = |frame: u32| {
            let t = frame as f32 * FRAME;
            let z = if t < 1.3 { (t - 0.3).min(0.15) } else { 0.15 + 10.0 * (t - 1.3) };
            translation(Vec3::Z * z)
        };
        let (mut deepest, mut longest, mut pushed) = (0.0f32, 0.0f64, 0.0f32);
        for frame in 0..400 {
            let colliders = [MovingCollider::new(shape.clone(), at(frame), at(frame + 1))];
            step(&mut simulation, REST, &roots, &colliders);
            let measure = simulation.measure(&colliders);
            assert_eq!(measure.non_finite, 0, "{name}, {model:?}, frame {frame}");
            deepest = deepest.max(measure.max_depth as f32);
            longest = longest.max(measure.stretch_max);
            pushed = points(&simulation).iter().fold(pushed, |most, p| most.max(p.z));
        }
        let offset = farthest(&points(&simulation), &groom.points);
        println!(
            "{name}, {model:?}: {deepest} m deep, stretch {longest}, pushed {pushed} m, final offset {offset} m"
        );
        assert!(deepest < 1e-4, "{name}, {model:?}: a point is {deepest} m deep");
        assert!(longest < 0.011, "{name}, {model:?}: the stretch of a segment is {longest}");
        assert!(pushed > 0.1, "{name}, {model:?}: the shape passed through the hair");
        assert!(offset < 0.02, "{name}, {model:?}: the offset after five seconds is {offset} m");
    }
}

/// 24 strands of `length` [m] from `root`, 2 mm apart along X, that extend in `direction`.
fn row(root: Vec3, direction: Vec3, length: f32) -> Arc<Groom> {
    let strands = (0..24).map(|s| {
        let root = root + Vec3::X * (0.002 * s as f32);
        line(root, root + direction * length, 32)
    });
    Arc::new(Groom::from_strands(strands, 40e-6))
}

/// Simulates `frames` frames of hair that is not in balance, with one fixed collider. `check` receives the
/// points of every frame and the largest penetration.
fn play(
    groom: &Arc<Groom>,
    shape: &ColliderShape,
    gravity: Vec3,
    frames: u32,
    mut check: impl FnMut(&[Vec3], f64),
) {
    let roots = roots(groom, REST);
    let colliders = [MovingCollider::at_rest(shape.clone(), REST)];
    let mut simulation = Simulation::builder(groom.clone())
        .solver(Solver { sag_free: false, ..Solver::default() })
        .gravity(gravity)
        .colliders_at_rest(&[colliders[0].end_pose()])
        .build()
        .unwrap();
    for _ in 0..frames {
        step(&mut simulation, REST, &roots, &colliders);
        check(&points(&simulation), simulation.measure(&colliders).max_depth);
    }
}

#[test]
fn a_sheet_has_two_sides() {
    let square =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| Vec3::new(x, 0.0, z) * 0.2);
    let sheet = ColliderShape::Sheet(Arc::new(ThinShell::new(&square, &[[0, 1, 2], [0, 2, 3]], 0.004)));
    // Hair falls from 1 cm above, then rises from 1 cm below under reversed gravity.
    for side in [1.0, -1.0] {
        let groom = row(Vec3::Y * (0.01 * side), Vec3::new(0.0, 0.1 * side, 1.0).normalize(), 0.15);
        let mut resting = 0;
        play(&groom, &sheet, Vec3::Y * (-9.81 * side), 120, |points, depth| {
            assert!(depth < 1e-5, "{depth} m deep");
            let lowest = points.iter().fold(f32::MAX, |least, p| least.min(p.y * side));
            assert!(
                lowest > 0.003,
                "a point is {lowest} m from the middle of the sheet, which has a half-thickness of 4 mm"
            );
            resting = points.iter().filter(|p| (p.y * side - 0.004).abs() < 1e-4).count();
        });
        assert!(resting >= 24 * 12, "only {resting} points lie on the sheet");
    }
}

#[test]
fn hair_that_begins_inside_gets_no_deeper() {
    let corners: Vec<Vec3> =
        (0..8).map(|k| Vec3::new([-0.1, 0.1][k & 1], [-0.1, 0.0][k >> 1 & 1], [-0.1, 0.1][k >> 2])).collect();
    let flat: Vec<Vec3> = [2, 3, 7, 6].map(|k: usize| corners[k]).to_vec();
    for (name, shape) in [
        ("hull", ColliderShape::Hull(Arc::new(Hull::new(&corners).unwrap()))),
        ("sheet", ColliderShape::Sheet(Arc::new(ThinShell::new(&flat, &[[0, 1, 2], [0, 2, 3]], 0.003)))),
    ] {
        // Roots are 2 mm below the hull's top, or in the middle of the sheet. Hair extends upward and falls
        // to the side.
        let root = if name == "hull" { Vec3::Y * -0.002 } else { Vec3::ZERO };
        let groom = row(root, Vec3::new(0.0, 0.8, 0.6), 0.08);
        play(&groom, &shape, Vec3::Y * -9.81, 180, |points, depth| {
            assert!(depth < 1e-5, "{name}: {depth} m deeper than authored");
            for (strand, authored) in points.chunks(32).zip(groom.points.chunks(32)) {
                let root = strand[0].distance(authored[0]);
                assert!(root < 1e-6, "{name}: a root moved by {root} m");
                let lowest = strand[4..].iter().fold(f32::MAX, |least, p| least.min(p.y));
                assert!(lowest > -1e-5, "{name}: a free point is {lowest} m above the top");
            }
        });
    }
}
