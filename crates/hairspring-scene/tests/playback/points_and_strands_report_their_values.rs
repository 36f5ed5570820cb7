//! Promise: every point and strand reports its values, and a ray finds the strand that it points at.
//!
//! The tension of a hanging strand follows the closed form. The contact force on a strand on a floor
//! balances its weight. Bent strands report their turn, moving points their speed, and points in a volume
//! their density. Follow hairs report the values of their first guide.

use crate::support::play;
use glam::{Quat, Vec3};
use hairspring::{
    groom::{Groom, GuideWeights},
    material::Material,
    settings::{Solver, Volume, VolumeMethod},
};
use hairspring_scene::{
    Collider, Guides, InitialContact, Scene, SceneGroom, Shape,
    stage::{Stage, Value},
};
use hairspring_test::FRAME;
use std::f32::consts::PI;

const G: f32 = 9.81;
const RADIUS: f32 = 40e-6;
const POINTS: usize = 21;
const SEGMENT: f32 = 0.01;

/// Straight strands along `way`, with roots 5 cm apart. Strands 0 and 3 are simulated, and strands 1 and 2
/// follow them.
fn rail(way: Vec3) -> Groom {
    let strand = |s: usize| {
        let root = Vec3::X * (0.05 * s as f32);
        (0..POINTS).map(|i| root + way * (SEGMENT * i as f32)).collect::<Vec<_>>()
    };
    let mut groom = Groom::from_strands((0..4).map(strand), RADIUS);
    let follows = |guide: u32| GuideWeights { guides: [guide; 3], weights: [1.0, 0.0, 0.0] };
    groom.guides = [0, 0, 3, 3].map(follows).to_vec();
    groom
}

fn scene(groom: Groom) -> Scene {
    let groom = SceneGroom {
        groom,
        materials: vec![Material::default()],
        guides: Guides::FromGroom,
        ..SceneGroom::default()
    };
    Scene { grooms: vec![groom], gravity: Vec3::NEG_Y * G, ..Scene::default() }
}

fn values(stage: &Stage, what: Value) -> Vec<f32> {
    let mut out = vec![7.0];
    stage.values(what, 0, &mut out);
    assert_eq!(
        out.len(),
        stage.strands().next().unwrap().points.len(),
        "{what:?} has no value for some points"
    );
    assert!(out.iter().all(|x| x.is_finite()), "{what:?} is not finite");
    out
}

#[test]
fn tension_of_a_hanging_strand_follows_the_closed_form() {
    let mut stage = Stage::new(scene(rail(Vec3::NEG_Y))).unwrap();
    play(&mut stage, 60);
    let weight = Material::default().density * PI * RADIUS * RADIUS * SEGMENT * G;
    let tension = values(&stage, Value::Tension);
    for s in 0..4 {
        // Starts at the first segment that does not touch the root. The last point carries half a segment.
        for i in 1..POINTS - 1 {
            let expected = weight * (POINTS as f32 - 1.5 - i as f32);
            let found = tension[s * POINTS + i];
            assert!(
                (found / expected - 1.0).abs() < 0.02,
                "strand {s}, point {i}: {found} N instead of {expected}"
            );
        }
    }
    let figures = [0, 1].map(|s| stage.strand_figures(0, s));
    assert_eq!(figures.map(|f| (f.simulated, f.guide, f.points)), [(true, 0, POINTS), (false, 0, POINTS)]);
    assert_eq!(figures[0].tension_max, figures[1].tension_max);
    assert!((figures[1].length - 0.2).abs() < 1e-6);
    assert!(figures[0].stretch_max < 1e-4 && figures[0].speed_max < 1e-3 && figures[0].depth == 0.0);
    assert_eq!(
        values(&stage, Value::Guide).chunks(POINTS).map(|s| s[5]).collect::<Vec<_>>(),
        [0., 0., 3., 3.]
    );
    assert_eq!((0..4).map(|s| stage.guide_of(0, s)).collect::<Vec<_>>(), [0, 0, 3, 3]);
    assert!(values(&stage, Value::Turn).iter().all(|turn| *turn < 1e-3));
    assert!(values(&stage, Value::Contact).iter().chain(&values(&stage, Value::Density)).all(|x| *x == 0.0));
    let mut none = vec![1.0];
    stage.values(Value::Speed, 1, &mut none);
    assert!(none.is_empty(), "a groom that does not exist has values");
}

