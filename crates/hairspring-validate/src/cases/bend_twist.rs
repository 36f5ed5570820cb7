//! A hanging strand with natural curvature: above a threshold weight it stays in its plane, below it winds
//! out of the plane.

use super::{THRESHOLD, USUAL};
use crate::{
    Case, Failure, GJ_OVER_EI, KAPPA_L, Method, Parameter, Quantity,
    plot::Sweep,
    reference::stability::curl_threshold,
    southwell,
    specimen::{LENGTH, Setup, Specimen, helix},
};
use glam::DVec3;
use hairspring::material::Model;
use std::f64::consts::TAU;

pub const CASE: Case = Case {
    name: "bend-twist",
    about: "A naturally curved strand, clamped with its tangent down, buckles out of its plane if Γ is below Γ*.",
    parameters: &[
        Parameter { symbol: &KAPPA_L, range: (5.0, 20.0) },
        Parameter { symbol: &GJ_OVER_EI, range: (0.3, 1.5) },
    ],
    defaults: &[&[8.0, 2.0 / 3.0], &[8.0, 0.458], &[15.0, 2.0 / 3.0], &[15.0, 0.458]],
    quantities: &[Quantity { name: "threshold Γ*", tolerance: THRESHOLD }],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 64,
    fails_with: &[Model::Springs],
    reason: |values, method| {
        let turn = values[0] / f64::from(method.points - 1);
        let segments = TAU / turn;
        match method.model {
            Model::Springs if turn < 0.08 => None,
            Model::Springs => Some(format!(
                "each joint turns by {turn:.2} rad at rest, where the springs resist twist more than the fiber does; at \
                 0.08 rad they pass"
            )),
            _ => (segments < 20.0).then(|| format!("a turn of the curl has only {segments:.1} segments")),
        }
    },
    reference: |values| Ok(vec![curl_threshold(values[0], values[1]).ok_or(Failure::NoThreshold)?]),
    measure: |values, method| {
        let &[curl, ratio] = values else { unreachable!("two parameters") };
        // Heavy strands hang nearly straight, whatever the ratio; a light strand has its natural curvature.
        let (heavy, light) = (curl.powi(3) / ratio, 0.02 * curl.powi(3));
        Ok(vec![southwell::threshold(heavy, light, |gamma| stiffness(curl, ratio, gamma, method))?])
    },
    sweep: Sweep::Parameter { index: 1, from: 0.35, to: 1.2, log: false },
};

/// Natural twist that serves as the imperfection of the planar shape, over the whole strand [rad].
const TWIST: f64 = 0.005;

/// Root-mean-square distance from the plane, over the curl's radius, above which a strand has left its plane [1].
const LEFT: f64 = 0.2;

/// Natural twist over the distance by which it moves the strand out of its plane (root mean square over the
/// length).
fn stiffness(curl: f64, ratio: f64, gamma: f64, method: Method) -> Result<Option<f64>, Failure> {
    // In the plane z = 0, except for the twist along the first tangent.
    let turn = DVec3::Z * curl + DVec3::NEG_Y * TWIST;
    let points = helix(method.points, LENGTH, DVec3::NEG_Y, turn);
    let mut specimen = Specimen::new(Setup::heavy(points, gamma, ratio), method);
    let rest = specimen.settle()?;
    let squares: f64 = rest.iter().map(|p| p.z * p.z).sum();
    let deflection = (squares / rest.len() as f64).sqrt() / LENGTH;
    Ok((deflection < LEFT / curl).then_some(TWIST / deflection))
}
