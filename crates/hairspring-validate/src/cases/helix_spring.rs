//! A helical spring under small forces at its tip: along its axis, which twists the wire, and across it,
//! which bends it.

use super::{HAIR, USUAL};
use crate::{
    Case, Failure, Method, Parameter, Quantity, TURNS,
    plot::Sweep,
    reference::helix::compliance_along,
    specimen::{BENDING, LENGTH, Setup, Specimen},
};
use glam::DVec3;
use hairspring::{material::Model, simulation::Hold};
use rayon::prelude::*;
use std::f64::consts::TAU;

pub const CASE: Case = Case {
    name: "helix-spring",
    about: "A helix clamped at its root deflects under a small tip force like a coil spring.",
    parameters: &[Parameter { symbol: &TURNS, range: (0.5, 6.0) }],
    // 8, 14 and 32 segments a turn at 32 points.
    defaults: &[&[31.0 / 8.0], &[31.0 / 14.0], &[31.0 / 32.0]],
    quantities: &[
        Quantity { name: "compliance along the axis, over the wire's", tolerance: 0.05 },
        Quantity { name: "compliance along the turn, over the wire's", tolerance: 0.05 },
        Quantity { name: "compliance along the radius, over the wire's", tolerance: 0.05 },
    ],
    method: Method { points: 32, ..USUAL },
    points_fixed: false,
    min_points: 3,
    enough_points: 32,
    fails_with: &[Model::Springs],
    reason: |values, method| {
        let segments = f64::from(method.points - 1) / values[0];
        match method.model {
            Model::Springs if segments < 16.0 => Some(format!(
                "a truss with {segments:.1} segments a turn is stiffer than the curve that it represents"
            )),
            _ => (segments < 8.0).then(|| {
                format!(
                    "a turn has only {segments:.1} segments, so each joint turns by {:.2} rad; with 8 segments it passes",
                    TAU / segments
                )
            }),
        }
    },
    reference: |_| Ok(vec![1.0; 3]),
    measure: |values, method| {
        let measure = |direction| {
            let expected = compliance_along(direction, values[0], PITCH, HAIR);
            Ok(compliance(values[0], direction, expected, method)? / expected)
        };
        [DVec3::Z, DVec3::Y, DVec3::X].into_par_iter().map(measure).collect()
    },
    sweep: Sweep::Parameter { index: 0, from: 0.75, to: 4.0, log: false },
};

/// Pitch angle [rad].
const PITCH: f64 = 0.25;

/// Largest displacement of the tip by the load, over the spring's height.
const STRAIN: f64 = 0.005;

/// Bound of the load, in EI sin(pitch)/H², the order of the load at which the spring buckles as a column of
/// height H.
const SLENDER: f64 = 0.02;

/// Displacement below which the strand counts as at rest, over the displacement to measure.
const SHARE: f64 = 2e-3;

/// Returns δEI/FR²L along `direction` (radial out, along the turn, along the axis) at the tip. Two loads of
/// opposite sign are used, so that second-order effects cancel. `expected` determines the size of the load.
fn compliance(turns: f64, direction: DVec3, expected: f64, method: Method) -> Result<f64, Failure> {
    let segments = (method.points - 1) as f64;
    let radius = LENGTH * PITCH.cos() / (TAU * turns);
    let height = LENGTH * PITCH.sin();
    // On the curve, as the points of a groom are, with the tip at the angle 0.
    let point = |i: u32| {
        let s = i as f64 / segments;
        let (sin, cos) = (TAU * turns * (s - 1.0)).sin_cos();
        DVec3::new(radius * cos, radius * sin, height * s).as_vec3()
    };
    let unit = radius * radius * LENGTH / BENDING;
    let load = (STRAIN * height / (expected * unit)).min(SLENDER * BENDING * PITCH.sin() / (height * height));
    let tip_under = |load: f64| -> Result<DVec3, Failure> {
        let setup = Setup::weightless((0..method.points).map(point).collect(), HAIR);
        let mut specimen = Specimen::new(setup, method);
        let force = (direction * load).as_vec3();
        specimen.hold(&[Hold { point: method.points - 1, force, ..Hold::default() }]);
        Ok(specimen.settle_within(SHARE * load.abs() * expected * unit)?[method.points as usize - 1])
    };
    let (up, down) = rayon::join(|| tip_under(load), || tip_under(-load));
    Ok((up? - down?).dot(direction) / (2.0 * load * unit))
}
