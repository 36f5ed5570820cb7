//! A limp strand hangs between two supports at one height.

use super::{STATIC, USUAL};
use crate::{
    Case, Failure, LENGTH_OVER_SPAN, Method, Parameter, Quantity,
    plot::Sweep,
    reference::catenary::catenary,
    specimen::{FOLLICLE, LENGTH, Setup, Specimen},
};
use glam::{DVec3, Vec3};
use hairspring::simulation::Hold;

pub const CASE: Case = Case {
    name: "catenary",
    about: "A limp strand hangs between two supports at one height.",
    parameters: &[Parameter { symbol: &LENGTH_OVER_SPAN, range: (1.02, 10.0) }],
    defaults: &[&[1.25], &[2.0]],
    quantities: &[
        Quantity { name: "sag over span", tolerance: STATIC },
        Quantity { name: "end tension over weight", tolerance: STATIC },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 4,
    enough_points: 16,
    fails_with: &[],
    reason: |_, _| None,
    reference: |values| {
        let shape = catenary(values[0]);
        Ok(vec![shape.sag, shape.end_tension])
    },
    measure: |values, method| measure(values[0], method),
    sweep: Sweep::Parameter { index: 0, from: 1.03, to: 4.0, log: true },
};

fn measure(length_over_span: f64, method: Method) -> Result<Vec<f64>, Failure> {
    let span = LENGTH / length_over_span;
    // The right length between the supports, but far from a catenary: straight down, across, and up again.
    let segments = method.points - 2;
    let (l, flat) = (LENGTH / segments as f64, segments % 2);
    let slope = (segments - flat) as f64 / 2.0;
    let across = (span - flat as f64 * l) / (2.0 * slope * l);
    let down = DVec3::new(across, -(1.0 - across * across).max(0.0).sqrt(), 0.0);
    // The held segment ends at the first support.
    let mut at = DVec3::ZERO;
    let mut points = vec![(down * (-FOLLICLE * LENGTH)).as_vec3(), Vec3::ZERO];
    for k in 0..segments {
        let side = (k as f64 + 0.5 - segments as f64 / 2.0).signum() * f64::from(k * 2 + 1 != segments);
        at += match side {
            s if s < 0.0 => down,
            s if s > 0.0 => DVec3::new(down.x, -down.y, 0.0),
            _ => DVec3::X,
        } * l;
        points.push(at.as_vec3());
    }
    let first = points[0];
    let mut setup = Setup::chain(points);
    setup.material.drag = 2.5;
    let mut specimen = Specimen::new(setup, method);
    let support = Vec3::X * span as f32;
    specimen.hold(&[Hold { point: method.points - 1, target: Some(support), ..Hold::default() }]);
    let rest: Vec<DVec3> = specimen.settle()?.iter().map(|p| *p + first.as_dvec3()).collect();
    let sag = -rest.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    // A support carries half of the weight. A segment next to it carries all of that except its nearer half
    // point, and its slope gives the horizontal force.
    let bears = 0.5 - 0.5 / segments as f64;
    let pulls = |a: DVec3, b: DVec3| bears * ((b.x - a.x) / (b.y - a.y)).abs();
    let n = rest.len();
    let sideways = 0.5 * (pulls(rest[1], rest[2]) + pulls(rest[n - 2], rest[n - 1]));
    Ok(vec![sag / span, sideways.hypot(0.5)])
}
