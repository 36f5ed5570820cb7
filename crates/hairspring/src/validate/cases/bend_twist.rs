//! A naturally curved strand that hangs: heavy enough it lies in its plane, below a certain weight it winds out of it.

use super::THRESHOLD;
use crate::validate::{
    Case, Failure, GJ_OVER_EI, KAPPA_L, Method, Parameter, Quantity,
    plot::Sweep,
    reference::stability::curl_threshold,
    southwell,
    specimen::{GRAVITY, LENGTH, Setup, Specimen, curve},
};
use glam::DVec3;

pub const CASE: Case = Case {
    name: "bend-twist",
    about: "A naturally curved strand, clamped with its tangent down, leaves its plane below a weight Γ*.",
    parameters: &[
        Parameter { symbol: &KAPPA_L, range: (5.0, 20.0) },
        Parameter { symbol: &GJ_OVER_EI, range: (0.3, 1.5) },
    ],
    defaults: &[&[8.0, 2.0 / 3.0], &[8.0, 0.458], &[15.0, 2.0 / 3.0], &[15.0, 0.458]],
    quantities: &[Quantity { name: "threshold Γ*", tolerance: THRESHOLD }],
    method: Method { points: 64, substeps: 4 },
    reference: |values| Ok(vec![curl_threshold(values[0], values[1]).ok_or(Failure::NoThreshold)?]),
    measure: |values, method| {
        let &[curl, ratio] = values else { unreachable!("two parameters") };
        // Heavy strands hang nearly straight, whatever the ratio; a light one is its natural arc.
        let (heavy, light) = (curl.powi(3) / ratio, 0.02 * curl.powi(3));
        Ok(vec![southwell::threshold(heavy, light, |gamma| stiffness(curl, ratio, gamma, method))?])
    },
    sweep: Sweep::Parameter { index: 1, from: 0.35, to: 1.2, log: false },
};

/// Sideways gravity over the vertical one.
const TILT: f64 = 1e-3;

/// Sideways gravity over the tip's way out of the plane, both relative.
fn stiffness(curl: f64, ratio: f64, gamma: f64, method: Method) -> Result<Option<f64>, Failure> {
    let points = curve(method.points, LENGTH, (DVec3::NEG_Y, DVec3::X), |s| curl * s);
    let mut setup = Setup::heavy(points, gamma, ratio);
    setup.gravity = DVec3::new(0.0, -1.0, TILT).normalize() * GRAVITY;
    let mut specimen = Specimen::new(setup, method);
    specimen.settle()?;
    let aside = specimen.tip().z / LENGTH;
    Ok((aside.abs() < southwell::SMALL).then_some(TILT / aside))
}
