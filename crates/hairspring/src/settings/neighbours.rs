//! Settings of contact between strands, one by one.

use serde::{Deserialize, Serialize};

/// How strands meet their neighbours, one by one: the reference for the volume, for guides and small scenes. Between the simulated strands of all grooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Neighbours {
    /// Whether they do. Default false: strands pass through each other.
    pub on: bool,
    /// Radius of a strand where it meets others [m], above 0: a strand stands for the hairs around it. It is nowhere more than half of the way to the nearest
    /// other strand at rest, so that nothing touches there. `None`, the default: half of that way in the mean, at most half a segment.
    pub radius: Option<f32>,
    /// Coulomb friction of strands on each other [1], 0 or more. Default 0.3: scales let hair slide more easily toward the tip than toward the root, and it is
    /// between the two.
    pub friction: f32,
    /// Force that two segments which have been pressed together hold with, along and across, besides friction; it breaks when more pulls [N], 0 or more.
    /// Default 0. A hair of 25 cm weighs 1.6e-5 N.
    pub stiction: f32,
}

impl Default for Neighbours {
    fn default() -> Self {
        Self { on: false, radius: None, friction: 0.3, stiction: 0.0 }
    }
}
