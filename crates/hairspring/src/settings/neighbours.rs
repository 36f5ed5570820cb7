//! Settings of contact between strands, one by one.

use super::check::{Check, Validate, above_0, check, from_0};

/// Settings of contact between individual strands, for guides and small scenes. It is the reference for the
/// volume methods, and acts between the simulated strands of all grooms.
///
/// Fields may be added: write `..Default::default()`. For an example, see [`settings`](crate::settings).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct Neighbours {
    /// Whether strands collide. Default false: they pass through each other.
    pub on: bool,
    /// Contact radius of a strand [m], above 0: a strand represents the hairs around it. It is limited
    /// everywhere to half the distance to the nearest other strand at rest, so that nothing touches at rest.
    /// `None`, the default: half the mean of that distance, and at most half a segment.
    pub radius: Option<f32>,
    /// Coulomb friction coefficient between strands [1], 0 or more. Default 0.3, a mean value: because of the
    /// scales, hair slides more easily toward the tip than toward the root.
    pub friction: f32,
    /// Stiction: normal and tangential force that two segments in contact resist, in addition to friction,
    /// before they separate [N], 0 or more. Default 0. A hair of 25 cm weighs 1.6e-5 N.
    pub stiction: f32,
}

impl Default for Neighbours {
    fn default() -> Self {
        Self { on: false, radius: None, friction: 0.3, stiction: 0.0 }
    }
}

impl Validate for Neighbours {
    fn checks(&self) -> Vec<Check> {
        vec![
            check(above_0(self.radius), "radius", "above 0 [m]"),
            check(from_0(self.friction), "friction", "0 or more"),
            check(from_0(self.stiction), "stiction", "0 or more [N]"),
        ]
    }
}
