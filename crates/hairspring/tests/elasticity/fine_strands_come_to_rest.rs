//! Promise: strands of 3 to 1,024 points, with segments from 0.1 mm to 5 cm, stay as authored and come to
//! rest after a shake. This holds in every preset and with a damping of 0 to 2 s, and no strand is reset.

use glam::Vec3;
use hairspring::{
    groom::Groom,
    material::{Material, PRESETS, preset},
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{FRAME, points, step, translation};
use std::{f32::consts::TAU, sync::Arc};

/// A strand of `points` along a coil of `turns` that hangs down by `length` [m].
fn coil(points: usize, length: f32, turns: f32) -> Vec<Vec3> {
    let at = |i: usize| {
        let t = i as f32 / (points - 1) as f32;
        let (sin, cos) = (TAU * turns * t).sin_cos();
        let radius = 0.05 * length;
        Vec3::new(radius * (cos - 1.0), -length * t, radius * sin)
    };
    (0..points).map(at).collect()
}

fn strands() -> Groom {
    let strands = [
        coil(3, 0.1, 0.0),
        coil(12, 0.55, 0.5),
        coil(100, 0.1, 0.0),
        coil(200, 0.15, 3.0),
        coil(256, 0.25, 1.0),
        coil(512, 0.5, 2.0),
        coil(1024, 0.1, 1.0),
        coil(1024, 1.0, 1.0),
    ];
    Groom::from_strands(strands, 40e-6)
}

struct Scene {
    simulation: Simulation,
    points: Vec<Vec3>,
    groom: Arc<Groom>,
    /// The speed of each strand's fastest point in the last frame [m/s].
    fastest: Vec<f32>,
}

impl Scene {
    fn new(material: Material, solver: Solver) -> Self {
        let groom = Arc::new(strands());
        let points = groom.points.clone();
        let simulation =
            Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap();
        Self { simulation, points, groom, fastest: Vec::new() }
    }

    /// Simulates a frame, at the end of which the roots are at `x` [m]; returns the speed of the fastest
    /// point [m/s].
    fn frame(&mut self, x: f32) -> f32 {
        let head = translation(Vec3::X * x);
        let roots = vec![head; self.simulation.strand_count()];
        step(&mut self.simulation, head, &roots, &[]);
        let before = std::mem::replace(&mut self.points, points(&self.simulation));
        let speed = |k: usize| before[k].distance(self.points[k]) / FRAME;
        let fastest = self
            .groom
            .offsets
            .windows(2)
            .map(|w| w[0] as usize..w[1] as usize)
            .map(|range| range.map(speed).fold(0.0, f32::max));
        self.fastest = fastest.collect();
        self.fastest.iter().copied().fold(0.0, f32::max)
    }

    /// Simulates `seconds` with the roots at rest; returns the speed of the fastest point in the last
    /// quarter of a second [m/s].
    fn rest(&mut self, seconds: f32) -> f32 {
        let frames = (seconds / FRAME).round() as usize;
        let speeds: Vec<f32> = (0..frames).map(|_| self.frame(0.0)).collect();
        speeds[frames - 15..].iter().copied().fold(0.0, f32::max)
    }

    /// Shakes the roots by 5 cm at 2 Hz for a second.
    fn shake(&mut self) {
        for frame in 1..=60 {
            self.frame(0.05 * (TAU * 2.0 * frame as f32 / 60.0).sin());
        }
    }
}

/// The speeds at rest and 8 s after a shake [m/s].
fn speeds(name: &str, material: Material, substeps: u32) -> [f32; 2] {
    let solver = Solver { substeps, ..Solver::default() };
    let mut scene = Scene::new(material, solver);
    let at_rest = scene.rest(2.0);
    scene.shake();
    let shaken = scene.rest(8.0);
    println!(
        "{name}, {substeps} substeps: {at_rest:.5} m/s at rest, {shaken:.5} m/s after a shake, by strand {:.4?}",
        scene.fastest
    );
    [at_rest, shaken]
}

fn check(name: &str, material: Material, substeps: u32) -> bool {
    let [at_rest, shaken] = speeds(name, material, substeps);
    at_rest < 1e-3 && shaken < 5e-3
}

#[test]
fn every_preset_comes_to_rest() {
    let moving: Vec<&str> =
        PRESETS.into_iter().filter(|name| !check(name, preset(name).unwrap(), 4)).collect();
    assert!(moving.is_empty(), "presets that are still moving: {moving:?}");
}

#[test]
fn any_damping_comes_to_rest() {
    let wavy = preset("wavy").unwrap();
    let mut moving = Vec::new();
    for (damping, substeps) in [(0.0, 4), (0.5, 4), (2.0, 4), (0.0, 2), (2.0, 2), (0.5, 16)] {
        let name = format!("damping {damping} s");
        if !check(&name, Material { damping, ..wavy.clone() }, substeps) {
            moving.push((damping, substeps));
        }
    }
    assert!(moving.is_empty(), "still moving: {moving:?}");
}

/// One substep of 1/60 s is too long for a shake, after which some strands move for longer than 8 s.
#[test]
fn one_substep_stays_at_rest() {
    let wavy = preset("wavy").unwrap();
    for damping in [0.0, 2.0] {
        let solver = Solver { substeps: 1, ..Solver::default() };
        let mut scene = Scene::new(Material { damping, ..wavy.clone() }, solver);
        let fastest = scene.rest(2.0);
        assert!(fastest < 1e-3, "damping {damping} s: {fastest} m/s");
    }
}
