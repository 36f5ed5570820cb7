//! Time as a count of frames.
//!
//! A sum of frame durations drifts: each addition rounds, and the duration itself is rounded. A count of
//! frames at a rational rate does neither.

use std::{fmt, str::FromStr};

/// A frame rate as a fraction, so that 24000/1001 is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameRate {
    frames: u32,
    seconds: u32,
}

/// Largest relative difference between a rounded rate and the standard rate that it represents [1]. It allows
/// for six digits of a frame time, such as 0.008333 s.
const ROUNDED: f64 = 5e-5;

/// Precision of [`FrameRate::nearest`]: six decimals, as a factor.
const DIGITS: u32 = 1_000_000;

impl FrameRate {
    /// Creates the rate of `frames` frames in `seconds` seconds; `None` if either is 0.
    pub const fn new(frames: u32, seconds: u32) -> Option<Self> {
        if frames == 0 || seconds == 0 { None } else { Some(Self { frames, seconds }) }
    }

    /// Returns the rate that a rounded number of frames per second [Hz] represents. This is a nearby whole
    /// number or whole number over 1.001 (29.97 is 30000/1001); otherwise it is the number with six decimals.
    /// Returns `None` if that is not above 0 or does not fit.
    pub fn nearest(hertz: f64) -> Option<Self> {
        let near = |rate: f64| rate > 0.0 && (hertz / rate - 1.0).abs() < ROUNDED;
        let whole = |hertz: f64| Some(hertz.round()).filter(|n| (1.0..1e6).contains(n));
        if let Some(n) = whole(hertz).filter(|n| near(*n)) {
            return Self::new(n as u32, 1);
        }
        if let Some(n) = whole(hertz * 1.001).filter(|n| near(n / 1.001)) {
            return Self::new(n as u32 * 1000, 1001);
        }
        let scaled = (hertz * f64::from(DIGITS)).round();
        (1.0..=f64::from(u32::MAX))
            .contains(&scaled)
            .then_some(Self { frames: scaled as u32, seconds: DIGITS })
    }

    /// Parses the rate of a bake, a clip or a comparison: 1 to 240 Hz.
    ///
    /// # Errors
    /// Returns what was expected.
    pub fn of_output(text: &str) -> Result<Self, String> {
        let rate = text.parse::<Self>().ok().filter(|rate| (1.0..=240.0).contains(&rate.hertz()));
        rate.ok_or_else(|| {
            "expected a number or a fraction from 1 to 240, such as 30, 23.976 or 24000/1001".into()
        })
    }

    /// Returns the number of frames per second [Hz].
    pub fn hertz(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }

    /// Returns the duration of a frame [s].
    pub fn frame_length(self) -> f64 {
        self.time_of(1)
    }

    /// Returns the rate of `parts` equal parts of each frame.
    pub fn times(self, parts: u32) -> Self {
        Self { frames: self.frames.saturating_mul(parts.max(1)), ..self }
    }

    /// Returns the number of frames of a motion that lasts `duration` [s], including its first and last moment;
    /// those of five seconds without a motion.
    pub fn frames_of(self, duration: Option<f64>) -> u32 {
        let frames = match duration {
            // Adds a small tolerance (0.0005 frames) for durations that are not exact in binary.
            Some(duration) => (duration * self.hertz() + 5e-4).floor() + 1.0,
            None => (5.0 * self.hertz()).round(),
        };
        (frames as u32).max(1)
    }

    /// Returns the time of a frame, counted from 0 [s].
    pub fn time_of(self, frame: u64) -> f64 {
        // The product is exact up to 2^53, so only the quotient is rounded.
        frame as f64 * f64::from(self.seconds) / f64::from(self.frames)
    }
}

/// Parses `30`, `29.97` or `30000/1001`.
impl FromStr for FrameRate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let rate = match text.split_once('/') {
            Some((frames, seconds)) => {
                let whole = |n: &str| n.trim().parse().ok();
                whole(frames).zip(whole(seconds)).and_then(|(frames, seconds)| Self::new(frames, seconds))
            }
            None => text.trim().parse().ok().and_then(Self::nearest),
        };
        rate.ok_or_else(|| {
            "a frame rate is a number or a fraction above 0, such as 30, 23.976 or 24000/1001".into()
        })
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.hertz())
    }
}

/// Elapsed time: the number of frames since the rate last changed.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Clock {
    /// Time at which the count began [s].
    start: f64,
    frames: u64,
    rate: FrameRate,
}

impl Clock {
    /// Time 0.
    pub(super) const ZERO: Self = Self { start: 0.0, frames: 0, rate: FrameRate { frames: 1, seconds: 1 } };

    /// Returns the time [s].
    pub(super) fn time(&self) -> f64 {
        self.start + self.rate.time_of(self.frames)
    }

    /// Returns the clock advanced by one frame.
    pub(super) fn after_frame(self, rate: FrameRate) -> Self {
        if rate == self.rate {
            Self { frames: self.frames + 1, ..self }
        } else {
            Self { start: self.time(), frames: 1, rate }
        }
    }

    /// Returns the clock advanced by `dt` [s].
    pub(super) fn after(self, dt: f64) -> Self {
        Self { start: self.time() + dt, frames: 0, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_rates_are_the_standard_ones() {
        for (text, frames, seconds) in [
            ("30", 30, 1),
            ("23.976", 24_000, 1001),
            ("29.97", 30_000, 1001),
            ("59.94", 60_000, 1001),
            ("59.94006", 60_000, 1001),
            ("30000/1001", 30_000, 1001),
            ("12.5", 12_500_000, DIGITS),
        ] {
            assert_eq!(text.parse(), Ok(FrameRate { frames, seconds }), "{text}");
        }
        // Frame times of motion files have six or seven digits.
        for (time, hertz) in [(0.0333333, 30.0), (0.008333, 120.0), (0.01, 100.0), (100.0, 0.01)] {
            assert_eq!(FrameRate::nearest(1.0 / time).map(FrameRate::hertz), Some(hertz), "{time} s");
        }
        for wrong in ["", "0", "-3", "nan", "inf", "1e12", "30/0", "0/1", "a/b"] {
            assert!(wrong.parse::<FrameRate>().is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn ten_hours_of_frames_end_on_time() {
        let rate = FrameRate::new(60_000, 1001).unwrap();
        let mut clock = Clock::ZERO;
        for _ in 0..2_160_000 {
            clock = clock.after_frame(rate);
        }
        assert_eq!(clock.time(), 36_036.0);
        assert_eq!(clock.after(0.25).after_frame(rate).time(), 36_036.25 + rate.frame_length());
    }
}
