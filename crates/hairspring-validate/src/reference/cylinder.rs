//! Air drag on a cylinder, and the angle at which a limp fiber hangs in the wind.

use super::bisect;

/// Kinematic viscosity of air at 20 °C [m²/s].
const KINEMATIC_VISCOSITY: f64 = 1.516e-5;

/// Density of air at 20 °C [kg/m³].
const AIR_DENSITY: f64 = 1.204;

/// Drag coefficient of a long cylinder in cross flow at the Reynolds number `re` of its diameter, above 0.
///
/// Lamb 1932, *Hydrodynamics*, §343, up to Re 0.5; White 2006, *Viscous Fluid Flow*, §3-8, from Re 2 on. They
/// differ by 14 % at Re 1. Between, a smoothstep over ln Re blends the two.
pub fn drag_coefficient(re: f64) -> f64 {
    let t = ((re / 0.5).ln() / 4f64.ln()).clamp(0.0, 1.0);
    let weight = t * t * (3.0 - 2.0 * t);
    let white = 1.0 + 10.0 * re.powf(-2.0 / 3.0);
    // Lamb's formula diverges at Re = e^2.002, past the end of its range.
    let lamb = 8.0 * std::f64::consts::PI / (re * (2.002 - re.min(2.0).ln()));
    lamb + weight * (white - lamb)
}

/// Angle from the vertical [rad] at which a limp fiber of this diameter [m] and density [kg/m³] hangs in a
/// horizontal wind of `speed` [m/s] under gravity `g` [m/s²]: ½ρ(U cos θ)² d Cd = ρ_h π d²/4 g sin θ. Drag
/// along the fiber only adds to its tension.
pub fn wind_angle(speed: f64, diameter: f64, density: f64, g: f64) -> f64 {
    let weight = density * std::f64::consts::FRAC_PI_4 * diameter * diameter * g;
    bisect(0.0, std::f64::consts::FRAC_PI_2, |angle| {
        let normal = speed * angle.cos();
        let drag = 0.5 * AIR_DENSITY * normal * normal * diameter;
        weight * angle.sin() - drag * drag_coefficient(normal * diameter / KINEMATIC_VISCOSITY)
    })
}
