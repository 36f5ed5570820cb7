//! Promise: elasticity never adds energy to a strand. Folded by up to 180° at its joints or coiled, it
//! keeps its shape and comes to rest after a shake, also without gravity.

use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    groom::Groom,
    material::{Material, Model, preset},
    math::RigidTransform,
    settings::Solver,
    simulation::{Simulation, StepInput},
};
use std::{f32::consts::TAU, sync::Arc};

/// Length of a frame [s].
const FRAME: f32 = 1.0 / 60.0;

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

/// The speed of the fastest point [m/s] after two seconds at rest and eight seconds after a shake, and the
/// number of resets.
fn speeds(strands: &[Vec<Vec3>], material: Material, gravity: Vec3) -> ([f32; 2], usize) {
    let groom = Arc::new(Groom::from_strands(strands, 40e-6));
    let all: Vec<u32> = (0..strands.len() as u32).collect();
    let mut points = groom.points.clone();
    let solver = Solver::default();
    let mut simulation = Simulation::builder(groom)
        .strands(&all)
        .materials(&[material])
        .solver(solver)
        .gravity(gravity)
        .build()
        .unwrap();
    let mut resets = 0;
    let mut frame = |x: f32| {
        let pose = RigidTransform { translation: Vec3::X * x, ..RigidTransform::default() };
        let roots = vec![pose; strands.len()];
        let drive = StepInput { dt: FRAME, anchor: pose, roots: &roots, obstacles: &[], air: Air::default() };
        resets += simulation.step(&drive).reset_strands;
        let before = points.clone();
        simulation.write_points(&mut points);
        before.iter().zip(&points).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max) / FRAME
    };
    let at_rest = (0..120).map(|_| frame(0.0)).skip(105).fold(0.0, f32::max);
    for k in 1..=60 {
        frame(0.02 * (TAU * 2.0 * k as f32 / 60.0).sin());
    }
    let shaken = (0..480).map(|_| frame(0.0)).skip(465).fold(0.0, f32::max);
    ([at_rest, shaken], resets)
}

#[test]
fn folded_strands_come_to_rest() {
    for model in [Model::Auto, Model::Rod, Model::Curvature] {
        for gravity in [Vec3::ZERO, Vec3::NEG_Y * 9.81] {
            let material = Material { model, ..preset("wavy").unwrap() };
            let strands = [90.0, 130.0, 150.0, 160.0, 170.0, 175.0, 179.0, 179.9].map(folded);
            let ([at_rest, shaken], resets) = speeds(&strands, material, gravity);
            println!(
                "{model:?}, gravity {gravity}: {at_rest} m/s at rest, {shaken} m/s after a shake, {resets} resets"
            );
            assert_eq!(resets, 0, "{model:?}, gravity {gravity}");
            assert!(at_rest < 1e-3, "{model:?}, gravity {gravity}: {at_rest} m/s at rest");
            assert!(shaken < 5e-3, "{model:?}, gravity {gravity}: {shaken} m/s after a shake");
        }
    }
}

#[test]
fn coils_come_to_rest() {
    for model in [Model::Auto, Model::Curvature] {
        for turns in [0.75, 1.5, 2.0, 3.0, 6.0, 12.0] {
            for gravity in [Vec3::ZERO, Vec3::NEG_Y * 9.81] {
                let material = Material { model, ..preset("curly").unwrap() };
                let ([at_rest, shaken], resets) = speeds(&[coil(turns)], material, gravity);
                println!(
                    "{model:?}, {turns} turns, gravity {gravity}: {at_rest} m/s at rest, {shaken} m/s after a shake, {resets} resets"
                );
            }
        }
    }
}
