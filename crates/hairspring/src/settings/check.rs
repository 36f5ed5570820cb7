//! Rules of settings: one a value, used by the readers of scene files and by code that builds a simulation.

use super::Range;
use glam::Vec3;
use std::borrow::Cow;

/// A rule for the value of a setting.
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Whether the value follows the rule.
    pub holds: bool,
    /// The setting, as scene files name it.
    pub key: Cow<'static, str>,
    /// What the value must be, such as `0 to 1`.
    pub expected: &'static str,
}

/// The error for a setting that is not finite or outside of its range.
///
/// For an example, see [`settings`](crate::settings).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{key}` must be {expected}")]
pub struct OutOfRange {
    /// The setting, as scene files name it.
    pub key: Cow<'static, str>,
    /// What the value must be.
    pub expected: &'static str,
}

/// Settings with a documented range for each value.
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

/// Checks gravity [m/s²], which is a value of its own.
///
/// # Errors
/// If it is not finite or out of range.
pub fn validate_gravity(gravity: Vec3) -> Result<(), OutOfRange> {
    match Range::Between(-1e4, 1e4).accepts(&gravity) {
        true => Ok(()),
        false => {
            Err(OutOfRange { key: "gravity".into(), expected: "three numbers from -10000 to 10000 [m/s²]" })
        }
    }
}

/// Makes a rule.
pub const fn check(holds: bool, key: &'static str, expected: &'static str) -> Check {
    Check { holds, key: Cow::Borrowed(key), expected }
}

/// Returns the rules of a table under the key of the table.
pub fn with_prefix(table: &str, checks: Vec<Check>) -> impl Iterator<Item = Check> {
    checks.into_iter().map(move |c| Check { key: Cow::Owned(format!("{table}.{}", c.key)), ..c })
}

/// Returns whether `rule` holds for `settings`.
pub fn holds<T>(settings: &T, rule: fn(&T) -> bool) -> bool {
    rule(settings)
}
