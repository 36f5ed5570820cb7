//! A straight strand bent to a closed ring and twisted: Michell's instability (Michell 1889; Zajac 1962).
//!
//! In the frame (in-plane normal, binormal, tangent) the ring has the curvature k = 2π/L, the bending moment
//! EI k about the binormal, and the twisting moment T = GJ τ. The balance of moments requires a force T k
//! along the binormal. A small rotation w = (w₁, w₂, w₃) of the frame changes the strain by w' + Ω×w, and the
//! energy to second order by half of
//!
//! ```text
//! ∮ EI (w₁'² − k² w₁² + w₂'²)  +  GJ (w₃' − k w₁)²  +  T (w₁' w₂ − w₂' w₁)  ds
//! ```
//!
//! (The strand is straight at rest, so its bending energy depends only on the magnitude of the curvature.)
//! The twist w₃ follows w₁ at no cost. The mode w₁ = a cos nks, w₂ = b sin nks gives
//!
//! ```text
//! EI k² [(n² − 1) a² + n² b²] − 2 T k n a b,      indefinite for     T² > EI² k² (n² − 1)
//! ```
//!
//! The closed ring excludes n = 1, so n = 2 is first: the ring writhes at the total twist τL = 2π √3 · EI/GJ.
//! (A form 2π√(3 EI/GJ) in some texts agrees with it for EI = GJ only.)

use std::f64::consts::TAU;

/// Total twist [rad] at which the ring becomes unstable, for `ratio` = GJ/EI: the smallest root of the form's
/// determinant over the modes.
pub fn writhing_twist(ratio: f64) -> f64 {
    let critical = |n: f64| {
        let (a, b) = (n * n - 1.0, n * n);
        // Moment over EI k: (a b) − (n T)² = 0.
        TAU * (a * b).sqrt() / n / ratio
    };
    (2..=8).map(|n| critical(n as f64)).fold(f64::INFINITY, f64::min)
}
