//! Complete elliptic integrals by the arithmetic-geometric mean (Gauss 1799; Abramowitz & Stegun 1964, 17.6).

use std::f64::consts::FRAC_PI_2;

/// K(k) and E(k), of the first and second kind, for a modulus k from 0 to below 1.
pub fn complete(k: f64) -> (f64, f64) {
    let (mut a, mut b) = (1.0f64, (1.0 - k * k).sqrt());
    let (mut sum, mut power) = (0.5 * k * k, 0.5);
    // The number of correct digits doubles in each iteration.
    for _ in 0..12 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let first = FRAC_PI_2 / a;
    (first, first * (1.0 - sum))
}
