//! Maps values to colors: from blue through green and yellow to red, dark at the ends and bright in the
//! middle, so that color-blind users can read it too.

use glam::Vec3;

/// The Turbo color map (Mikhailov 2019) at eight positions, linear RGB.
const STOPS: [[f32; 3]; 8] = [
    [0.030, 0.006, 0.045],
    [0.057, 0.149, 0.750],
    [0.015, 0.520, 0.830],
    [0.060, 0.860, 0.360],
    [0.420, 0.930, 0.050],
    [0.900, 0.600, 0.020],
    [0.870, 0.140, 0.005],
    [0.195, 0.001, 0.001],
];

/// Color of `value` in `range`, clamped to its ends. NaN is white.
pub fn color(value: f32, range: [f32; 2]) -> Vec3 {
    if !value.is_finite() {
        return Vec3::ONE;
    }
    let share = ((value - range[0]) / (range[1] - range[0]).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    let at = share * (STOPS.len() - 1) as f32;
    let k = (at as usize).min(STOPS.len() - 2);
    Vec3::from(STOPS[k]).lerp(STOPS[k + 1].into(), at - k as f32)
}

/// Colors of several values.
pub fn colors(values: &[f32], range: [f32; 2]) -> Vec<Vec3> {
    values.iter().map(|v| color(*v, range)).collect()
}

/// Maps indices to well-separated positions on the ramp, for guides, with multiples of the golden ratio.
pub fn scattered(number: u32) -> f32 {
    (f64::from(number) * 0.618_033_988_749_895).fract() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_is_clamped_and_brightest_in_the_middle() {
        assert_eq!(color(-1.0, [0.0, 1.0]), color(0.0, [0.0, 1.0]));
        assert_eq!(color(2.0, [0.0, 1.0]), color(1.0, [0.0, 1.0]));
        let sum = |v: f32| color(v, [0.0, 1.0]).element_sum();
        assert!(sum(0.5) > 4.0 * sum(0.0) && sum(0.5) > 4.0 * sum(1.0));
        assert_eq!(color(f32::NAN, [0.0, 1.0]), Vec3::ONE);
        assert!(color(1.0, [0.0, 0.0]).is_finite());
    }

    #[test]
    fn neighbouring_guides_differ() {
        assert!((0..1000).all(|k| (scattered(k) - scattered(k + 1)).abs() > 0.3));
    }
}
