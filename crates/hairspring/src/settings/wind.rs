//! Settings of the wind that is the same everywhere.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Moving air, the same everywhere but for gusts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity of the air [m/s]. Default 0.
    pub velocity: Vec3,
    /// How much gusts add and take, as a fraction of the mean, 0 to 1. Default 0.
    pub gust: f32,
    /// Gusts a second [Hz]. 0: none.
    pub gust_rate: f32,
}
