//! Settings of the wind that is the same everywhere.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Directional wind, the same everywhere, with gusts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity of the air [m/s]. Default 0.
    pub velocity: Vec3,
    /// Gust amplitude as a fraction of the mean, 0 to 1. Default 0.
    pub gust: f32,
    /// Gust frequency [Hz]. 0: no gusts.
    pub gust_rate: f32,
}
