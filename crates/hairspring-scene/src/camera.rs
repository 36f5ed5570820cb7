//! The camera of a scene.

use glam::Vec3;
use hairspring::settings::{Check, Validate, check};
use serde::{Deserialize, Serialize};

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Camera {
    /// Camera position [m].
    pub position: Vec3,
    /// Point that the camera looks at [m].
    pub target: Vec3,
    /// Vertical field of view [degrees], 1 to 170. Default 30: that of a portrait lens.
    pub fov: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { position: Vec3::new(0.35, 0.1, 1.1), target: Vec3::ZERO, fov: 30.0 }
    }
}

impl Validate for Camera {
    fn checks(&self) -> Vec<Check> {
        let target = self.target.is_finite() && self.target != self.position;
        vec![
            check(self.position.is_finite(), "position", "three finite numbers [m]"),
            check(target, "target", "finite, and different from the camera's position"),
            check((1.0..=170.0).contains(&self.fov), "fov", "1 to 170 [degrees]"),
        ]
    }
}
