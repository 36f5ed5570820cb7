//! Promise: a collider that is put on hair and pushes ends with no hair inside it, and the hair is at rest.
//!
//! Hats, headphones and hair bands are put on finished hair, so hair starts inside them. A shape that pushes grows
//! inside the hair, which ends around it. A sheet that pushes closes in from outside: hair that passed through it
//! ends under it, between the sheet and the head. Without `initial`, hair may stay where it is, and is reported.
//! Hair beneath the skin together with its root is never reported.

use crate::support::{play, points};
use glam::{Quat, Vec3};
use hairspring::{
    body::{Body, Joint, Mesh, Trs},
    groom::Groom,
};
use hairspring_scene::{
    Collider, Guides, InitialContact, Scene, SceneGroom, SceneSheet, Shape, stage::Stage,
};

/// Radius of the ball that is a head, and of the hat over it [m].
const HEAD: f32 = 0.09;
const HAT: f32 = 0.108;
/// Lowest height of the hat above the center of the head [m].
const BRIM: f32 = 0.02;
const HAIR: f32 = 0.14;
const POINTS: usize = 20;

fn scene(strands: impl Iterator<Item = Vec<Vec3>>, guides: Guides, colliders: Vec<Collider>) -> Scene {
    let groom = Groom::from_strands(strands, 35e-6);
    Scene {
        grooms: vec![SceneGroom { groom, guides, ..SceneGroom::default() }],
        colliders,
        gravity: Vec3::new(0.0, -9.81, 0.0),
        ..Scene::default()
    }
}

/// Strands that hang from a row of roots.
fn curtain(initial: InitialContact, shape: Shape) -> Scene {
    let strand = |k: usize| {
        let root = Vec3::new(0.002 * (k % 5) as f32 - 0.004, 0.0, 0.002 * (k / 5) as f32 - 0.06);
        (0..POINTS).map(|i| root - Vec3::Y * (HAIR * i as f32 / (POINTS - 1) as f32)).collect()
    };
    scene((0..300).map(strand), Guides::Count(100), vec![Collider { joint: None, initial, shape }])
}

/// Shapes in the middle of the curtain, off its plane of symmetry.
fn shapes() -> Vec<(&'static str, Shape)> {
    let center = Vec3::new(0.003, -0.07, 0.0);
    let end = Vec3::Z * 0.08;
    let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) - 0.5;
    vec![
        ("sphere", Shape::Sphere { center, radius: 0.03 }),
        ("capsule", Shape::Capsule { a: center - end, b: center + end, radius: 0.012 }),
        ("box", Shape::Box { center, size: Vec3::new(0.02, 0.03, 0.2), rotation: Vec3::new(0.0, 0.0, 20.0) }),
        (
            "hull",
            Shape::Hull {
                points: (0..8).map(|k| center + corner(k) * Vec3::new(0.02, 0.04, 0.2)).collect(),
                file: None,
                scale: None,
            },
        ),
    ]
}

/// Depth of the deepest point of any hair in the colliders [m].
fn deepest(stage: &Stage) -> f32 {
    let depth = |p: &Vec3| stage.colliders().iter().map(|o| -o.end_pose().distance(*p)).fold(0.0, f32::max);
    points(stage).chunks(POINTS).flat_map(|strand| &strand[1..]).map(depth).fold(0.0, f32::max)
}

#[test]
fn hair_is_outside_of_a_shape_that_pushes_and_stays_there() {
    for (name, shape) in shapes() {
        let mut stage = Stage::new(curtain(InitialContact::Push, shape)).unwrap();
        let depth = deepest(&stage);
        assert_eq!(stage.starts_inside(), None, "{name}: hair is reported inside");
        let start = points(&stage);
        play(&mut stage, 60);
        let measure = stage.measure();
        let moved = hairspring_test::farthest(&start, &points(&stage));
        println!(
            "{name}: {:.3} mm inside at the start; moves by {:.3} mm in a second",
            1e3 * depth,
            1e3 * moved
        );
        assert!(depth < 1e-4, "{name}: hair starts {depth} m inside");
        assert!(deepest(&stage) < 1e-4, "{name}: hair is {} m inside after a second", deepest(&stage));
        assert!(measure.stretch_max < 0.011, "{name}: hair is stretched by {}", measure.stretch_max);
        assert!(moved < 2e-3, "{name}: hair moves by {moved} m in a second");
        stage.reset();
        assert!(points(&stage) == start, "{name}: a reset does not restore the start");
    }
}

