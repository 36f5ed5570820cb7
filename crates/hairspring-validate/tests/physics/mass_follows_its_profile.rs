//! Promise: a mass profile distributes a strand's mass, and every effect of mass follows it.
//!
//! Closed forms: the moment of a strand's weight; a double pendulum whose bobs have the mass of their
//! halves; a cantilever with a bead at its tip (Rayleigh's quotient); and a chain in a wind whose force
//! depends on length and not on mass.

use glam::Vec3;
use hairspring::{
    air::Air,
    groom::Groom,
    material::{Material, Model},
    settings::{Integrator, Solver, Wind},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{REST, line, points};
use hairspring_validate::bench::Bench;
use std::f64::consts::PI;

const RADIUS: f64 = 40e-6;
const LENGTH: f64 = 0.2;
const LINE: f64 = 1310.0 * PI * RADIUS * RADIUS;
const MODELS: [Model; 3] = [Model::Curvature, Model::Rod, Model::Springs];

fn strand(points: Vec<Vec3>, material: Material, solver: Solver, gravity: Vec3) -> Simulation {
    let groom = Groom::from_strands([points], RADIUS as f32);
    Simulation::builder(groom).materials(&[material]).solver(solver).gravity(gravity).build().unwrap()
}

/// Steps a strand with its root at the origin.
fn step(simulation: &mut Simulation, dt: f64, wind: Vec3) -> Vec<Vec3> {
    let air = Air { wind: Wind { velocity: wind, ..Wind::default() }, ..Air::default() };
    simulation.step(&StepInput { dt: dt as f32, anchor: REST, roots: &[REST], colliders: &[], air });
    points(simulation)
}

/// A chain of `n` points below a fixed segment that is a thousandth of its length.
fn chain(n: u32) -> Vec<Vec3> {
    let at = |i: u32| Vec3::NEG_Y * (LENGTH as f32 * (1e-3 + (i as f32 - 1.0) / (n as f32 - 2.0)));
    std::iter::once(Vec3::ZERO).chain((1..n).map(at)).collect()
}

/// The profile at `s` from 0 to 1, scaled to a mean of 1.
fn weight(profile: &[f32], s: f64) -> f64 {
    let intervals = (profile.len() - 1) as f64;
    let at = |s: f64| {
        let k = ((s * intervals) as usize).min(profile.len() - 2);
        let (a, b) = (profile[k] as f64, profile[k + 1] as f64);
        a + (b - a) * (s * intervals - k as f64)
    };
    let sum: f64 = profile.windows(2).map(|w| 0.5 * (w[0] + w[1]) as f64).sum();
    at(s) * intervals / sum
}

/// ∫ f ds from `from` to `to`, by the midpoint rule.
fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    (0..n).map(|k| f(from + (to - from) * (k as f64 + 0.5) / n as f64)).sum::<f64>() * (to - from) / n as f64
}

/// A bead at the tip: 62 % of the mass is in the last thirty-second of the length.
fn bead() -> Vec<f32> {
    let mut values = vec![1.0; 33];
    values[32] = 100.0;
    values
}

#[test]
fn the_moment_of_weight_follows_the_profile() {
    let n = 33;
    let points = line(Vec3::ZERO, Vec3::NEG_Y * LENGTH as f32, n);
    for model in MODELS {
        for profile in [vec![1.0], vec![1.0, 3.0], vec![3.0, 1.0], bead()] {
            let material = Material { model, mass_profile: profile.clone(), ..Material::default() };
            let hanging = strand(points.clone(), material, Solver::default(), Vec3::NEG_Y * 9.81);
            let w = |s: f64| if profile.len() == 1 { 1.0 } else { weight(&profile, s) };
            // The moment about the root of all but the two fixed points, from the energy of a strand that
            // hangs straight down.
            let moment = integral(1.5 / 32.0, 1.0, |s| w(s) * s) * LINE * LENGTH * LENGTH;
            let measured = hanging.energy().gravitational / -9.81;
            println!("{model:?}, {} values: {measured} kg m, expected {moment}", profile.len());
            assert!((measured / moment - 1.0).abs() < 4e-3, "{model:?}: {measured} instead of {moment}");
        }
    }
}

#[test]
fn a_strand_swings_as_a_double_pendulum_with_its_bobs() {
    let half = LENGTH / 2.0;
    for model in MODELS {
        for profile in [vec![1.0, 1.0], vec![1.0, 10.0], vec![10.0, 1.0], vec![1.0, 1.0, 1.0, 1.0, 100.0]] {
            // The upper bob has the mass of the middle half of the strand, the lower bob that of the last
            // quarter. Both segments have the same length.
            let bob = |from: f64, to: f64| integral(from, to, |s| weight(&profile, s));
            let ratio = bob(0.75, 1.0) / bob(0.25, 0.75);
            let omega = (9.81 / half * (1.0 + ratio - (ratio * (1.0 + ratio)).sqrt())).sqrt();
            let sway = 1.0 + ((1.0 + ratio) / ratio).sqrt();

            let mut points = chain(4);
            points[2].x = 0.02 / sway as f32;
            points[3].x = 0.02;
            let material = Material {
                model,
                mass_profile: profile.clone(),
                bend: 0.0,
                damping: 0.0,
                drag: 0.0,
                ..Material::default()
            };
            let solver =
                Solver { sag_free: false, integrator: Integrator::Bdf2, substeps: 16, ..Solver::default() };
            let mut simulation = strand(points, material, solver, Vec3::NEG_Y * 9.81);
            let crossings = crossings(0.0, 5, |_| step(&mut simulation, 1.0 / 960.0, Vec3::ZERO)[3].x as f64);
            let measured = 2.0 * PI / (crossings[4] - crossings[2]);
            println!("{model:?}, {profile:?}: {measured} rad/s, expected {omega}");
            assert!(
                (measured / omega - 1.0).abs() < 0.01,
                "{model:?}, {profile:?}: {measured} rad/s instead of {omega}"
            );
        }
    }
}

