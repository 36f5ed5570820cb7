//! Axial compliance of a helical spring whose wire is clamped at one end and loaded at the other.
//!
//! The centerline has the radius R, the pitch angle a, and the angle φ about the axis, counted back from the
//! loaded end to the clamp at Φ. A force F along the axis at the end of the wire (not on the axis) makes the
//! moment M = F R (r̂(0) − r̂(φ)) × ẑ at φ. With the tangent t = cos a θ̂ + sin a ẑ,
//!
//! ```text
//! M·t = −F R cos a (1 − cos φ)         twist,  GJ
//! |M|² = 2 F² R² (1 − cos φ)           the remainder bends,  EI
//! ```
//!
//! and Castigliano's theorem gives the displacement along the force, δ = ∂/∂F ∫ (M·t)²/2GJ + (|M|² −
//! (M·t)²)/2EI ds:
//!
//! ```text
//! δ/F = R² L [ cos²a I₂ (1/GJ − 1/EI) + 2 I₁/EI ]
//! I₁ = mean of 1 − cos φ = 1 − sin Φ/Φ,      I₂ = mean of (1 − cos φ)² = 3/2 − 2 sin Φ/Φ + sin 2Φ/4Φ
//! ```
//!
//! A load on the axis, which needs a stiff arm from the wire's end to the axis, has the moment F R throughout
//! and the textbook value R² L (cos²a/GJ + sin²a/EI) (Love 1927, *A Treatise on the Mathematical Theory of
//! Elasticity*, ch. XIX; Timoshenko 1930, *Strength of Materials* II). Both hold for small displacements of
//! an inextensible wire.

use super::integrate;
use glam::DVec3;
use std::f64::consts::TAU;

/// Axial compliance δ/F in units of R²L/EI of a helix of `turns`, with the pitch angle `pitch` [rad] and
/// `ratio` = GJ/EI, in closed form. Tests compare the quadrature below with it.
#[cfg(test)]
pub fn end_compliance(turns: f64, pitch: f64, ratio: f64) -> f64 {
    let total = TAU * turns;
    let i1 = 1.0 - total.sin() / total;
    let i2 = 1.5 - 2.0 * total.sin() / total + (2.0 * total).sin() / (4.0 * total);
    pitch.cos().powi(2) * i2 * (1.0 / ratio - 1.0) + 2.0 * i1
}

/// The same for a force along the unit vector `direction` at the end of the wire: radial out, along the turn,
/// along the axis. It evaluates the integral numerically, and includes moments that open the coil.
pub fn compliance_along(direction: DVec3, turns: f64, pitch: f64, ratio: f64) -> f64 {
    let total = TAU * turns;
    let density = |s: f64, _: &[f64; 1]| {
        // The loaded end is at the angle 0, and the clamp before it.
        let (sin, cos) = (-total * s).sin_cos();
        let arm = DVec3::new(1.0 - cos, -sin, total * s * pitch.tan());
        let moment = arm.cross(direction);
        let tangent = DVec3::new(-sin * pitch.cos(), cos * pitch.cos(), pitch.sin());
        let twists = moment.dot(tangent).powi(2);
        [twists / ratio + moment.length_squared() - twists]
    };
    integrate([0.0], 200 + (100.0 * turns) as usize, density, |_| false)[0]
}
