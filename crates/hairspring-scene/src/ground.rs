//! Settings of the ground plane. Drawing is implemented in `hairspring-view`.

use glam::Vec3;
use hairspring::settings::{Check, Validate, check};
use serde::{Deserialize, Serialize};

/// A level plane that receives the shadow of body and hair. It only affects the image; hair collides with a
/// [`Collider`](super::Collider).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Ground {
    /// Whether the ground is drawn. Default false, for a portrait of a head.
    pub on: bool,
    /// Height along the up axis [m]. `None`, the default: the lowest point of the body at rest, or 0 without
    /// a body.
    pub height: Option<f32>,
    /// Linear RGB color, 0 to 1, of a floor lit by the key light and the sky. `None`, the default: the floor
    /// matches the backdrop and is only visible by its shadow.
    #[serde(deserialize_with = "crate::deserialize_optional_color")]
    pub color: Option<Vec3>,
}

impl Validate for Ground {
    fn checks(&self) -> Vec<Check> {
        vec![
            check(self.height.is_none_or(f32::is_finite), "height", "a finite number [m]"),
            check(self.color.is_none_or(crate::is_color), "color", "three numbers from 0 to 1"),
        ]
    }
}
