//! How wind comes and goes: two sines whose rates have no common multiple, so that no gust is like the last.
//!
//! ```text
//! factor(t) = 1 + g (0.6 sin φ + 0.4 sin(2.618 φ + 1)),   φ = 2π f t + φ₀
//! ```

use std::f32::consts::TAU;

/// The second sine's rate over the first's: the square of the golden ratio, the hardest number to come near by a fraction.
const SECOND: f32 = 2.618;

/// Gusts of one source of wind.
#[derive(Clone, Copy)]
pub(super) struct Gust {
    /// How much they add and take, as a fraction of the mean, g [1].
    pub amount: f32,
    /// How many there are a second, f [Hz].
    pub rate: f32,
    /// Where they begin, φ₀ [rad].
    pub phase: f32,
}

impl Gust {
    /// The wind at `time` [s] over its mean [1].
    pub fn factor(&self, time: f64) -> f32 {
        let phase = f64::from(TAU * self.rate) * time + f64::from(self.phase);
        let gust = 0.6 * phase.sin() + 0.4 * (phase * f64::from(SECOND) + 1.0).sin();
        1.0 + self.amount * gust as f32
    }

    /// How long the mean wind would take for the way that it makes by `time` [s]: the integral of [`Gust::factor`] [s].
    pub fn travelled(&self, time: f64) -> f64 {
        let omega = f64::from(TAU * self.rate);
        if omega == 0.0 {
            return time * f64::from(self.factor(0.0));
        }
        let (first, second) = (f64::from(self.phase), f64::from(SECOND));
        let still = |phase: f64| 0.6 * phase.cos() + 0.4 / second * (phase * second + 1.0).cos();
        time - f64::from(self.amount) * (still(first + omega * time) - still(first)) / omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_is_the_sum_of_the_gusts() {
        for rate in [0.0, 0.3, 2.0] {
            let gust = Gust { amount: 0.7, rate, phase: 0.4 };
            let steps = 20_000;
            let at = |k: usize| (k as f64 + 0.5) * 3.0 / steps as f64;
            let sum: f64 =
                (0..steps).map(|k| f64::from(gust.factor(at(k)))).sum::<f64>() * 3.0 / steps as f64;
            assert!(
                (gust.travelled(3.0) - sum).abs() < 1e-4,
                "{} by {sum} at {rate} Hz",
                gust.travelled(3.0)
            );
        }
    }
}
