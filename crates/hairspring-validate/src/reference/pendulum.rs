//! The planar pendulum: its period from the complete elliptic integral of the first kind.

use super::elliptic::complete;
use std::f64::consts::FRAC_PI_2;

/// Period at `amplitude` [rad], from 0 to below π, over that of small swings: 2K(sin(θ₀/2))/π.
pub fn period_ratio(amplitude: f64) -> f64 {
    complete((0.5 * amplitude).sin()).0 / FRAC_PI_2
}
