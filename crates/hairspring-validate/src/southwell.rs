//! Southwell's method: finds the buckling load of a strand without reaching it.
//!
//! Near a buckling load λ*, the response to a small sideways load grows as 1/(1 − λ/λ*). Its inverse, the
//! stiffness against that load, decreases linearly to 0 (Southwell 1932, *On the analysis of experimental
//! observations in problems of elastic stability*). Measurements on the stable side, where a strand comes to
//! rest soon and its deflection is small, define the line, which gives the threshold. Farther away, other
//! modes bend the line, so each measurement is taken nearer than the last.

use super::Failure;

/// Largest sideways deflection, over the length, that counts as small. Beyond it, the strand has buckled.
pub const SMALL: f64 = 0.1;

/// Fraction of the distance to the predicted threshold that each measurement advances.
const STRIDE: f64 = 0.6;

/// Number of steps, each by the same factor, that cross the whole range. A measurement advances by at most
/// one of them.
const STEPS: f64 = 12.0;

/// Relative difference of two predicted thresholds that ends the search [1].
const AGREEMENT: f64 = 4e-3;

/// Largest relative distance of the last measurement from the threshold.
const NEAR: f64 = 0.15;

/// Relative distance between a stable and an unstable load at which the search ends [1].
const ENCLOSED: f64 = 0.015;

/// Largest number of measurements.
const MOST: usize = 30;

/// Returns the load at which the `stiffness` of a strand against a small sideways load decreases to 0. The
/// search goes from the load `start`, where the strand is stable, to `end` at most; both are above 0.
/// `stiffness` returns `None` if the strand has already buckled.
pub fn threshold(
    start: f64,
    end: f64,
    stiffness: impl Fn(f64) -> Result<Option<f64>, Failure>,
) -> Result<f64, Failure> {
    let toward = (end - start).signum();
    let exceeds = |a: f64, b: f64| (a - b) * toward > 0.0;
    // The strand's own imperfection makes it buckle a little early, with a stiffness above 0. An interval
    // this narrow determines the threshold.
    let enclosed = |held: f64, given: f64| (given - held).abs() < ENCLOSED * given;
    let factor = (end / start).powf(1.0 / STEPS);
    let mut found: Vec<(f64, f64)> = Vec::with_capacity(MOST);
    let (mut foreseen, mut at) = (f64::NAN, start);
    // The nearest load at which the strand is known to have buckled.
    let mut wall = None;
    for _ in 0..MOST {
        // A strand that came to rest at the previous loads, but no longer does, is buckling.
        let now = match stiffness(at) {
            Err(Failure::NotAtRest) if !found.is_empty() => None,
            other => other?,
        };
        match (now, found.last()) {
            (Some(k), _) => found.push((at, k)),
            (None, None) => return Err(Failure::NoThreshold),
            (None, Some(last)) => {
                if enclosed(last.0, at) {
                    return Ok(0.5 * (last.0 + at));
                }
                wall = Some(at);
                at = 0.5 * (last.0 + at);
                continue;
            }
        }
        let zero = match found[..] {
            [.., a, b, c] => extrapolate(&[a, b, c]),
            [.., a, b] => extrapolate(&[a, b]),
            _ => f64::NAN,
        };
        let mut next = at * factor;
        // A line that does not decrease gives no prediction yet.
        if zero.is_finite() && exceeds(zero, at) {
            let agree = (zero - foreseen).abs() < AGREEMENT * zero.abs();
            foreseen = zero;
            if agree && (zero - at).abs() < NEAR * zero.abs() && !wall.is_some_and(|wall| exceeds(zero, wall))
            {
                return Ok(zero);
            }
            let stride = at + STRIDE * (zero - at);
            next = if exceeds(stride, next) { next } else { stride };
        }
        if let Some(wall) = wall {
            if enclosed(at, wall) {
                return Ok(0.5 * (at + wall));
            }
            let half = 0.5 * (at + wall);
            next = if exceeds(next, half) { half } else { next };
        }
        if exceeds(next, end) {
            break;
        }
        at = next;
    }
    Err(Failure::NoThreshold)
}

/// Load at stiffness 0 of the polynomial in the stiffness through `(load, stiffness)` (Neville's algorithm).
fn extrapolate(points: &[(f64, f64)]) -> f64 {
    let mut load: Vec<f64> = points.iter().map(|p| p.0).collect();
    for order in 1..points.len() {
        for i in 0..points.len() - order {
            let (a, b) = (points[i].1, points[i + order].1);
            load[i] = (a * load[i + 1] - b * load[i]) / (a - b);
        }
    }
    load[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_pole_of_a_response_with_several_modes() {
        // Modes at 7 and 50 with opposite signs; the far one bends the line.
        for end in [60.0, 20.0] {
            let stiffness = |x: f64| {
                let response = 1.0 / (7.0 - x) - 0.4 / (50.0 - x);
                Ok((x < 7.0).then_some(1.0 / response))
            };
            let found = threshold(1.0, end, stiffness).unwrap();
            assert!((found - 7.0).abs() < 0.01, "{found}");
        }
        // Decreasing loads.
        let found = threshold(100.0, 1.0, |x| Ok((x > 20.0).then_some(x - 20.0))).unwrap();
        assert!((found - 20.0).abs() < 0.01, "{found}");
    }

    /// The stiffness of an imperfect strand levels off before it buckles. A line through the last
    /// measurements leads far beyond the actual threshold. The numbers were measured on a truss with the
    /// smallest possible twisting stiffness.
    #[test]
    fn the_threshold_of_an_imperfect_strand_is_not_extrapolated() {
        let measured = [
            (1.6, 0.1632),
            (2.3485, 0.2396),
            (2.8452, 0.2730),
            (3.0560, 0.2740),
            (3.8982, 0.2470),
            (3.9961, 0.1561),
            (4.0451, 0.06598),
            (4.0712, 0.04864),
            (4.0883, 0.04229),
            (4.0926, 0.04105),
        ];
        let stiffness = |load: f64| {
            let after = measured.iter().position(|m| m.0 > load);
            Ok(after.map(|i| {
                let [(x0, k0), (x1, k1)] = [measured[i - 1], measured[i]];
                k0 + (k1 - k0) * (load - x0) / (x1 - x0)
            }))
        };
        let found = threshold(1.6, 16.0, stiffness).unwrap();
        assert!((found - 4.06).abs() < 0.04, "{found}");
    }

    #[test]
    fn a_structure_that_never_buckles_has_no_threshold() {
        assert_eq!(threshold(1.0, 10.0, |_| Ok(Some(3.0))), Err(Failure::NoThreshold));
        assert_eq!(threshold(1.0, 10.0, |x| Ok(Some(3.0 + x))), Err(Failure::NoThreshold));
    }
}
