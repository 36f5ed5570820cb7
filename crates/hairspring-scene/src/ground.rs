//! Settings of the ground plane. Drawing is implemented in `hairspring-view`.

use glam::Vec3;
use hairspring::settings::{When, define_settings};

define_settings! {
    /// A level plane that receives the shadow of body and hair. It only affects the image; hair collides with a
    /// [`Collider`](super::Collider).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Ground {
        /// Whether a level floor receives the shadow of body and hair. It is only drawn: for a collision, add a
        /// collider.
        on: bool = false, "none", {switch};
        /// Height of the floor along the up axis. Everything below it is hidden.
        height: Option<f32> = None, ["m"], {finite},
            default "the lowest point of the body at rest; 0 without a body", when When::On("ground.on");
        /// Color of the floor, lit by the key light and the sky. It fades into the backdrop.
        #[serde(deserialize_with = "crate::deserialize_optional_color")]
        color: Option<Vec3> = None, "linear RGB", {color},
            default "the backdrop, with the shadow alone", when When::On("ground.on");
    }
}
