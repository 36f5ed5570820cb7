//! Vibrations of a cantilever without gravity (Euler 1744): ω = β² √(EI/ρA) with cos βL cosh βL = −1.

use super::first_roots;

/// βL of the first `count` modes.
pub fn modes(count: usize) -> Vec<f64> {
    // Divided by cosh, to preserve precision for high modes.
    first_roots(1.0, 0.5, count, |b| b.cos() + 1.0 / b.cosh())
}

/// Lateral shape of the mode `beta` (βL) at `s` from the clamp over the length; ±2 at the tip.
pub fn shape(beta: f64, s: f64) -> f64 {
    let b = beta * s;
    let sigma = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
    b.cosh() - b.cos() - sigma * (b.sinh() - b.sin())
}
