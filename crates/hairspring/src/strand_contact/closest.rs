//! Closest points of two segments.

use glam::Vec3;

/// Returns the closest points of segments `a` and `b`, as fractions of their lengths from 0 to 1, from the
/// first end to the second.
///
/// Ericson 2005, *Real-Time Collision Detection*, §5.1.9. Where segments are parallel, all points of their
/// overlap are equally close. The function then returns the center of the overlap, so that a force there does
/// not rotate either segment.
pub fn closest([a0, a1]: [Vec3; 2], [b0, b1]: [Vec3; 2]) -> (f32, f32) {
    let (d1, d2, r) = (a1 - a0, b1 - b0, a0 - b0);
    let (a, e, f) = (d1.length_squared(), d2.length_squared(), d2.dot(r));
    let c = d1.dot(r);
    // Degenerate segments.
    if a <= f32::MIN_POSITIVE {
        return (0.0, if e <= f32::MIN_POSITIVE { 0.0 } else { (f / e).clamp(0.0, 1.0) });
    }
    if e <= f32::MIN_POSITIVE {
        return ((-c / a).clamp(0.0, 1.0), 0.0);
    }
    let b = d1.dot(d2);
    let denominator = a * e - b * b;
    let s = if denominator > PARALLEL * a * e {
        ((b * f - c * e) / denominator).clamp(0.0, 1.0)
    } else {
        // The range of a that b overlaps.
        let (first, last) = (-c / a, (b - c) / a);
        let (low, high) = (first.min(last).clamp(0.0, 1.0), first.max(last).clamp(0.0, 1.0));
        0.5 * (low + high)
    };
    let t = (b * s + f) / e;
    match t {
        t if t < 0.0 => ((-c / a).clamp(0.0, 1.0), 0.0),
        t if t > 1.0 => (((b - c) / a).clamp(0.0, 1.0), 1.0),
        t => (s, t),
    }
}

/// Squared sine of the angle below which segments count as parallel [1]: a hundredth of a radian, at which
/// f32 still resolves the closest points.
const PARALLEL: f32 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    fn distance(a: [Vec3; 2], b: [Vec3; 2], (s, t): (f32, f32)) -> f32 {
        a[0].lerp(a[1], s).distance(b[0].lerp(b[1], t))
    }

    #[test]
    fn no_other_places_are_nearer() {
        let at = |k: u32| {
            let x = |m: u32| (f64::from(k * 7 + m) * 0.618_033_988_749_895).fract() as f32 - 0.5;
            Vec3::new(x(1), x(3), x(5) * if k.is_multiple_of(3) { 0.0 } else { 1.0 })
        };
        for k in 0..500 {
            let a = [at(4 * k), at(4 * k + 1)];
            // Every fifth pair is parallel; in every seventh, b is a point.
            let b0 = at(4 * k + 2);
            let b = match k {
                k if k % 5 == 0 => [b0, b0 + (a[1] - a[0]) * 0.7],
                k if k % 7 == 0 => [b0, b0],
                k => [b0, at(4 * k + 3)],
            };
            let found = closest(a, b);
            let least = distance(a, b, found);
            for i in 0..=40 {
                for j in 0..=40 {
                    let there = distance(a, b, (i as f32 / 40.0, j as f32 / 40.0));
                    assert!(least <= there + 1e-5, "pair {k}: {least} at {found:?}, {there} at {i}, {j}");
                }
            }
        }
    }

    #[test]
    fn parallel_segments_meet_in_the_middle_of_what_they_share() {
        let a = [Vec3::ZERO, Vec3::X];
        for b in [
            [Vec3::new(0.5, 1.0, 0.0), Vec3::new(1.5, 1.0, 0.0)],
            [Vec3::new(1.5, 1.0, 0.0), Vec3::new(0.5, 1.0, 0.0)],
        ] {
            let (s, t) = closest(a, b);
            assert!(
                (s - 0.75).abs() < 1e-6 && b[0].lerp(b[1], t).distance(Vec3::new(0.75, 1.0, 0.0)) < 1e-6,
                "{s} {t}"
            );
        }
    }
}
