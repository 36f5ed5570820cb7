//! Where a strand gives way, without ever letting it: Southwell's method.
//!
//! Near a buckling load λ* the answer to a small sideways pull grows as 1/(1 − λ/λ*), so its inverse, the stiffness against that pull,
//! falls to 0 on a straight line (Southwell 1932, *On the analysis of experimental observations in problems of elastic
//! stability*). Measured on the stable side, where a strand comes to rest soon and the answer is that of small angles, the line
//! gives the threshold. Farther off other modes bend the line; so each measurement is taken nearer than the last.

use super::Failure;

/// Largest sideways deflection over the length that counts as small; beyond, a strand has given way.
pub const SMALL: f64 = 0.1;

/// How far toward the foreseen threshold each measurement goes.
const STRIDE: f64 = 0.6;

/// Steps that cross the whole range, each by the same factor: no measurement goes farther than one of them.
const STEPS: f64 = 12.0;

/// Agreement of two foreseen thresholds that ends the search [1].
const AGREEMENT: f64 = 4e-3;

/// The last measurement is at least so near the threshold, as a share of it.
const NEAR: f64 = 0.15;

/// Distance of a load that is held and one that is not, at which the search ends [1].
const ENCLOSED: f64 = 0.015;

/// Most measurements.
const MOST: usize = 30;

/// Load at which `stiffness` of a strand against a small sideways pull falls to 0, searched from the load `start`, where the strand is
/// stable, to `end` and no farther, both above 0. `stiffness` is `None` where the strand has already given way.
pub fn threshold(
    start: f64,
    end: f64,
    stiffness: impl Fn(f64) -> Result<Option<f64>, Failure>,
) -> Result<f64, Failure> {
    let toward = (end - start).signum();
    let beyond = |a: f64, b: f64| (a - b) * toward > 0.0;
    // Its own crookedness takes a strand out a little early, and its stiffness does not fall to 0: enclosed as narrowly as this, the threshold
    // is known.
    let enclosed = |held: f64, given: f64| (given - held).abs() < ENCLOSED * given;
    let factor = (end / start).powf(1.0 / STEPS);
    let mut found: Vec<(f64, f64)> = Vec::with_capacity(MOST);
    let (mut foreseen, mut at) = (f64::NAN, start);
    // The nearest load at which it is known to have given way.
    let mut wall = None;
    for _ in 0..MOST {
        // A strand that came to rest farther off, and no longer does, is on its way out.
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
        // A line that does not fall says nothing yet.
        if zero.is_finite() && beyond(zero, at) {
            let agree = (zero - foreseen).abs() < AGREEMENT * zero.abs();
            foreseen = zero;
            if agree && (zero - at).abs() < NEAR * zero.abs() && !wall.is_some_and(|wall| beyond(zero, wall))
            {
                return Ok(zero);
            }
            let stride = at + STRIDE * (zero - at);
            next = if beyond(stride, next) { next } else { stride };
        }
        if let Some(wall) = wall {
            if enclosed(at, wall) {
                return Ok(0.5 * (at + wall));
            }
            let half = 0.5 * (at + wall);
            next = if beyond(next, half) { half } else { next };
        }
        if beyond(next, end) {
            break;
        }
        at = next;
    }
    Err(Failure::NoThreshold)
}

/// Load at stiffness 0 of the polynomial in the stiffness through `(load, stiffness)` (Neville).
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
        // Modes at 7 and 50, of opposite sign; the far one bends the line.
        for end in [60.0, 20.0] {
            let stiffness = |x: f64| {
                let response = 1.0 / (7.0 - x) - 0.4 / (50.0 - x);
                Ok((x < 7.0).then_some(1.0 / response))
            };
            let found = threshold(1.0, end, stiffness).unwrap();
            assert!((found - 7.0).abs() < 0.01, "{found}");
        }
        // Falling loads.
        let found = threshold(100.0, 1.0, |x| Ok((x > 20.0).then_some(x - 20.0))).unwrap();
        assert!((found - 20.0).abs() < 0.01, "{found}");
    }

    /// The stiffness of a crooked strand levels off before it gives way; a line through the last of it leads far beyond where it did. As
    /// measured of a truss that twists as easily as one can.
    #[test]
    fn a_load_that_was_not_held_is_not_foreseen() {
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
    fn what_never_gives_way_has_no_threshold() {
        assert_eq!(threshold(1.0, 10.0, |_| Ok(Some(3.0))), Err(Failure::NoThreshold));
        assert_eq!(threshold(1.0, 10.0, |x| Ok(Some(3.0 + x))), Err(Failure::NoThreshold));
    }
}
