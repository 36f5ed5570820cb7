//! Gusts: the wind speed varies as the sum of two sines. The ratio of their rates is irrational, so the
//! pattern never repeats.
//!
//! ```text
//! factor(t) = 1 + g (0.6 sin φ + 0.4 sin(2.618 φ + 1)),   φ = 2π f t + φ₀
//! ```

use std::f32::consts::TAU;

/// Ratio of the second sine's rate to the first's: the square of the golden ratio, which is hard to
/// approximate by a fraction.
const SECOND: f32 = 2.618;

/// The gusts of one wind source.
#[derive(Clone, Copy)]
pub(super) struct Gust {
    /// Amplitude as a fraction of the mean wind, g [1].
    pub amount: f32,
    /// Frequency, f [Hz].
    pub rate: f32,
    /// Initial phase, φ₀ [rad].
    pub phase: f32,
}

impl Gust {
    /// Returns the wind speed at `time` [s] relative to the mean [1].
    pub fn factor(&self, time: f64) -> f32 {
        let phase = f64::from(TAU * self.rate) * time + f64::from(self.phase);
        let gust = 0.6 * phase.sin() + 0.4 * (phase * f64::from(SECOND) + 1.0).sin();
        1.0 + self.amount * gust as f32
    }

    /// Returns the integral of [`Gust::factor`] from 0 to `time` [s]: how long the mean wind takes to travel
    /// the same distance.
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
