//! Settings of the wind that is the same everywhere.

use super::check::{Check, Validate, check, from_0};
use glam::Vec3;

/// Directional wind, the same everywhere, with gusts.
///
/// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Wind {
    /// Mean velocity of the air [m/s]. Default 0.
    pub velocity: Vec3,
    /// Gust amplitude as a fraction of the mean, 0 to 1. Default 0.
    pub gust: f32,
    /// Gust frequency [Hz]. 0: no gusts.
    pub gust_rate: f32,
}

impl Validate for Wind {
    fn checks(&self) -> Vec<Check> {
        let mut checks = vec![check(self.velocity.is_finite(), "velocity", "three finite numbers [m/s]")];
        checks.extend(gusts(self.gust, self.gust_rate));
        checks
    }
}

/// Returns the rules of gusts.
pub(crate) fn gusts(gust: f32, rate: f32) -> [Check; 2] {
    [check((0.0..=1.0).contains(&gust), "gust", "0 to 1"), check(from_0(rate), "gust_rate", "0 or more [Hz]")]
}
