//! A strand that lies across a slope slips where the slope is steeper than friction allows.

use super::{FRICTION, USUAL};
use crate::{
    Case, Failure, MU, Method, Parameter, Quantity,
    plot::Sweep,
    specimen::{GRAVITY, LENGTH, Setup, Specimen, pinned},
};
use glam::{DVec3, Vec3};
use hairspring::collide::ColliderShape;

pub const CASE: Case = Case {
    name: "incline",
    about: "A limp strand that lies across a slope slips where the slope's tangent is above μ.",
    parameters: &[Parameter { symbol: &MU, range: (0.01, 1.0) }],
    defaults: &[&[0.1], &[0.3], &[0.6]],
    quantities: &[Quantity { name: "tan θ at which it slips", tolerance: FRICTION }],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 3,
    fails_with: &[],
    reason: |_, _| None,
    reference: |values| Ok(vec![values[0]]),
    measure: |values, method| {
        let mu = values[0];
        // Bisection by experiments: the strand slips or holds.
        let (mut holds, mut slips) = (0.0, 4.0 * mu);
        if !slides(mu, slips, method)? {
            return Err(Failure::NoThreshold);
        }
        while slips - holds > 1e-3 * mu {
            let slope = 0.5 * (holds + slips);
            if slides(mu, slope, method)? { slips = slope } else { holds = slope }
        }
        Ok(vec![0.5 * (holds + slips)])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.05, to: 1.0, log: false },
};

/// Number of frames: 1 s, in which a slope that is too steep by a thousandth of μ = 0.1 moves the strand by
/// half a millimeter.
const FRAMES: u32 = 60;

/// Displacement of the tip above which it has slipped, over the length.
const SLIPPED: f64 = 1e-3;

/// Returns whether a strand across a slope of tangent `slope` slips. The root is held and pulls on the points
/// next to it; the tip is free.
fn slides(mu: f64, slope: f64, method: Method) -> Result<bool, Failure> {
    let mut setup = Setup::chain(pinned(method.points, LENGTH, DVec3::X, DVec3::X));
    setup.material.friction = mu as f32;
    setup.collider = Some(ColliderShape::Plane { point: Vec3::ZERO, normal: Vec3::Y });
    // The slope stays horizontal, and gravity is tilted instead.
    setup.gravity = DVec3::new(0.0, -1.0, slope).normalize() * GRAVITY;
    let mut specimen = Specimen::new(setup, method);
    let start = specimen.tip();
    for _ in 0..FRAMES {
        specimen.frame()?;
        if specimen.tip().distance(start) > SLIPPED * LENGTH {
            return Ok(true);
        }
    }
    Ok(false)
}
