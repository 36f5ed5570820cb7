//! A free swing with one integrator: how its energy changes, and how long a step may be.

use super::{BOUND, duration};
use hairspring::settings::Integrator;
use hairspring_validate::swing::{Sample, Swing};

/// Longest step that is tried [s]: three frames.
pub const LONGEST: f64 = 0.05;

/// Shortest step that is tried [s].
pub const SHORTEST: f64 = 1e-6;

/// A step is stable if it keeps the strands together for this time [s], and for at least [`STEPS`] steps.
pub const WATCHED: f64 = 0.25;
/// See [`WATCHED`].
pub const STEPS: u64 = 200;

/// Relative accuracy of the longest step [1].
const EXACT: f64 = 0.05;

/// Time between checks of the strands [s]. Steps longer than this are checked one by one.
const LOOK: f64 = 2e-4;

/// A free swing.
pub struct Swung {
    /// Time [s] and energy: 1 at the start, 0 when all energy that falling can release is gone. Ends where
    /// the swing blew up.
    pub energy: Vec<[f64; 2]>,
    /// Change of the energy from start to end, relative to the energy that falling can turn into motion [1];
    /// `None` if the swing blew up.
    pub drift: Option<f64>,
    /// Maximum |ℓ/L − 1| of any step [1]; `None` if the swing blew up.
    pub stretch_max: Option<f64>,
}

/// Lets the sample swing for `seconds`, in steps of 1/60 s divided by `substeps`.
pub fn swing(sample: &Sample, integrator: Integrator, substeps: u32, seconds: f64) -> Swung {
    let h = 1.0 / (60.0 * f64::from(substeps));
    let mut swing = Swing::new(sample, integrator, h);
    let (start, scale) = (swing.energy().total(), swing.energy_to_fall());
    let mut energy = vec![[0.0, 1.0]];
    let mut stretch_max = 0.0f64;
    for step in 1..=(seconds / h).round() as u64 {
        let report = swing.step();
        let share = (swing.energy().total() - start) / scale;
        stretch_max = stretch_max.max(swing.measure().stretch_max);
        if report.reset_strands > 0 || !share.is_finite() || stretch_max > BOUND {
            return Swung { energy, drift: None, stretch_max: None };
        }
        energy.push([step as f64 * h, 1.0 + share]);
    }
    let drift = energy.last().map(|e| e[1] - 1.0);
    Swung { energy, drift, stretch_max: Some(stretch_max) }
}

/// The longest stable step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LongestStep {
    /// Even the longest step that was tried is stable.
    All,
    /// The longest stable step [s].
    Found(f64),
    /// Not even the shortest step that was tried is stable.
    None,
}

impl LongestStep {
    /// Length of the step [s].
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::All => Some(LONGEST),
            Self::Found(h) => Some(h),
            Self::None => None,
        }
    }

    /// Describes the step in words.
    pub fn label(self) -> String {
        match self {
            Self::All => format!("{} or more", duration(LONGEST)),
            Self::Found(h) => duration(h),
            Self::None => format!("under {}", duration(SHORTEST)),
        }
    }
}

/// Finds the longest stable step by bisection of its logarithm.
pub fn longest_step(sample: &Sample, integrator: Integrator) -> LongestStep {
    if is_stable(sample, integrator, LONGEST) {
        return LongestStep::All;
    }
    if !is_stable(sample, integrator, SHORTEST) {
        return LongestStep::None;
    }
    let (mut stable, mut unstable) = (SHORTEST, LONGEST);
    while unstable / stable > 1.0 + EXACT {
        let middle = (stable * unstable).sqrt();
        if is_stable(sample, integrator, middle) {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    LongestStep::Found(stable)
}

/// Whether steps of `h` [s] keep the strands together.
fn is_stable(sample: &Sample, integrator: Integrator, h: f64) -> bool {
    let mut swing = Swing::new(sample, integrator, h);
    let steps = ((WATCHED / h).ceil() as u64).max(STEPS);
    let look = ((LOOK / h) as u64).max(1);
    for step in 1..=steps {
        if swing.step().reset_strands > 0 {
            return false;
        }
        if step % look == 0 || step == steps {
            // A stretch that is NaN is not within the bound.
            if !swing.measure().stretch_max.le(&BOUND) {
                return false;
            }
        }
    }
    true
}
