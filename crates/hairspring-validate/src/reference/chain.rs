//! Small swings of a hanging chain (Daniel Bernoulli 1732).
//!
//! With u the height above the free tip over the length and λ = ω²L/g, (u y')' + λ y = 0. The solution y is
//! Bessel's J₀(2√(λu)), and y = 0 at the support determines λ.

use super::first_roots;

/// Lateral shape of a swing at height `u` above the tip, for λ = ω²L/g: the solution that is 1 at the tip, by
/// its power series.
pub fn shape(lambda: f64, u: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..200 {
        term *= -lambda * u / (k * k) as f64;
        sum += term;
        if term.abs() < 1e-17 {
            break;
        }
    }
    sum
}

/// λ = ω²L/g of the first `count` modes.
pub fn modes(count: usize) -> Vec<f64> {
    first_roots(0.1, 0.5, count, |lambda| shape(lambda, 1.0))
}
