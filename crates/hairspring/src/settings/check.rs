//! Ranges of settings: one rule a value, used by the readers of scene files and by code that builds a simulation.

/// A rule for the value of a setting.
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check {
    /// Whether the value follows the rule.
    pub holds: bool,
    /// The setting, as scene files name it.
    pub key: &'static str,
    /// What the value must be, such as `0 to 1`.
    pub expected: &'static str,
}

/// The error for a setting that is not finite or outside of its range.
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{key}` must be {expected}")]
pub struct OutOfRange {
    /// The setting, as scene files name it.
    pub key: &'static str,
    /// What the value must be.
    pub expected: &'static str,
}

/// Settings with a documented range for each value.
///
/// For an example, see [`settings`](crate::settings).
pub trait Validate {
    /// Returns the rules of all values, in the order of the fields.
    fn checks(&self) -> Vec<Check>;

    /// Checks all values.
    ///
    /// # Errors
    /// The first rule that does not hold.
    fn validate(&self) -> Result<(), OutOfRange> {
        match self.checks().into_iter().find(|check| !check.holds) {
            None => Ok(()),
            Some(Check { key, expected, .. }) => Err(OutOfRange { key, expected }),
        }
    }
}

/// Makes a rule.
pub const fn check(holds: bool, key: &'static str, expected: &'static str) -> Check {
    Check { holds, key, expected }
}

/// Returns whether a value is finite and above 0, or absent.
pub fn above_0(x: Option<f32>) -> bool {
    x.is_none_or(|x| x.is_finite() && x > 0.0)
}

/// Returns whether a value is finite, and 0 or more.
pub fn from_0(x: f32) -> bool {
    x.is_finite() && x >= 0.0
}