#[test]
fn hair_that_may_stay_inside_is_counted_and_reported_as_inside() {
    for (name, shape) in shapes() {
        let mut stage = Stage::new(curtain(InitialContact::Keep, shape)).unwrap();
        let report = stage.starts_inside().expect(name);
        play(&mut stage, 2);
        let measure = stage.measure();
        println!("{name}: {report}");
        assert!(
            report.in_keeping && !report.in_pushing && report.strands > 20 && report.all == 100,
            "{name}: {report:?}"
        );
        assert!(
            report.to_string().contains("initial = \"push\""),
            "{name}: the report has no remedy: {report}"
        );
        assert!((f64::from(report.depth) - measure.started_inside_depth).abs() < 1e-3, "{name}: {measure:?}");
        assert!(measure.inside_points >= measure.started_inside_points, "{name}: {measure:?}");
        assert!(measure.started_inside_points > 20, "{name}: hair inside is not counted: {measure:?}");
    }
}

/// Hair that stands off the upper part of a ball, with roots `depth` beneath its surface.
fn head(depth: f32, guides: Guides) -> Scene {
    let strand = |k: usize| {
        let height = 0.2 + 0.8 * (k as f32 + 0.5) / 400.0;
        let out =
            Quat::from_rotation_y(2.4 * k as f32) * Vec3::new((1.0 - height * height).sqrt(), height, 0.0);
        (0..POINTS).map(|i| out * (HEAD - depth + HAIR * i as f32 / (POINTS - 1) as f32)).collect()
    };
    let shape = Shape::Sphere { center: Vec3::ZERO, radius: HEAD };
    scene((0..400).map(strand), guides, vec![Collider { joint: None, initial: InitialContact::Keep, shape }])
}

/// A cap over the head: the part of a sphere above the brim.
fn hat() -> Body {
    let (rings, around) = (16, 48);
    let lowest = (BRIM / HAT).acos();
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        let (sin, cos) = (lowest * ring as f32 / rings as f32).sin_cos();
        mesh.positions.extend((0..around).map(|k| {
            let (z, x) = (std::f32::consts::TAU * k as f32 / around as f32).sin_cos();
            Vec3::new(x * sin, cos, z * sin) * HAT
        }));
    }
    for ring in 0..rings {
        for k in 0..around {
            let at = |ring: u32, k: u32| ring * around + k % around;
            let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)];
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    mesh.normals = mesh.positions.iter().map(|p| p.normalize()).collect();
    Body { mesh, joints: vec![Joint { name: "hat".into(), parent: None, rest: Trs::default() }], skin: None }
}

/// Number of hairs with a point on or beyond the hat, `margin` [m] or more above its brim.
fn beyond_hat(stage: &Stage, margin: f32) -> usize {
    let beyond = |p: &Vec3| p.length() > HAT + 1e-4 && p.y > BRIM + margin;
    points(stage).chunks(POINTS).filter(|strand| strand.iter().any(beyond)).count()
}

#[test]
fn a_hat_lays_hair_against_the_head() {
    // Hair that comes out at the brim may rise beside it: a little, and a follow hair by its distance from its guide.
    for (guides, margin) in [(Guides::All, 0.006), (Guides::Count(150), 0.02)] {
        let mut scene = head(0.0, guides);
        let sheet = |initial| SceneSheet { body: hat(), initial, thickness: 0.002 };
        scene.sheets = vec![sheet(InitialContact::Keep)];
        let through = Stage::new(scene.clone()).unwrap();
        let report = through.starts_inside().unwrap();
        println!(
            "without a push, {} of 400 hairs are beyond the hat: {report}",
            beyond_hat(&through, margin)
        );
        assert!(beyond_hat(&through, margin) > 300 && report.through_sheets > 100, "{report:?}");

        scene.sheets = vec![sheet(InitialContact::Push)];
        let mut stage = Stage::new(scene).unwrap();
        let start = points(&stage);
        assert_eq!(beyond_hat(&stage, margin), 0, "{guides:?}: hair is beyond the hat");
        assert_eq!(stage.starts_inside(), None, "{guides:?}: hair starts inside");
        play(&mut stage, 60);
        let measure = stage.measure();
        let moved = hairspring_test::farthest(&start, &points(&stage));
        println!("{guides:?}: hair moves by {:.2} mm in a second, {measure:?}", 1e3 * moved);
        assert_eq!(beyond_hat(&stage, margin), 0, "{guides:?}: hair is beyond the hat after a second");
        assert!(moved < 5e-3, "{guides:?}: hair moves by {moved} m in a second");
        assert!(measure.stretch_max < 0.011 && measure.speed_max < 0.02, "{guides:?}: {measure:?}");
    }
}

#[test]
fn hair_beneath_the_skin_with_its_root_is_not_reported() {
    let mut stage = Stage::new(head(0.012, Guides::All)).unwrap();
    assert_eq!(stage.starts_inside(), None, "roots beneath the skin are reported");
    play(&mut stage, 2);
    assert_eq!(stage.measure().inside_points, 0, "roots beneath the skin count as inside");
}
