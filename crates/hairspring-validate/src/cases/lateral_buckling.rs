//! A flat strand, clamped horizontally on its edge, buckles laterally under its own weight or under a load at
//! its tip.

use super::{HAIR, HELD_BACK, NO_TWIST, THRESHOLD, USUAL, times_as_long};
use crate::{
    Case, Failure, GJ_OVER_EI, Method, Parameter, Quantity,
    plot::Sweep,
    reference::stability::{flat, lateral},
    southwell,
    specimen::{DENSITY, GRAVITY, LENGTH, LINE_DENSITY, RADIUS, Setup, Specimen, straight},
};
use glam::DVec3;
use hairspring::{material::Model, simulation::Hold};

pub const CASE: Case = Case {
    name: "lateral-buckling",
    about: "A flat strand clamped horizontally on its edge tips over sideways.",
    // Relative to the weak direction, GJ/EI_min.
    parameters: &[Parameter { symbol: &GJ_OVER_EI, range: (0.2, 2.0) }],
    defaults: &[&[HAIR]],
    quantities: &[
        Quantity { name: "own weight qL³/√(EI_min GJ)", tolerance: THRESHOLD },
        Quantity { name: "tip load PL²/√(EI_min GJ)", tolerance: THRESHOLD },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 64,
    fails_with: &[Model::Curvature],
    reason: |_, method| match method {
        Method { model: Model::Curvature, .. } => Some(NO_TWIST.into()),
        Method { model: Model::Springs, points: 80.., .. } => Some(HELD_BACK.into()),
        Method { points: ..64, .. } => Some(format!(
            "the error is proportional to the segment length: 2.4 % at 64 points, and here a segment is {:.1} times as long",
            times_as_long(method)
        )),
        _ => None,
    },
    reference: |values| {
        // With the strand's own flatness. Its in-plane deflection before buckling adds less than a percent.
        let strand = flat(1.0, FLATNESS.powi(-2), values[0]);
        let unit = values[0].sqrt();
        let load =
            |weight, tip| lateral(&strand, weight, tip).map(|load| load / unit).ok_or(Failure::NoThreshold);
        Ok(vec![load(1.0, 0.0)?, load(0.0, 1.0)?])
    },
    measure: |values, method| {
        let ratio = values[0];
        let threshold = |hung, expected: f64| {
            let (start, end) = (0.4 * expected, 4.0 * expected);
            southwell::threshold(start, end, |load| stiffness(hung, load, ratio, method))
        };
        let (weight, tip) = rayon::join(|| threshold(Hung::Along, 10.0), || threshold(Hung::AtTip, 4.0));
        Ok(vec![weight?, tip?])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.3, to: 1.5, log: false },
};

/// Short over long axis of the cross section. The stiff direction is a hundred times as stiff as the weak
/// one.
const FLATNESS: f64 = 0.1;

/// Sideways load over the load.
const TILT: f64 = 1e-3;

/// Where the load acts.
#[derive(Clone, Copy, PartialEq)]
enum Hung {
    Along,
    AtTip,
}

/// Sideways load over sideways deflection of the tip, both relative, under `load` in units of √(EI_min GJ).
fn stiffness(hung: Hung, load: f64, ratio: f64, method: Method) -> Result<Option<f64>, Failure> {
    // A hair of the usual weight; the load determines the stiffness: load √(EI GJ) = load EI √ratio = ρAgL³.
    let weight = LINE_DENSITY * GRAVITY * LENGTH;
    let bending = weight * LENGTH * LENGTH / (load * ratio.sqrt());
    // For an ellipse of area πr²: EI_min = E πr⁴f/4 and GJ/EI_min = 4G / E(1 + f²).
    let young = bending * 4.0 * DENSITY / (LINE_DENSITY * RADIUS * RADIUS * FLATNESS);
    // The long axis is parallel to the frame's normal at the root, which is Y for a strand along X: the
    // strand is on its edge.
    let mut setup = Setup::heavy(straight(method.points, LENGTH, DVec3::X), 1.0, ratio);
    setup.material.young = young as f32;
    setup.material.shear = (0.25 * ratio * young * (1.0 + FLATNESS * FLATNESS)) as f32;
    setup.material.flatness = FLATNESS as f32;
    let down = DVec3::new(0.0, -1.0, TILT).normalize();
    setup.gravity = if hung == Hung::Along { down * GRAVITY } else { DVec3::ZERO };
    let mut specimen = Specimen::new(setup, method);
    if hung == Hung::AtTip {
        let force = (down * weight).as_vec3();
        specimen.hold(&[Hold { point: method.points - 1, force, ..Hold::default() }]);
    }
    let deflection = specimen.settle()?[method.points as usize - 1].z / LENGTH;
    // The sideways load grows with the load, so it is scaled to units of the stiffness.
    Ok((deflection.abs() < southwell::SMALL).then_some(load * TILT / deflection))
}