#[test]
fn a_bead_at_the_tip_lowers_the_frequency_of_a_cantilever() {
    let (n, length, bending) = (33, 0.1, 3.9e9 * PI / 4.0 * RADIUS.powi(4));
    let points = line(Vec3::ZERO, Vec3::X * length as f32, n);
    for model in MODELS {
        for profile in [bead(), bead().into_iter().rev().collect()] {
            // Rayleigh's quotient for the shape under a load at the tip: exact for a bead, 1.5 % high for a
            // uniform beam.
            let shape = |s: f64| 0.5 * s * s * (3.0 - s);
            let mass = LINE * length * integral(0.0, 1.0, |s| weight(&profile, s) * shape(s).powi(2));
            let omega = (3.0 * bending / (mass * length.powi(3))).sqrt();

            let material = Material {
                model,
                mass_profile: profile.clone(),
                damping: 0.0,
                drag: 0.0,
                ..Material::default()
            };
            let solver =
                Solver { sag_free: false, integrator: Integrator::Bdf2, substeps: 16, ..Solver::default() };
            // A small downward load; the beam oscillates about its static deflection.
            let push = 1e-3 * length * omega * omega;
            let mut simulation = strand(points.clone(), material, solver, Vec3::NEG_Y * push as f32);
            let crossings = crossings(-1e-3 * length, 3, |_| {
                step(&mut simulation, 1.0 / 960.0, Vec3::ZERO)[n - 1].y as f64
            });
            let measured = 2.0 * PI / (crossings[2] - crossings[0]);
            println!("{model:?}: {measured} rad/s, expected {omega}");
            assert!((measured / omega - 1.0).abs() < 0.03, "{model:?}: {measured} rad/s instead of {omega}");
        }
    }
}

/// The first `count` times [s] at which the values of `next`, one each 1/960 s, cross `level`.
fn crossings(level: f64, count: usize, mut next: impl FnMut(usize) -> f64) -> Vec<f64> {
    let mut out = Vec::new();
    let mut before = next(0) - level;
    for k in 1..20_000 {
        let now = next(k) - level;
        if (now > 0.0) != (before > 0.0) {
            out.push((k as f64 - now / (now - before)) / 960.0);
            if out.len() == count {
                return out;
            }
        }
        before = now;
    }
    panic!("{} crossings in 20 s", out.len());
}

#[test]
fn a_heavy_tip_leans_less_in_the_wind() {
    for model in MODELS {
        let lean = |profile: &[f32]| {
            let material = Material {
                model,
                mass_profile: profile.to_vec(),
                bend: 0.0,
                drag: 1.0,
                ..Material::default()
            };
            let solver = Solver { sag_free: false, ..Solver::default() };
            let mut simulation = strand(chain(34), material, solver, Vec3::NEG_Y * 9.81);
            let mut tip = 0.0;
            for _ in 0..600 {
                tip = step(&mut simulation, 1.0 / 60.0, Vec3::X * 0.1)[33].x as f64;
            }
            tip
        };
        let even = lean(&[1.0]);
        for profile in [[1.0, 3.0], [3.0, 1.0]] {
            // The slope of a chain is the wind force on the part below a point over the weight of that
            // part.
            let [a, b] = profile.map(f64::from);
            let want = integral(0.0, 1.0, |s| 0.5 * (a + b) / (a + 0.5 * (b - a) * (1.0 + s)));
            let got = lean(&profile) / even;
            println!("{model:?}, {profile:?}: {got} of a uniform strand's deflection, expected {want}");
            assert!((got / want - 1.0).abs() < 0.02, "{model:?}, {profile:?}: {got} instead of {want}");
        }
    }
}

#[test]
fn a_shaken_strand_with_any_profile_keeps_its_length() {
    for model in MODELS {
        for profile in [
            bead(),
            vec![1.0, 100.0],
            vec![100.0, 1.0],
            vec![1.0, 100.0, 1.0, 100.0],
            vec![1.0, 1.0, 1.0, 100.0],
        ] {
            let material = Material { model, mass_profile: profile.clone(), ..Material::default() };
            let mut bench = Bench::with_material(64, 32, material, Solver::default());
            for frame in 0..120 {
                let report = bench.step();
                let measure = bench.measure();
                assert_eq!((report.reset_strands, measure.non_finite), (0, 0));
                assert!(
                    measure.stretch_max < 0.011 && measure.max_depth < 1e-4,
                    "{model:?}, {profile:?}, frame {frame}: {measure:?}"
                );
            }
            println!("{model:?}, {} values: {:?}", profile.len(), bench.measure());
        }
    }
}
