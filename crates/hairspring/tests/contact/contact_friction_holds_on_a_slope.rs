//! Promise: friction holds hair. On a slope of 20° (tan 20° = 0.364), hair comes to rest within 0.1 mm if μ = 0.4,
//! and then creeps by less than 1 µm in a minute. It slides down if μ = 0.3. Sliding hair is slowed by the kinetic
//! coefficient (3 %). Once moved, it continues to slide where static friction would have held it.
//!
//! Strands lie across the slope, so that their roots hold only the nearest part. The tests use limp and
//! human hair, and every model. The slope stays level, and gravity is tilted.

use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Response, Solver},
    simulation::Simulation,
};
use hairspring_test::{FRAME, REST, farthest, points, roots, step, translation};

/// Gravity [m/s²].
const GRAVITY: f32 = 9.81;

/// Slope [°].
const SLOPE: f32 = 20.0;

/// Eight strands across a slope.
struct Slope {
    simulation: Simulation,
    roots: Vec<RigidTransform>,
}

impl Slope {
    fn new(material: Material, response: Response, spacing: f32) -> Self {
        let strands = (0..8).map(|s| {
            let root = Vec3::Z * (0.02 * s as f32);
            (0..25).map(move |i| root + Vec3::X * (spacing * i as f32)).collect::<Vec<_>>()
        });
        let groom = Groom::from_strands(strands, 40e-6);
        let roots = roots(&groom, REST);
        let (sin, cos) = SLOPE.to_radians().sin_cos();
        let simulation = Simulation::builder(groom)
            .materials(&[material])
            .solver(Solver { sag_free: false, contact: response, ..Solver::default() })
            .gravity(Vec3::new(0.0, -cos, sin) * GRAVITY)
            .build()
            .unwrap();
        Self { simulation, roots }
    }

    /// Simulates `frames` frames while the slope moves by `motion` in each [m]; returns all points.
    fn play(&mut self, frames: usize, motion: Vec3) -> Vec<Vec3> {
        let shape = ColliderShape::Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let colliders = [MovingCollider::new(shape, REST, translation(motion))];
        (0..frames).for_each(|_| _ = step(&mut self.simulation, REST, &self.roots, &colliders));
        points(&self.simulation)
    }
}

/// The largest motion of a point in the first two seconds, and in the ten seconds after [m].
fn moved(model: Model, friction: f32, bend: f32) -> [f32; 2] {
    let material = Material { model, friction, bend, drag: 0.1, ..Material::default() };
    let mut slope = Slope::new(material, Response::default(), 0.01);
    let [start, before, after] = [0, 120, 600].map(|frames| slope.play(frames, Vec3::ZERO));
    [farthest(&start, &before), farthest(&before, &after)]
}

#[test]
fn a_rough_slope_holds_hair_and_a_smooth_one_does_not() {
    for model in Model::ALL {
        for bend in [0.01, 1.0] {
            let [lay, crept] = moved(model, 0.4, bend).map(|d| d * 1e3);
            let [slid, _] = moved(model, 0.3, bend).map(|d| d * 1e3);
            println!(
                "{model:?}, bend {bend}: {lay:.4} mm at first, then crept {crept:.4} mm; slid {slid:.1} mm if smooth"
            );
            assert!(lay + crept < 0.1, "{model:?}, bend {bend}: {lay} mm, then {crept} mm");
            assert!(slid > 100.0, "{model:?}, bend {bend}: {slid} mm");
        }
    }
}

#[test]
fn hair_that_sticks_does_not_creep() {
    for model in Model::ALL {
        let material = Material { model, friction: 0.4, bend: 0.01, drag: 0.1, ..Material::default() };
        let mut slope = Slope::new(material, Response::default(), 0.01);
        let [before, after] = [600, 3600].map(|frames| slope.play(frames, Vec3::ZERO));
        let crept = farthest(&before, &after) * 1e6;
        println!("{model:?}: crept {crept:.3} µm in a minute");
        assert!(crept < 1.0, "{model:?}: {crept} µm");
    }
}

/// The friction coefficient of a sliding point far from root and tip, in the first quarter of a second [1].
fn kinetic_friction(model: Model, response: Response, friction_kinetic: f32) -> f32 {
    let material =
        Material { model, friction: 0.3, friction_kinetic, bend: 0.01, drag: 0.0, ..Material::default() };
    let mut slope = Slope::new(material, response, 0.1);
    let [a, b, c] = [9, 3, 3].map(|frames| slope.play(frames, Vec3::ZERO)[17].z);
    let acceleration = (a - 2.0 * b + c) / (3.0 * FRAME).powi(2);
    let (sin, cos) = SLOPE.to_radians().sin_cos();
    (sin - acceleration / GRAVITY) / cos
}

#[test]
fn sliding_hair_has_kinetic_friction() {
    for model in Model::ALL {
        for response in [Response::Projection, Response::Both] {
            for kinetic in [0.0, 0.25, 0.5, 0.75] {
                let (found, want) = (kinetic_friction(model, response, kinetic), 0.3 * kinetic);
                println!("{model:?}, {response:?}: friction of {found:.4}, expected {want}");
                assert!(
                    (found - want).abs() < 0.03 * want + 1e-3,
                    "{model:?}, {response:?}: {found} instead of {want}"
                );
            }
        }
    }
}

/// The largest motion of a point in a second at rest, and from 0.2 to 0.4 s after the slope was jerked
/// downhill [m].
fn jerked(model: Model, friction_kinetic: f32) -> [f32; 2] {
    let material =
        Material { model, friction: 0.4, friction_kinetic, bend: 0.01, drag: 0.3, ..Material::default() };
    let mut slope = Slope::new(material, Response::default(), 0.04);
    let [start, still] = [0, 60].map(|frames| slope.play(frames, Vec3::ZERO));
    slope.play(1, Vec3::Z * 0.01);
    let [before, after] = [12, 12].map(|frames| slope.play(frames, Vec3::ZERO));
    [farthest(&start, &still), farthest(&before, &after)]
}

#[test]
fn moved_hair_continues_to_slide() {
    for model in Model::ALL {
        let [still, slid] = jerked(model, 0.5).map(|d| d * 1e3);
        let [same, stopped] = jerked(model, 1.0).map(|d| d * 1e3);
        println!(
            "{model:?}: {still:.4} mm at rest, {slid:.2} mm once moved; {same:.4} and {stopped:.2} mm with one coefficient"
        );
        assert!(still < 0.1 && same < 0.1, "{model:?}: at rest hair moved by {still} and {same} mm");
        assert!(slid > 30.0, "{model:?}: hair slid by only {slid} mm");
        assert!(stopped < 3.0, "{model:?}: with one coefficient hair slid by {stopped} mm");
    }
}
