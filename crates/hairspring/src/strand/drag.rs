//! Aerodynamic drag on a fiber, from measurements on cylinders.
//!
//! U is the velocity of the air relative to the fiber, split into U_n across and U_t along it, and Re = |U_n|
//! d/ν. The force per length is
//!
//! ```text
//! F_n = μ k_n(Re) U_n,   k_n = Re Cd(Re)/2     Cd = 8π / (Re (2.002 − ln Re))   Re ≤ 0.5   Lamb 1932, Hydrodynamics, §343
//!                                              Cd = 1 + 10 Re^(−2/3)   Re ≥ 2   White 2006, Viscous Fluid Flow, §3-8
//! F_t = μ k_t(Re) U_t,   k_t = min( k_n/2, 0.7 + 2.7 √Re )
//! ```
//!
//! The normal force depends only on the normal velocity (cross-flow principle). Along the fiber, slender-body
//! theory gives half of the drag across it (Cox 1970, *The motion of long slender bodies in a viscous fluid*,
//! J. Fluid Mech. 44); from Re ≈ 25 on, the laminar boundary layer gives 2.7 √Re (Taylor 1952, *Analysis of
//! the swimming of long and narrow animals*, Proc. R. Soc. A 214: 5.4 R^(−1/2) cos i sin^(1/2) i ½ρU²d).
//!
//! The kernel evaluates a rational function of √Re. It agrees with Lamb and White, blended over ln Re between
//! Re 0.5 and 2, within 2.2 % from Re 10⁻³ to 10³, and has the finite limit 1.23 at Re = 0: that of a slender
//! body of some 20 cm, where Lamb's logarithm has none.
//!
//! No segment begins at the tip, so drag on the tip's half segment is isotropic, with the coefficient across
//! the fiber. If the drag of a limp strand's tip turned with its last segment, the tip would flutter in a
//! wind of 5 m/s and never come to rest.
//!
//! Each substep keeps k_n and k_t fixed at the velocity at its start, so that drag is linear in the unknown
//! velocity.

use super::tile::{RestRows, StrandRows, rest, strand};
use crate::simd::lanes::{F, Simd, V3, load};
use std::ops::{Add, Div, Mul};

/// Kinematic viscosity ν of air at 20 °C [m²/s].
pub const AIR_KINEMATIC_VISCOSITY: f32 = 1.516e-5;

/// Viscosity μ of air at 20 °C [Pa s]: ν times the density, 1.204 kg/m³.
pub const AIR_VISCOSITY: f32 = 1.204 * AIR_KINEMATIC_VISCOSITY;

/// Drag coefficients: force over length, viscosity and `slip` [1].
pub struct Drag<S: Simd> {
    /// k_n.
    pub across: F<S>,
    /// k_t.
    pub along: F<S>,
}

impl<S: Simd> Drag<S> {
    /// Computes the coefficients for a point with this rest shape and the unit tangent `u`. `slip` is the
    /// velocity of the air relative to the point, over the point's share of slip [m/s].
    #[inline(always)]
    pub fn new(simd: S, strand_rows: &StrandRows, rest_rows: &RestRows, slip: V3<S>, u: V3<S>) -> Self {
        let normal = slip - u * u.dot(slip);
        let share = load(simd, &rest_rows[rest::SLIP]);
        let reynolds = normal.dot(normal).sqrt() * load(simd, &strand_rows[strand::REYNOLDS]) * share;
        let root = reynolds.sqrt();
        let across = normal_coefficient(root);
        let along = (across * 0.5).min(root * 2.7 + 0.7);
        Self { across: across * share, along: along * share }
    }
}

/// k_n as a function of the square root of the Reynolds number.
#[inline(always)]
pub fn normal_coefficient<T>(root: T) -> T
where
    T: Copy + Add<f32, Output = T> + Mul<f32, Output = T> + Mul<T, Output = T> + Div<T, Output = T>,
{
    (((root * 0.79607 + 4.50848) * root + 9.02701) * root + 1.22793) / (root * 1.68971 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lamb and White, blended by a smoothstep over ln Re between 0.5 and 2.
    fn drag_coefficient(re: f64) -> f64 {
        let t = ((re / 0.5).ln() / 4f64.ln()).clamp(0.0, 1.0);
        let weight = t * t * (3.0 - 2.0 * t);
        let white = 1.0 + 10.0 * re.powf(-2.0 / 3.0);
        let lamb = 8.0 * std::f64::consts::PI / (re * (2.002 - re.min(2.0).ln()));
        lamb + weight * (white - lamb)
    }

    #[test]
    fn the_fit_is_within_3_percent_of_the_closed_form() {
        for k in 0..=600 {
            let re = 10f64.powf(-3.0 + k as f64 / 100.0);
            let fit = f64::from(normal_coefficient(re.sqrt() as f32));
            let closed = 0.5 * re * drag_coefficient(re);
            assert!((fit / closed - 1.0).abs() < 0.03, "{fit} instead of {closed} at Re {re}");
        }
    }
}
