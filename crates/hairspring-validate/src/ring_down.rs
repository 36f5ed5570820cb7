//! Measures the frequency of one mode of a strand: its root is displaced sideways once, and the mode's
//! amplitude in the following motion is timed.

use super::{
    Failure, Method,
    specimen::{Setup, Specimen},
};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Displacement of the root, over the strand's length. Small, so that the swings are linear.
const NUDGE: f64 = 2e-3;

/// Number of zeros of the motion to time.
const ZEROS: usize = 9;

/// Ratio to the first peak below which a peak counts as noise.
const DIED_OUT: f64 = 1e-3;

/// Returns the angular frequency [rad/s] of the mode with the lateral displacement `shape` at each point,
/// after the root of `setup` has moved along `aside` and back. `omega` is the expected frequency [rad/s],
/// which only determines the duration of the displacement. The result follows from the mean time between
/// zeros of the mode's amplitude.
pub fn frequency(
    setup: Setup,
    method: Method,
    length: f64,
    aside: DVec3,
    shape: &[f64],
    omega: f64,
) -> Result<f64, Failure> {
    let root = setup.points[0].as_dvec3();
    let mut specimen = Specimen::new(setup, method);
    let h = specimen.substep();
    let nudge = TAU / omega;
    let patience = (ZEROS as f64 + 3.0) * 2.0 * PI / omega;
    let (mut zeros, mut before, mut peak, mut first_peak) = (Vec::new(), 0.0, 0.0f64, 0.0f64);
    for step in 1..=((nudge + patience) / h) as u64 {
        let time = step as f64 * h;
        let moving = time < nudge;
        let out = if moving { 0.5 * NUDGE * length * (1.0 - (TAU * time / nudge).cos()) } else { 0.0 };
        specimen.small_step(root + aside * out)?;
        // The inner points have equal masses, so modes are orthogonal under this sum.
        let points = specimen.points().iter().zip(shape);
        let amplitude: f64 = points.map(|(p, w)| w * (p.as_dvec3() - root).dot(aside)).sum();
        if moving {
            before = amplitude;
            continue;
        }
        peak = peak.max(amplitude.abs());
        if before != 0.0 && (amplitude > 0.0) != (before > 0.0) {
            zeros.push(time - h * amplitude / (amplitude - before));
            // The first swing still contains the displacement of the root.
            if zeros.len() == 2 {
                first_peak = peak;
            }
            if zeros.len() > 2 && peak < DIED_OUT * first_peak {
                break;
            }
            peak = 0.0;
            if zeros.len() == ZEROS {
                break;
            }
        }
        before = amplitude;
    }
    // Half periods are valid even if the integrator damps the mode. At least three are required.
    if zeros.len() < 4 {
        return Err(Failure::DiedOut);
    }
    Ok(PI * (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0]))
}
