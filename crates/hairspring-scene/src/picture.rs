//! Settings of pictures: backdrop, light and shutter. Rendering is implemented in `hairspring-view`.

use glam::Vec3;
use hairspring::settings::{When, define_settings};

define_settings! {
    /// What is behind body and hair.
    choice Background {
        /// The backdrop, except in EXR files.
        #[default]
        Automatic = "automatic",
        /// The backdrop: a soft pool of light on a wall.
        Backdrop = "backdrop",
        /// Nothing: pictures have an alpha channel.
        Transparent = "transparent",
    }
}

define_settings! {
    /// Backdrop, light and shutter of pictures.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Picture {
        /// What is behind body and hair. `backdrop`: a soft pool of light. `transparent`: nothing, with an alpha
        /// channel; JPEG, clips and the window have none and show the backdrop. `automatic`: the backdrop, and
        /// nothing in EXR files.
        background: Background = Background::Automatic, "none", {words};
        /// Color of the backdrop at the center of the picture. Two equal colors give a plain backdrop, whose
        /// pixels have exactly this color; the tone curve applies to two different ones.
        #[serde(deserialize_with = "crate::deserialize_color")]
        backdrop_center: Vec3 = Vec3::new(0.16, 0.165, 0.18), "linear RGB", {color}, when BACKDROP;
        /// Color of the backdrop in the corners of the picture.
        #[serde(deserialize_with = "crate::deserialize_color")]
        backdrop_edge: Vec3 = Vec3::new(0.035, 0.036, 0.042), "linear RGB", {color}, when BACKDROP;
        /// Angle by which key, fill and rim light are turned together about the vertical axis, counterclockwise
        /// as seen from above. At 0 the key light is in front, to the left of the camera.
        light_angle: f32 = 0.0, ["degrees"], {-360 to 360};
        /// Motion blur: how long the shutter is open before the time of each frame, of the 360° between two
        /// frames. 0 is none, 180 is that of a film camera.
        shutter: f32 = 0.0, ["degrees"], {0 to 360};
        /// Number of moments that a picture with motion blur is the mean of. The time to draw grows with it.
        shutter_samples: u32 = 8, "samples", {2 to 64}, when When::Above0("picture.shutter");
    }
}

/// The condition under which the colors of the backdrop have an effect.
const BACKDROP: When = When::IsNot("picture.background", &["transparent"]);
