//! The catenary of an inextensible chain between two supports at one height.

use super::bisect;

/// Shape and pull of a hanging chain.
#[derive(Clone, Copy, Debug)]
pub struct Catenary {
    /// Sag in the middle over the span.
    pub sag: f64,
    /// Tension at a support over the weight of the chain.
    pub end_tension: f64,
}

/// The catenary of `length` over span, above 1: with x = span/2a, sinh(x)/x = length/span, sag/span = (cosh x − 1)/2x and
/// T/(weight) = coth(x)/2 (Bernoulli, Huygens, Leibniz 1691).
pub fn catenary(length: f64) -> Catenary {
    // sinh(x)/x grows from 1; e^x/2x is above any length that f64 holds at 700.
    let x = bisect(1e-9, 700.0, |x: f64| x.sinh() / x - length);
    Catenary { sag: (x.cosh() - 1.0) / (2.0 * x), end_tension: 0.5 / x.tanh() }
}
