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

/// Time before a key from which on its value is used [s]: [`ON_SAMPLE`], and the rounding of the times.
const ON_KEY: f32 = 1.5e-4;

/// The rates that have a sample at every key: a set of indices in [`RATES`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rates(u16);

impl Rates {
    pub(super) const ALL: Self = Self((1 << RATES.len()) - 1);

    /// The rates that have a sample at each of `times` [s].
    pub(super) fn of(times: &[f32]) -> Self {
        let is_sample = |time: f64, rate: f64| {
            let at = time * rate;
            (at - at.round()).abs() / rate <= ON_SAMPLE
        };
        let mut rates = Self::ALL.0;
        for time in times.iter().map(|time| f64::from(*time)) {
            for (k, rate) in RATES.iter().enumerate() {
                if rates >> k & 1 == 1 && !is_sample(time, *rate) {
                    rates &= !(1 << k);
                }
            }
            if rates == 0 {
                break;
            }
        }
        Self(rates)
    }

    /// The rates of both sets.
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
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
}

impl Sampling {
    /// Samples an animation with keys from `first` to `last` [s]. It begins at 0, as all animations do (glTF 2.0 §3.11),
    /// unless that takes more than `most` samples. At most one more is needed for one of the `rates` of its keys.
    pub(super) fn new(first: f32, last: f32, rates: Rates, most: usize) -> Self {
        let at_keys = |start: f32| {
            let rate = *RATES.get(rates.0.trailing_zeros() as usize)?;
            let steps = ((f64::from(last) - f64::from(start)) * rate).round();
            Some(Self { start, rate, frames: (steps as usize).saturating_add(1) })
        };
        let at_ends = |start: f32| {
            let duration = f64::from(last) - f64::from(start);
            let steps = (duration * RATE - ROUNDING).ceil().max(0.0);
            let is_raised = (steps - duration * RATE).abs() > ROUNDING && steps > 0.0;
            let rate = if is_raised { steps / duration } else { RATE };
            Self { start, rate, frames: (steps as usize).saturating_add(1) }
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
    /// Finds `time` [s] between sorted times, of which there is at least one. A time that differs from a key only by
    /// rounding is at that key.
    pub(super) fn new(times: &[f32], time: f32) -> Self {
        let next = times.partition_point(|t| *t <= time + ON_KEY);
        let (before, after) = (next.saturating_sub(1), next.min(times.len() - 1));
        let span = times[after] - times[before];
        let fraction = if span > 0.0 { ((time - times[before]) / span).clamp(0.0, 1.0) } else { 0.0 };
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
