//! A straight upright strand buckles under its own weight.

use super::{HAIR, THRESHOLD, USUAL};
use crate::{
    Case, Failure, GAMMA, Method, Quantity,
    plot::{Axis, Curve, Plot, Sweep, evaluate, places},
    reference::{elastica::standing_deflection, stability::greenhill},
    southwell,
    specimen::{GRAVITY, LENGTH, Setup, Specimen, straight},
};
use glam::DVec3;

pub const CASE: Case = Case {
    name: "greenhill",
    about: "A straight strand clamped upright buckles under its own weight at Γ = 7.8373.",
    parameters: &[],
    defaults: &[&[]],
    quantities: &[Quantity { name: "threshold Γ", tolerance: THRESHOLD }],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 8,
    fails_with: &[],
    reason: |_, _| None,
    reference: |_| Ok(vec![greenhill()]),
    measure: |_, method| {
        let stiffness = |gamma| {
            let deflected = deflection(gamma, method)? * TILT;
            // The load grows with the weight, so it is scaled to units of EI/L².
            Ok((deflected.abs() < southwell::SMALL).then_some(gamma * TILT / deflected))
        };
        Ok(vec![southwell::threshold(1.0, 40.0, stiffness)?])
    },
    sweep: Sweep::Own(plot),
};

/// Sideways gravity over vertical gravity.
const TILT: f64 = 2e-3;

/// Tip deflection over length, extrapolated linearly to sideways gravity as large as the vertical one.
fn deflection(gamma: f64, method: Method) -> Result<f64, Failure> {
    let mut setup = Setup::heavy(straight(method.points, LENGTH, DVec3::Y), gamma, HAIR);
    setup.gravity = DVec3::new(TILT, -1.0, 0.0).normalize() * GRAVITY;
    let mut specimen = Specimen::new(setup, method);
    let tip = specimen.settle()?[method.points as usize - 1];
    Ok(tip.x / LENGTH / TILT)
}

/// The response to sideways gravity, which grows without bound toward the threshold.
fn plot(method: Method) -> Plot {
    let pair = |points: Vec<(f64, f64)>| points.into_iter().map(|(x, y)| [x, y]).collect();
    let curve = Curve {
        name: "tip deflection over tilt".into(),
        reference: pair(evaluate(&places(0.5, 7.6, false, 60), |g| Ok(standing_deflection(g)))),
        measured: pair(evaluate(&places(0.5, 7.5, false, 9), |g| deflection(g, method))),
    };
    Plot {
        x: Axis { label: GAMMA.meaning.into(), log: false },
        y: Axis { label: "tip deflection over L and over sideways gravity".into(), log: true },
        curves: vec![curve],
    }
}
