//! Settings of the styling of follow hairs.

use serde::{Deserialize, Serialize};

/// Styling of follow hairs, applied after interpolation from the guides. All off by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Effects {
    /// How far tips are drawn to their first guide, 0 (not at all) to 1 (fully); grows from root to tip.
    pub clump: f32,
    /// Radius of the curls [m], 0 to 1,000,000.
    pub curl_radius: f32,
    /// Length of hair in one turn of a curl [m], above 0. Default 0.03.
    pub curl_length: f32,
    /// Amplitude of the flyaway noise at the tip [m], 0 to 1,000,000.
    pub noise: f32,
}

impl Default for Effects {
    fn default() -> Self {
        Self { clump: 0.0, curl_radius: 0.0, curl_length: 0.03, noise: 0.0 }
    }
}
