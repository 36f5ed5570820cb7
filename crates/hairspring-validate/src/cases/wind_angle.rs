//! A limp strand hangs straight in a horizontal wind.

use super::{AIR, USUAL};
use crate::{
    Case, Failure, Method, Parameter, Quantity, WIND_SPEED,
    plot::Sweep,
    reference::cylinder::wind_angle,
    specimen::{DENSITY, GRAVITY, LENGTH, RADIUS, Setup, Specimen, pinned},
};
use glam::DVec3;

pub const CASE: Case = Case {
    name: "wind-angle",
    about: "A limp strand hangs straight in a horizontal wind, at the angle where drag and weight balance.",
    parameters: &[Parameter { symbol: &WIND_SPEED, range: (0.02, 20.0) }],
    defaults: &[&[0.1], &[1.0], &[5.0]],
    quantities: &[Quantity { name: "angle from the vertical [°]", tolerance: AIR }],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 32,
    fails_with: &[],
    reason: |_, _| None,
    reference: |values| Ok(vec![wind_angle(values[0], 2.0 * RADIUS, DENSITY, GRAVITY).to_degrees()]),
    measure: |values, method| measure(values[0], method),
    sweep: Sweep::Parameter { index: 0, from: 0.05, to: 10.0, log: true },
};

fn measure(speed: f64, method: Method) -> Result<Vec<f64>, Failure> {
    let mut setup = Setup::limp(pinned(method.points, LENGTH, DVec3::NEG_Y, DVec3::NEG_Y));
    setup.material.drag = 1.0;
    setup.wind = DVec3::X * speed;
    let rest = Specimen::new(setup, method).settle()?;
    let chord = rest[rest.len() - 1] - rest[1];
    Ok(vec![chord.x.atan2(-chord.y).to_degrees()])
}
