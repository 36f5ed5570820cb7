//! How hair is coloured and lit: settings only, the drawing itself lives in `hairspring-view`.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Colour and gloss of one groom.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HairLook {
    /// Linear RGB at the root, 0 to 1. Default: dark brown.
    pub root_color: Vec3,
    /// Linear RGB at the tip, 0 to 1. Default: a lighter brown.
    pub tip_color: Vec3,
}

impl Default for HairLook {
    fn default() -> Self {
        Self { root_color: Vec3::new(0.045, 0.022, 0.011), tip_color: Vec3::new(0.10, 0.05, 0.024) }
    }
}
