//! Gusts: the wind speed varies as the sum of two sines. The ratio of their rates is irrational, so the
//! pattern never repeats.
//!
//! ```text
//! factor(t) = 1 + g (0.6 sin φ + 0.4 sin(2.618 φ + 1)),   φ = 2π f t + φ₀
//! ```

use std::f32::consts::TAU;

/// Ratio of the second sine's rate to the first's: the square of the golden ratio, which is hard to
/// approximate by a fraction.
const RATE_RATIO: f32 = 2.618;

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
    /// Returns whether there are gusts. Without a rate, there are none.
    fn is_on(&self) -> bool {
        self.rate > 0.0
    }

    /// Returns the wind speed at `time` [s] relative to the mean [1].
    pub fn factor(&self, time: f64) -> f32 {
        if !self.is_on() {
            return 1.0;
        }
        let phase = f64::from(TAU * self.rate) * time + f64::from(self.phase);
        let gust = 0.6 * phase.sin() + 0.4 * (phase * f64::from(RATE_RATIO) + 1.0).sin();
        1.0 + self.amount * gust as f32
    }

    /// Returns ∫₀ᵗ factor dt [s]. Multiplied by the mean wind, this is the distance that the air has traveled.
    pub fn integral(&self, time: f64) -> f64 {
        if !self.is_on() {
            return time;
        }
        let omega = f64::from(TAU * self.rate);
        let (first, second) = (f64::from(self.phase), f64::from(RATE_RATIO));
        let still = |phase: f64| 0.6 * phase.cos() + 0.4 / second * (phase * second + 1.0).cos();
        time - f64::from(self.amount) * (still(first + omega * time) - still(first)) / omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_rate_the_wind_keeps_its_mean() {
        for phase in [0.0, 2.4] {
            let gust = Gust { amount: 1.0, rate: 0.0, phase };
            for time in [0.0, 0.3, 100.0] {
                assert_eq!((gust.factor(time), gust.integral(time)), (1.0, time));
            }
        }
    }

    #[test]
    fn the_integral_is_the_sum_of_the_gusts() {
        for rate in [0.0, 0.3, 2.0] {
            let gust = Gust { amount: 0.7, rate, phase: 0.4 };
            let steps = 20_000;
            let at = |k: usize| (k as f64 + 0.5) * 3.0 / steps as f64;
            let sum: f64 =
                (0..steps).map(|k| f64::from(gust.factor(at(k)))).sum::<f64>() * 3.0 / steps as f64;
            let integral = gust.integral(3.0);
            assert!((integral - sum).abs() < 1e-4, "{integral} instead of {sum} at {rate} Hz");
        }
    }
}
