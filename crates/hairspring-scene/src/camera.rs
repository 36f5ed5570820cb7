//! The camera of a scene.

use glam::Vec3;
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
