//! Promise: elasticity never adds energy to a strand. Folded by up to 180° at its joints or coiled, it
//! keeps its shape and comes to rest after a shake, also without gravity.

use glam::{Quat, Vec3};
use hairspring::{
    groom::Groom,
    material::{Material, Model, preset},
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{FRAME, REST, farthest, points, step, translation};
use std::f32::consts::TAU;

/// A strand of 20 segments of 5 mm that turns by `degrees` at every third joint, each time about another
/// axis.
fn folded(degrees: f32) -> Vec<Vec3> {
    let (mut points, mut along) = (vec![Vec3::ZERO], Vec3::NEG_Y);
    for k in 0..20 {
        if k % 3 == 2 {
            let axis = along.any_orthonormal_vector();
            let axis = Quat::from_axis_angle(along, k as f32) * axis;
            along = Quat::from_axis_angle(axis, degrees.to_radians()) * along;
        }
        points.push(points[k] + along * 0.005);
    }
    points
}

/// A coil of `turns` turns, 1 cm in radius, with 12 segments in each.
fn coil(turns: f32) -> Vec<Vec3> {
    let count = (12.0 * turns) as usize;
    let at = |i: usize| {
        let (sin, cos) = (TAU * i as f32 / 12.0).sin_cos();
        Vec3::new(0.01 * (cos - 1.0), -0.0012 * i as f32, 0.01 * sin)
    };
    (0..=count).map(at).collect()
}

/// The speed of the fastest point [m/s] after two seconds at rest and eight seconds after a shake.
fn speeds(strands: &[Vec<Vec3>], material: Material, gravity: Vec3) -> [f32; 2] {
    let groom = Groom::from_strands(strands, 40e-6);
    let mut simulation = Simulation::builder(groom).materials(&[material]).gravity(gravity).build().unwrap();
    let mut frame = |x: f32| {
        let (head, before) = (translation(Vec3::X * x), points(&simulation));
        step(&mut simulation, head, &vec![head; strands.len()], &[]);
        farthest(&before, &points(&simulation)) / FRAME
    };
    let at_rest = (0..120).map(|_| frame(0.0)).skip(105).fold(0.0, f32::max);
    for k in 1..=60 {
        frame(0.02 * (TAU * 2.0 * k as f32 / 60.0).sin());
    }
    let shaken = (0..480).map(|_| frame(0.0)).skip(465).fold(0.0, f32::max);
    [at_rest, shaken]
}

/// Strands of these shapes come to rest, without a reset, with gravity and without.
fn come_to_rest(name: &str, strands: &[Vec<Vec3>], material: &Material) {
    for gravity in [Vec3::ZERO, Vec3::NEG_Y * 9.81] {
        let [at_rest, shaken] = speeds(strands, material.clone(), gravity);
        println!("{name}, gravity {gravity}: {at_rest} m/s at rest, {shaken} m/s after a shake");
        assert!(at_rest < 1e-3, "{name}, gravity {gravity}: {at_rest} m/s at rest");
        assert!(shaken < 5e-3, "{name}, gravity {gravity}: {shaken} m/s after a shake");
    }
}

#[test]
fn folded_strands_come_to_rest() {
    let strands = [90.0, 130.0, 150.0, 160.0, 170.0, 175.0, 179.0, 179.9].map(folded);
    for model in [Model::Auto, Model::Rod, Model::Curvature] {
        let material = Material { model, ..preset("wavy").unwrap() };
        come_to_rest(&format!("{model:?}"), &strands, &material);
    }
}

#[test]
fn coils_come_to_rest() {
    let curly = Material { model: Model::Auto, ..preset("curly").unwrap() };
    for turns in [0.75, 1.5, 2.0, 3.0, 6.0, 12.0] {
        come_to_rest(&format!("{turns} turns"), &[coil(turns)], &curly);
    }
}

/// The curvature model has no twist, so it leaves strands that turn by more than half a turn to the rod.
#[test]
fn coils_with_the_curvature_model_come_to_rest() {
    let material = Material { model: Model::Curvature, ..preset("curly").unwrap() };
    for turns in [0.25, 0.5, 0.75, 1.5, 2.0, 3.0, 6.0, 12.0] {
        come_to_rest(&format!("{turns} turns"), &[coil(turns)], &material);
    }
}

/// A strand of 32 points that winds about the axis `way`, with this `radius` and `pitch` of its helix [m].
fn wave(way: Vec3, radius: f32, pitch: f32, length: f32) -> Vec<Vec3> {
    let way = way.normalize();
    let (a, b) = way.any_orthonormal_pair();
    let turns = length / pitch.hypot(TAU * radius);
    let at = |i: usize| {
        let turn = turns * i as f32 / 31.0;
        let (sin, cos) = (TAU * turn).sin_cos();
        way * (pitch * turn) + (a * cos + b * sin) * (radius * (4.0 * turn).min(1.0))
    };
    (0..32).map(at).collect()
}

/// Waves that fall from their authored shape, in the curvature model.
#[test]
fn waves_with_the_curvature_model_come_to_rest() {
    let mut waves = Vec::new();
    for radius in [0.002, 0.004, 0.006, 0.008] {
        for pitch in [0.04, 0.06, 0.08, 0.1] {
            for length in [0.15, 0.25, 0.35, 0.4] {
                for rise in [-0.4, 0.0, 0.4, 0.9] {
                    waves.push(wave(Vec3::new(1.0, rise, 0.3), radius, pitch, length));
                }
            }
        }
    }
    let wavy = Material { model: Model::Curvature, ..preset("wavy").unwrap() };
    for damping in [wavy.damping, 0.0] {
        let groom = Groom::from_strands(&waves, 60e-6);
        let mut simulation = Simulation::builder(groom)
            .materials(&[Material { damping, ..wavy.clone() }])
            .solver(Solver { sag_free: false, ..Solver::default() })
            .build()
            .unwrap();
        let coils = simulation.start().coils;
        assert!((1..waves.len()).contains(&coils), "{coils} of {} waves are rods", waves.len());
        let mut frame = || {
            let before = points(&simulation);
            step(&mut simulation, REST, &vec![REST; waves.len()], &[]);
            farthest(&before, &points(&simulation)) / FRAME
        };
        let speed = (0..60 * 30).map(|_| frame()).skip(60 * 29).fold(0.0, f32::max);
        println!("damping {damping} s: {speed} m/s, {coils} of {} waves are rods", waves.len());
        assert!(speed < 1e-3, "damping {damping} s: {speed} m/s");
    }
}
