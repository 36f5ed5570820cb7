//! Settings of the styling of follow hairs.

use super::check::{Check, Validate, above_0, check};

/// Largest radius or amplitude [m].
const MAX_LENGTH: f32 = 1e6;

/// Styling of follow hairs, applied after interpolation from the guides. All off by default.
///
/// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
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

impl Validate for Effects {
    fn checks(&self) -> Vec<Check> {
        vec![
            check((0.0..=1.0).contains(&self.clump), "clump", "0 to 1"),
            check((0.0..=MAX_LENGTH).contains(&self.curl_radius), "curl_radius", "0 to 1000000 [m]"),
            check(
                above_0(Some(self.curl_length)) && self.curl_length <= MAX_LENGTH,
                "curl_length",
                "above 0, at most 1000000 [m]",
            ),
            check((0.0..=MAX_LENGTH).contains(&self.noise), "noise", "0 to 1000000 [m]"),
        ]
    }
}
