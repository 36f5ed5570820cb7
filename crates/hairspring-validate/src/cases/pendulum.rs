//! A pendulum of one segment, whose period grows with its amplitude.

use super::{FREQUENCY, SPRINGS_ARE_BRAKED, USUAL};
use crate::{
    AMPLITUDE_DEG, Case, Failure, Method, Parameter, Quantity,
    plot::Sweep,
    reference::pendulum::period_ratio,
    specimen::{GRAVITY, LENGTH, Setup, Specimen, pinned},
};
use glam::DVec3;
use hairspring::material::Model;
use std::f64::consts::TAU;

pub const CASE: Case = Case {
    name: "pendulum",
    about: "The free segment of a strand of three points swings as a pendulum, released at rest from an amplitude.",
    parameters: &[Parameter { symbol: &AMPLITUDE_DEG, range: (1.0, 170.0) }],
    defaults: &[&[30.0], &[90.0]],
    quantities: &[
        Quantity { name: "period over small-swing period", tolerance: FREQUENCY },
        Quantity { name: "amplitude kept in a period", tolerance: 0.05 },
    ],
    // With more points it would not be a pendulum. At four substeps, a swing of 90° keeps 91 % of its width
    // in a period, one of 30° keeps 98 %.
    method: Method { points: 3, substeps: 8, ..USUAL },
    points_fixed: true,
    min_points: 3,
    enough_points: 3,
    fails_with: &[Model::Springs],
    reason: |values, method| match method {
        Method { model: Model::Springs, .. } => Some(SPRINGS_ARE_BRAKED.into()),
        Method { substeps, .. } if values[0] > 90.0 || *substeps < 8 => Some(format!(
            "the steps remove amplitude, the more so the wider the swing ({}°) and the fewer the substeps ({substeps}): 5.0 % \
             in a period at 90° and 8 substeps, 9.1 % at 4",
            values[0]
        )),
        _ => None,
    },
    reference: |values| Ok(vec![period_ratio(values[0].to_radians()), 1.0]),
    measure: |values, method| measure(values[0].to_radians(), method),
    sweep: Sweep::Parameter { index: 0, from: 10.0, to: 150.0, log: false },
};

/// Turning points to observe: two periods.
const SWINGS: usize = 5;

fn measure(amplitude: f64, method: Method) -> Result<Vec<f64>, Failure> {
    let direction = DVec3::new(amplitude.sin(), -amplitude.cos(), 0.0);
    let points = pinned(3, LENGTH, DVec3::NEG_Y, direction);
    let pivot = points[1].as_dvec3();
    let mut specimen = Specimen::new(Setup::chain(points), method);
    let h = specimen.substep();
    let small = TAU * (LENGTH / GRAVITY).sqrt();

    let (mut zeros, mut peaks) = (Vec::new(), vec![amplitude]);
    let (mut before, mut peak) = (amplitude, 0.0f64);
    for step in 1..=(small / h * 4.0 * SWINGS as f64) as u64 {
        specimen.small_step(DVec3::ZERO)?;
        let bob = specimen.points()[2].as_dvec3() - pivot;
        let angle = bob.x.atan2(-bob.y);
        if (angle > 0.0) != (before > 0.0) {
            zeros.push((step as f64 - angle / (angle - before)) * h);
            if zeros.len() > 1 {
                peaks.push(peak);
            }
            peak = 0.0;
            if zeros.len() > SWINGS {
                break;
            }
        }
        (before, peak) = (angle, peak.max(angle.abs()));
    }
    if zeros.len() <= SWINGS {
        return Err(Failure::DiedOut);
    }
    if zeros.windows(2).any(|z| z[1] - z[0] < 0.25 * small) {
        return Err(Failure::NoSwing);
    }
    // The integrator may damp the swing. The period is extrapolated to the given amplitude along the line
    // T(θ²) through the first two half periods, each at its actual amplitude.
    let half = |k: usize| (peaks[k].powi(2), zeros[k] - zeros[k - 1]);
    let ((x1, t1), (x2, t2)) = (half(1), half(2));
    let slope = if (x1 - x2).abs() > 1e-4 * x1 { (t1 - t2) / (x1 - x2) } else { 0.0 };
    let period = 2.0 * (t1 + slope * (amplitude * amplitude - x1));
    // Over two periods, from the first turning point that the swing reached.
    let kept = (peaks[SWINGS] / peaks[1]).powf(2.0 / (SWINGS - 1) as f64);
    Ok(vec![period / small, kept])
}
