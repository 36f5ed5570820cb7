//! The light of a picture: three lamps and a sky.

use glam::{Quat, Vec3};
use hairspring_scene::{Camera, Picture};

/// A directional lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Direction from the scene toward the lamp; any length above 0.
    pub direction: Vec3,
    /// Linear RGB, 0 or more: the light that a white matte card facing the lamp reflects.
    pub color: Vec3,
}

/// Three lamps, a sky and an exposure. The default is portrait light for a face that looks along +Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// The main lamp, which casts sharp shadows. Default: front, high, to the camera's left, warm.
    pub key: Light,
    /// Fill light for the shadow side. Default: front right, low, cool, a fifth of the key.
    pub fill: Light,
    /// Rim light, which separates the hair from the backdrop and shines through it. Default: behind, high,
    /// right, neutral.
    pub rim: Light,
    /// Light from straight above, linear RGB.
    pub sky: Vec3,
    /// Light from straight below, linear RGB.
    pub ground: Vec3,
    /// Brightness of the picture [stops], 0 by default.
    pub exposure: f32,
}

impl Default for Lighting {
    fn default() -> Self {
        Self {
            key: Light { direction: Vec3::new(-0.62, 0.72, 0.72), color: Vec3::new(2.35, 2.2, 2.0) },
            fill: Light { direction: Vec3::new(0.85, 0.15, 0.6), color: Vec3::new(0.34, 0.38, 0.44) },
            rim: Light { direction: Vec3::new(0.55, 0.62, -0.8), color: Vec3::new(2.3, 2.35, 2.5) },
            sky: Vec3::new(0.40, 0.43, 0.48),
            ground: Vec3::new(0.16, 0.14, 0.13),
            exposure: 0.0,
        }
    }
}

impl Lighting {
    /// The light of a scene: that of a camera on +Z, turned with `camera` about the vertical axis, and by the
    /// scene's light angle.
    pub fn of(picture: &Picture, camera: &Camera) -> Self {
        Self::facing(camera).turned(picture.light_angle)
    }

    /// The default light, rotated about the vertical axis, so that it illuminates the target of `camera` as
    /// it does for a camera on +Z.
    pub fn facing(camera: &Camera) -> Self {
        let back = camera.position - camera.target;
        let angle = back.x.atan2(back.z).to_degrees();
        if angle.is_finite() { Self::default().turned(angle) } else { Self::default() }
    }

    /// The same light with all lamps turned about the vertical axis by `angle` [degrees], counterclockwise as
    /// seen from above.
    pub fn turned(self, angle: f32) -> Self {
        let turn = Quat::from_rotation_y(angle.to_radians());
        let lamp = |light: Light| Light { direction: turn * light.direction, ..light };
        Self { key: lamp(self.key), fill: lamp(self.fill), rim: lamp(self.rim), ..self }
    }
}

/// The backdrop: a soft pool of light on a dark wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// Linear RGB at the center of the picture, slightly above the middle.
    pub center: Vec3,
    /// Linear RGB in the corners.
    pub edge: Vec3,
}

impl Background {
    /// The backdrop of a scene.
    pub fn of(picture: &Picture) -> Self {
        Self { center: picture.backdrop_center, edge: picture.backdrop_edge }
    }

    /// The color of a plain backdrop, which is the same everywhere. It is no lit wall but a color behind the developed
    /// picture: exposure and tone curve do not apply to it, so that its pixels have exactly this color.
    pub fn plain(&self) -> Option<Vec3> {
        (self.center == self.edge && self.center.is_finite())
            .then(|| self.center.clamp(Vec3::ZERO, Vec3::ONE))
    }
}

impl Default for Background {
    fn default() -> Self {
        let Picture { backdrop_center, backdrop_edge, .. } = Picture::default();
        Self { center: backdrop_center, edge: backdrop_edge }
    }
}