#[test]
fn falling_strands_report_speed_and_turn() {
    let mut falling = scene(rail(Vec3::X));
    falling.solver = Solver { sag_free: false, ..Solver::default() };
    falling.grooms[0].materials[0].bend = 1e-3;
    let mut stage = Stage::new(falling).unwrap();
    play(&mut stage, 4);
    let here = stage.strands().next().unwrap().points.to_vec();
    stage.step(FRAME);
    let next = stage.strands().next().unwrap().points;
    let speed = values(&stage, Value::Speed);
    let turn = values(&stage, Value::Turn);
    for i in 10..POINTS {
        let mean = next[i].distance(here[i]) / FRAME;
        // In a frame of free fall the speed grows by g/60.
        assert!(
            (speed[i] - mean).abs() < 0.5 * G * FRAME + 0.02,
            "point {i}: {} m/s instead of {mean}",
            speed[i]
        );
    }
    // The rest shape is straight, so the turn of a joint is the angle between its two segments.
    for i in 1..POINTS - 1 {
        let now = (next[i] - next[i - 1]).angle_between(next[i + 1] - next[i]);
        assert!((turn[i] - now).abs() < 1e-3, "joint {i}: {} rad instead of {now}", turn[i]);
    }
    assert!(turn[..POINTS].iter().sum::<f32>() > 0.5 && turn[0] == 0.0 && turn[POINTS - 1] == 0.0);
    let figures = stage.strand_figures(0, 0);
    assert_eq!(figures.speed_max, speed[..POINTS].iter().copied().fold(0.0, f32::max));
    assert_eq!(figures.turn_max, turn[..POINTS].iter().copied().fold(0.0, f32::max));
    assert!(figures.stretch_max < 0.011);
}

#[test]
fn contact_force_on_a_floor_balances_the_weight() {
    let mut lying = scene(rail(Vec3::X));
    lying.solver.sag_free = false;
    lying.grooms[0].materials[0].bend = 0.01;
    let floor = Shape::Plane { point: Vec3::NEG_Y * 0.002, normal: Vec3::Y };
    lying.colliders = vec![Collider { joint: None, initial: InitialContact::Keep, shape: floor }];
    let mut stage = Stage::new(lying).unwrap();
    play(&mut stage, 180);
    let contact = values(&stage, Value::Contact);
    let weight = Material::default().density * PI * RADIUS * RADIUS * SEGMENT * G;
    let held: f32 = contact[..POINTS].iter().sum();
    let whole = weight * (POINTS - 1) as f32;
    assert!(held > 0.5 * whole && held < 1.1 * whole, "{held} N of {whole}");
    assert!(contact.iter().all(|n| *n >= 0.0) && contact[0] == 0.0);
    assert!(stage.strand_figures(0, 1).depth < 1e-4);
}

#[test]
fn density_at_rest_is_one() {
    let strands = (0..400).map(|s| {
        let root = Vec3::new((s % 20) as f32 * 0.002, 0.0, (s / 20) as f32 * 0.002);
        (0..POINTS).map(|i| root - Vec3::Y * (SEGMENT * i as f32)).collect::<Vec<_>>()
    });
    let mut dense = scene(Groom::from_strands(strands, RADIUS));
    dense.grooms[0].guides = Guides::All;
    dense.volume = Volume { method: VolumeMethod::Density, ..Volume::default() };
    let mut stage = Stage::new(dense).unwrap();
    play(&mut stage, 5);
    let density = values(&stage, Value::Density);
    let middle = density[(10 * 20 + 10) * POINTS + 10];
    assert!((middle - 1.0).abs() < 0.2, "the density in the middle is {middle}");
    assert!(density.iter().all(|d| (0.0..2.0).contains(d)));
}

#[test]
fn a_ray_finds_the_strand_it_points_at() {
    let mut two = scene(rail(Vec3::NEG_Y));
    let mut behind = rail(Vec3::NEG_Y);
    behind.points.iter_mut().for_each(|p| p.z -= 0.1);
    two.grooms.push(SceneGroom { groom: behind, ..two.grooms[0].clone() });
    let stage = Stage::new(two).unwrap();
    let eye = Vec3::new(0.0, 0.0, 1.0);
    let at = |place: Vec3| stage.nearest_strand(eye, place - eye);
    let hit = at(Vec3::new(0.05, -0.1, 0.0)).unwrap();
    assert_eq!((hit.groom, hit.strand, hit.point), (0, 1, 10));
    assert!((hit.distance - eye.distance(Vec3::new(0.05, -0.1, 0.0))).abs() < 1e-5);
    // Between two strands, closer in angle to the left one.
    let between = at(Vec3::new(0.06, -0.102, 0.0)).unwrap();
    assert_eq!((between.groom, between.strand, between.point), (0, 1, 10));
    // Both strands are within 0.2° of the ray: the nearer one is found although the ray passes through the
    // other.
    let behind = at(Vec3::new(0.0, -0.11, -0.1)).unwrap();
    assert_eq!((behind.groom, behind.strand), (0, 0));
    // The ray is rotated by a small angle about Y.
    let turned = Quat::from_rotation_y(0.002) * Vec3::new(0.0, -0.1, -1.0);
    assert_eq!(stage.nearest_strand(eye, turned).map(|p| p.strand), Some(0));
    assert_eq!(stage.nearest_strand(eye, Vec3::Z), None, "a ray away from the hair found a strand");
    assert_eq!(stage.nearest_strand(eye, Vec3::ZERO), None);
    assert_eq!(stage.nearest_strand(eye, Vec3::splat(f32::NAN)), None);
}

#[test]
fn values_have_names_and_units() {
    let names = Value::ALL.map(|value| (value.name(), value.unit()));
    let all = [
        ("guide", "1"),
        ("tension", "N"),
        ("turn", "rad"),
        ("stretch", "1"),
        ("speed", "m/s"),
        ("density", "1"),
        ("contact", "N"),
    ];
    assert_eq!(names, all);
}
