//! A straight strand, bent to a ring and twisted, writhes out of its plane: Michell's instability.

use super::{NO_TWIST, THRESHOLD, TWISTED};
use crate::{
    Case, Failure, GJ_OVER_EI, Method, Parameter, Quantity,
    plot::Sweep,
    reference::ring::writhing_twist,
    southwell,
    specimen::{BENDING, LENGTH, Setup, Specimen, straight},
};
use glam::{DQuat, DVec3, Vec3};
use hairspring::{material::Model, simulation::Hold};
use std::f64::consts::TAU;

pub const CASE: Case = Case {
    name: "michell",
    about: "A straight strand bent to a closed ring and twisted writhes out of its plane.",
    parameters: &[Parameter { symbol: &GJ_OVER_EI, range: (0.3, 1.5) }],
    defaults: &[&[0.458], &[1.0]],
    quantities: &[Quantity { name: "total twist Φ [rad]", tolerance: THRESHOLD }],
    method: TWISTED,
    points_fixed: false,
    min_points: 6,
    enough_points: 64,
    fails_with: &[Model::Curvature, Model::Springs, Model::Auto],
    reason: |values, method| {
        match method.model {
        Model::Curvature => Some(NO_TWIST.into()),
        Model::Springs => Some(
            "a ring of round fiber rotates about its clamped tangent without energy; the joints of a truss have preferred \
             bending directions, and the ring rotates to them"
                .into(),
        ),
        Model::Auto => Some(
            "for a strand that is straight at rest, auto selects the curvature model, which has no twist".into(),
        ),
        // The rod.
        _ => {
            let joints = f64::from(method.points - 1);
            let (turn, twist) = (TAU / joints, writhing_twist(values[0]) / joints);
            (twist > LARGEST_TWIST).then(|| {
                format!(
                    "each joint of the ring turns by {turn:.2} rad and twists by {twist:.2} rad, too much for the twist \
                     measure"
                )
            })
        }
    }
    },
    reference: |values| Ok(vec![writhing_twist(values[0])]),
    measure: |values, method| {
        let ratio = values[0];
        // In units of EI/GJ, the twist does not depend on the ratio.
        let (start, end) = (3.0 / ratio, 30.0 / ratio);
        Ok(vec![southwell::threshold(start, end, |twist| stiffness(twist, ratio, method))?])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.35, to: 1.4, log: false },
};

/// Twist of a joint that the twist measure represents [rad]: 64 points with that of human hair pass.
const LARGEST_TWIST: f64 = 0.4;

/// Frames in which the strand is bent to a ring.
const BENDING_FRAMES: u32 = 240;

/// Largest rotation of the root in a frame [rad].
const TURN: f64 = 0.05;

/// Size of the out-of-plane load: it would bend an untwisted ring out of its plane by this share of its
/// length.
const PULL: f64 = 1e-3;

/// Change of the mode below which it is at rest, over the load.
const STILL: f64 = 3e-3;

/// Out-of-plane load over deflection, under a total twist [rad].
fn stiffness(twist: f64, ratio: f64, method: Method) -> Result<Option<f64>, Failure> {
    let n = method.points;
    let mut specimen = Specimen::new(Setup::weightless(straight(n, LENGTH, DVec3::X), ratio), method);
    // The load has two waves around the ring, as the first unstable mode. It is in balance, and does no work
    // when the whole ring rotates about its clamped tangent, which costs a round strand no energy. Its sign
    // is that of the effect of the first and last segments, which are fully clamped, on a ring of few points.
    let radius = LENGTH / TAU;
    let unit = PULL * LENGTH * BENDING / radius.powi(4) * LENGTH / (n - 1) as f64;
    let wave = |i: u32| -(2.0 * TAU * i as f64 / (n - 1) as f64).sin();
    // Exact to the last digit: a remainder would rotate the ring about its tangent forever.
    let hinge = |i: u32| 1.0 - (TAU * i as f64 / (n - 1) as f64).cos();
    let sum = |f: &dyn Fn(u32) -> f64| (2..n - 2).map(f).sum::<f64>();
    let remainder = sum(&|i| wave(i) * hinge(i)) / sum(&|i| hinge(i) * hinge(i)).max(f64::MIN_POSITIVE);
    let pull = |i: u32| {
        let force = Vec3::Z * (unit * (wave(i) - remainder * hinge(i))) as f32;
        Hold { point: i, force, ..Hold::default() }
    };

    for frame in 1..=BENDING_FRAMES {
        specimen.hold(&ends(n, TAU * frame as f64 / BENDING_FRAMES as f64));
        specimen.frame()?;
    }
    let turns = (twist / TURN).ceil();
    for _ in 0..turns as u32 {
        specimen.turn_root(DVec3::X * (twist / turns));
        specimen.frame()?;
    }
    let mut holds: Vec<Hold> = (2..n - 2).map(pull).collect();
    holds.extend(ends(n, TAU));
    specimen.hold(&holds);
    let deflection = |points: &[DVec3]| {
        let projection: f64 = points.iter().zip(0..n).map(|(p, i)| p.z * wave(i)).sum();
        2.0 * projection / (n - 1) as f64 / LENGTH
    };
    // A ring of few points still rotates about its tangent, by a few micrometers a second. Only the mode has
    // to come to rest.
    let rest = specimen.settle_where(|a, b| (deflection(a) - deflection(b)).abs() < STILL * PULL)?;
    let deflection = deflection(&rest);
    // A ring that has writhed passes through itself (there is no self-collision), loses two turns, and lies
    // flat again with the opposite twist.
    Ok((deflection > 0.0 && deflection < southwell::SMALL).then_some(PULL / deflection))
}

/// Holds for the last two points of a strand that starts at the origin along X, is bent to an arc of `angle`
/// [rad], and is clamped.
fn ends(n: u32, angle: f64) -> [Hold; 2] {
    let segments = (n - 1) as f64;
    let direction = |s: f64| DQuat::from_rotation_z(angle * s) * DVec3::X * (LENGTH / segments);
    // The first and the last segment have the directions of the clamps; the others have those of their
    // centers.
    let inner: DVec3 = (1..n - 2).map(|i| direction((i as f64 + 0.5) / segments)).sum();
    let before = direction(0.0) + inner;
    let hold = |point: u32, at: DVec3, clamped: bool| Hold {
        point,
        target: Some(at.as_vec3()),
        clamped,
        ..Hold::default()
    };
    [hold(n - 2, before, true), hold(n - 1, before + direction(1.0), false)]
}
