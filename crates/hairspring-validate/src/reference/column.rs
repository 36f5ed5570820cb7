//! The planar elastica of a column that is clamped at one end and compressed along its axis at the other,
//! which is free to rotate and to move sideways (Euler 1744; Timoshenko & Gere 1961, *Theory of Elastic
//! Stability*, §2.7).
//!
//! With the inclination of the free end θₜ and k = sin(θₜ/2), the load P, the length L and the clamp's
//! distance H from the free end along the axis are related by
//!
//! ```text
//! P L²/EI = K(k)²,      H/L = 2 E(k)/K(k) − 1,      x/L = 2 k/K(k)
//! ```
//!
//! where x is the sideways displacement of the free end.

use super::{bisect, elliptic::complete};

/// A compressed column.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// PL²/EI.
    pub load: f64,
    /// x/L.
    pub aside: f64,
}

/// Returns the column at the height `height` = H/L, above 0 and below 1.
pub fn column(height: f64) -> Column {
    let at = |k: f64| {
        let (first, second) = complete(k);
        2.0 * second / first - 1.0
    };
    let k = bisect(0.0, 0.9, |k| height - at(k));
    let first = complete(k).0;
    Column { load: first * first, aside: 2.0 * k / first }
}
