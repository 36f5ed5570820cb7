//! The catenary of an inextensible chain between two supports at one height.

use super::bisect;

/// Shape and end tension of a hanging chain.
#[derive(Clone, Copy, Debug)]
pub struct Catenary {
    /// Sag at the center over the span.
    pub sag: f64,
    /// Tension at a support over the weight of the chain.
    pub end_tension: f64,
}

/// Returns the catenary for `length`, the ratio of length to span, above 1. With x = span/2a, sinh(x)/x =
/// length/span, sag/span = (cosh x − 1)/2x and T/(weight) = coth(x)/2 (Bernoulli, Huygens, Leibniz 1691).
pub fn catenary(length: f64) -> Catenary {
    // sinh(x)/x increases from 1; at 700 it exceeds any practical length ratio.
    let x = bisect(1e-9, 700.0, |x: f64| x.sinh() / x - length);
    Catenary { sag: (x.cosh() - 1.0) / (2.0 * x), end_tension: 0.5 / x.tanh() }
}
