//! The planar elastica of a strand that is clamped horizontally, under its own weight and a dead load at its
//! tip.
//!
//! With θ the angle below the horizontal, s from the clamp and L = 1,
//!
//! ```text
//! θ'' = −(Γ(1 − s) + α) cos θ,      θ(0) = 0,  θ'(1) = 0          Γ = ρgAL³/EI,  α = PL²/EI
//! ```
//!
//! (α only: Bisshopp & Drucker 1945, *Large deflection of cantilever beams*.)
//!
//! The solution uses shooting from the tip, u = 1 − s, in the angle φ = π/2 − θ from the vertical.
//! φ'' = (Γu + α) sin φ grows from φ(0) = φₜ, φ'(0) = 0, faster for larger φₜ, and the target is φ(1) = π/2.
//! φₜ of a heavy strand is as small as exp(−⅔√Γ), so the search uses its logarithm.

use super::{bisect, integrate};
use std::f64::consts::FRAC_PI_2;

/// Shape of a loaded cantilever of length 1.
#[derive(Clone, Copy, Debug)]
pub struct Cantilever {
    /// Drop of the tip, H/L.
    pub drop: f64,
    /// Horizontal reach of the tip, W/L.
    pub reach: f64,
    /// Angle of the tip below the horizontal, θ [rad].
    pub tip_angle: f64,
}

/// Returns the cantilever under its own weight `gamma` and a dead tip load `alpha`; both from 0 to 10⁵, not
/// both 0.
pub fn cantilever(gamma: f64, alpha: f64) -> Cantilever {
    // A step is a small part of the shortest length over which the angle can grow by a factor of e.
    let steps = 500 + (50.0 * (gamma + alpha).sqrt()) as usize;
    let shoot = |ln_tip: f64| {
        let start = [ln_tip.exp(), 0.0, 0.0, 0.0];
        let f = |u: f64, y: &[f64; 4]| {
            let (sin, cos) = y[0].sin_cos();
            [y[1], (gamma * u + alpha) * sin, cos, sin]
        };
        integrate(start, steps, f, |y| y[0] > 2.0)
    };
    let ln_tip = bisect(1e-300f64.ln(), FRAC_PI_2.ln(), |t| shoot(t)[0] - FRAC_PI_2);
    let [_, _, drop, reach] = shoot(ln_tip);
    Cantilever { drop, reach, tip_angle: FRAC_PI_2 - ln_tip.exp() }
}

/// Sideways deflection of the tip of an upright strand over its length, linearized, per unit of sideways
/// gravity over vertical gravity: θ'' + Γ(1 − s)(θ + 1) = 0. It grows without bound as Γ approaches
/// Greenhill's value.
pub fn standing_deflection(gamma: f64) -> f64 {
    // Shooting from the tip, once with the load and once without; the combination that satisfies θ = 0 at the
    // clamp.
    let shoot = |load: f64, tip: f64| {
        integrate([tip, 0.0, 0.0], 2000, |u, y| [y[1], -gamma * u * (y[0] + load), y[0]], |_| false)
    };
    let (loaded, free) = (shoot(1.0, 0.0), shoot(0.0, 1.0));
    loaded[2] - free[2] * loaded[0] / free[0]
}
