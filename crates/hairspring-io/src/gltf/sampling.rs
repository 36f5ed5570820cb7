//! The times at which an animation is sampled, and the places of these times between its keys.

/// Rates at which animations are resampled [Hz], in the order of preference: those of displays and of programs, or a
/// multiple from 60 Hz on of those of films (24, 25, 30, 48 and 50 Hz). The last are those of NTSC.
const RATES: [f64; 12] = [
    60.0,
    72.0,
    75.0,
    90.0,
    96.0,
    100.0,
    120.0,
    240.0,
    60_000.0 / 1_001.0,
    72_000.0 / 1_001.0,
    120_000.0 / 1_001.0,
    240_000.0 / 1_001.0,
];

/// Lowest rate of an animation with keys at other times [Hz]: that of a display, and higher than hand-made or captured
/// motion needs. It is raised until the last sample is at the last key.
const RATE: f64 = 60.0;

/// Difference of a duration from whole samples that is due to rounding [samples].
const ROUNDING: f64 = 0.01;

/// Difference of a key from a sample that is due to rounding [s].
const ON_SAMPLE: f64 = 1e-4;

/// The same in a file whose times are whole milliseconds [s].
const ON_SAMPLE_IN_MS: f64 = 5.2e-4;

/// Difference of a time from a whole millisecond that is due to single precision [ms].
const WHOLE_MS: f64 = 0.01;

/// Rounding of the times of samples in single precision [s].
const ROUNDING_OF_TIMES: f64 = 5e-5;

/// The rates that have a sample at every key: sets of indices in [`RATES`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rates {
    /// At every key.
    exact: u16,
    /// Within half a millisecond of every key, if all times are whole milliseconds.
    in_ms: u16,
}

impl Rates {
    pub(super) const ALL: Self = Self { exact: (1 << RATES.len()) - 1, in_ms: (1 << RATES.len()) - 1 };

    /// The rates that have a sample at each of `times` [s].
    pub(super) fn of(times: &[f32]) -> Self {
        let mut rates = Self::ALL;
        for time in times.iter().map(|time| f64::from(*time)) {
            if (1e3 * time - (1e3 * time).round()).abs() > WHOLE_MS {
                rates.in_ms = 0;
            }
            for (k, rate) in RATES.iter().enumerate() {
                let distance = (time * rate - (time * rate).round()).abs() / rate;
                if distance > ON_SAMPLE {
                    rates.exact &= !(1 << k);
                }
                if distance > ON_SAMPLE_IN_MS {
                    rates.in_ms &= !(1 << k);
                }
            }
            if rates.exact | rates.in_ms == 0 {
                break;
            }
        }
        rates
    }

    /// The rates of both sets.
    pub(super) fn and(self, other: Self) -> Self {
        Self { exact: self.exact & other.exact, in_ms: self.in_ms & other.in_ms }
    }

    /// The preferred rate [Hz], and the largest distance of a key from a sample at it [s].
    fn best(self) -> Option<(f64, f64)> {
        let first = |rates: u16| RATES.get(rates.trailing_zeros() as usize).copied();
        let exact = first(self.exact).map(|rate| (rate, ON_SAMPLE));
        exact.or_else(|| first(self.in_ms).map(|rate| (rate, ON_SAMPLE_IN_MS)))
    }
}

/// The times of an animation's samples.
#[derive(Debug)]
pub(super) struct Sampling {
    /// Time of the first sample [s].
    pub start: f32,
    /// Samples per second [Hz].
    pub rate: f64,
    /// Number of samples.
    pub frames: usize,
    /// Distance of a key from a sample at which the sample has its value [s].
    pub on_key: f32,
}

impl Sampling {
    /// Samples an animation with keys from `first` to `last` [s]. It begins at 0, as all animations do (glTF 2.0 §3.11),
    /// unless that takes more than `most` samples. At most one more is needed for one of the `rates` of its keys.
    pub(super) fn new(first: f32, last: f32, rates: Rates, most: usize) -> Self {
        let on_key = |distance: f64| (distance + ROUNDING_OF_TIMES) as f32;
        let at_keys = |start: f32| {
            let (rate, distance) = rates.best()?;
            let steps = ((f64::from(last) - f64::from(start)) * rate).round();
            Some(Self { start, rate, frames: (steps as usize).saturating_add(1), on_key: on_key(distance) })
        };
        let at_ends = |start: f32| {
            let duration = f64::from(last) - f64::from(start);
            let steps = (duration * RATE - ROUNDING).ceil().max(0.0);
            let is_raised = (steps - duration * RATE).abs() > ROUNDING && steps > 0.0;
            let rate = if is_raised { steps / duration } else { RATE };
            Self { start, rate, frames: (steps as usize).saturating_add(1), on_key: on_key(ON_SAMPLE) }
        };
        let mut ways = [first.min(0.0), first]
            .into_iter()
            .flat_map(|start| at_keys(start).into_iter().chain([at_ends(start)]));
        ways.find(|way| way.frames <= most).unwrap_or_else(|| at_ends(first))
    }

    /// Time of a sample [s].
    pub(super) fn time(&self, frame: usize) -> f32 {
        (f64::from(self.start) + frame as f64 / self.rate) as f32
    }
}

/// The place of a time between two keys.
pub(super) struct Place {
    /// Index of the key at or before the time.
    pub before: usize,
    /// Index of the next key.
    pub after: usize,
    /// Fraction of the way from one to the other, 0 to 1.
    pub fraction: f32,
    /// Time between them [s].
    span: f32,
}

impl Place {
    /// Finds `time` [s] between sorted times, of which there is at least one. A time that is within `on_key` [s] of a key is
    /// at that key.
    pub(super) fn new(times: &[f32], time: f32, on_key: f32) -> Self {
        let next = times.partition_point(|t| *t <= time + on_key);
        let (before, after) = (next.saturating_sub(1), next.min(times.len() - 1));
        let (span, past) = (times[after] - times[before], time - times[before]);
        let fraction = if span > 0.0 && past > on_key { (past / span).min(1.0) } else { 0.0 };
        Self { before, after, fraction, span }
    }

    /// Factors of a cubic spline for the value and the out-tangent of the key before, and the value and the in-tangent of
    /// the key after (glTF 2.0 appendix C.5).
    pub(super) fn cubic(&self) -> [f32; 4] {
        let t = self.fraction;
        let (t2, t3) = (t * t, t * t * t);
        [
            2.0 * t3 - 3.0 * t2 + 1.0,
            self.span * (t3 - 2.0 * t2 + t),
            3.0 * t2 - 2.0 * t3,
            self.span * (t3 - t2),
        ]
    }
}
