//! A scene: everything that a shot needs, in memory. It is built in code or read from a file by
//! `hairspring-io`.

pub mod builtin;
mod camera;
mod color;
mod ground;
mod guides;
mod hand;
mod look;
mod picture;
mod settings;
pub mod stage;
mod vertex_cache;

pub use camera::Camera;
pub use color::{color_from_hex, deserialize_color, deserialize_optional_color, linear_from_srgb};
pub use ground::Ground;
pub use guides::Guides;
pub use hand::Hand;
pub use look::{HairColor, HairLook};
pub use picture::{Background, Picture};
pub use settings::{Collider, InitialContact, Shape};
pub use vertex_cache::VertexCache;

use glam::Vec3;
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::{Body, Clip},
    forces::charge::Charged,
    groom::Groom,
    material::Material,
    settings::{Effects, Neighbours, OutOfRange, Range, Solver, Validate, Volume, Wind, validate_gravity},
};

/// One hairstyle of a scene, with its settings for simulation and rendering.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneGroom {
    /// Name shown in lists; it may be empty.
    pub name: String,
    /// The strands, in the rest pose of the body [m].
    pub groom: Groom,
    /// Material of each group; groups beyond the end use the last one. Empty: [`Material::default`].
    pub materials: Vec<Material>,
    /// Which strands are simulated.
    pub guides: Guides,
    /// Styling of the follow hairs.
    pub effects: Effects,
    /// Hair color and shading.
    pub look: HairLook,
}

/// An open mesh that hair collides with: a cape, a leaf, a hand made of one surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneSheet {
    /// The mesh, in the same rest pose and with the same joints as the scene's body.
    pub body: Body,
    /// Distance that hair keeps from it, on both sides [m], above 0. Scene files default to
    /// [`SceneSheet::THICKNESS`].
    pub thickness: f32,
    /// What happens to hair that passes through it before the scene begins.
    pub initial: InitialContact,
}

impl SceneSheet {
    /// Default thickness [m]: 2 mm, the distance covered in one substep at half a meter per second, with the
    /// default of four substeps.
    pub const THICKNESS: f32 = 0.002;
}

/// A scene, the input of a simulation: grooms, body, motion and settings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Name shown in reports.
    pub name: String,
    /// The hairstyles.
    pub grooms: Vec<SceneGroom>,
    /// The body that is drawn and that roots are bound to. `None`: hair in the air with fixed roots.
    pub body: Option<Body>,
    /// Closed mesh that hair collides with, in the same rest pose and with the same joints as `body`. `None`:
    /// the body's own mesh if `solver.collide_body` is on.
    pub collision: Option<Body>,
    /// Open meshes that hair collides with on both sides.
    pub sheets: Vec<SceneSheet>,
    /// Additional simple shapes that hair collides with.
    pub colliders: Vec<Collider>,
    /// Motion of the body's joints; `None`: at rest.
    pub clip: Option<Clip>,
    /// Motion of the body's vertices, for a body without a skin; then `clip` must be `None`.
    pub vertex_cache: Option<VertexCache>,
    /// The directional wind.
    pub wind: Wind,
    /// Wind sources.
    pub wind_sources: Vec<WindSource>,
    /// Turbulence of the air.
    pub turbulence: Turbulence,
    /// Wind occlusion by bodies and hair.
    pub wind_occlusion: WindOcclusion,
    /// Charged bodies.
    pub charged: Vec<Charged>,
    /// Gravity [m/s²]; the default of a scene file is (0, −9.81, 0).
    pub gravity: Vec3,
    /// Settings of time steps and contact.
    pub solver: Solver,
    /// Settings of the hair volume.
    pub volume: Volume,
    /// Settings of contact between individual strands.
    pub neighbours: Neighbours,
    /// Camera; `None`: the scene is framed automatically.
    pub camera: Option<Camera>,
    /// Backdrop, light and shutter of pictures.
    pub picture: Picture,
    /// The ground plane that is drawn.
    pub ground: Ground,
    /// Hands that act on the hair with a manipulator.
    pub hands: Vec<Hand>,
}

/// Returns whether the channels of a color are 0 to 1.
pub fn is_color(c: Vec3) -> bool {
    c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 1.0
}

/// The error for a setting of a scene that is out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {error}")]
pub struct SceneError {
    /// The part of the scene, such as `solver` or `groom 2, material 1`.
    pub place: String,
    /// The setting.
    pub error: OutOfRange,
}

impl Scene {
    /// Returns the duration of the body's motion [s]; `None` if it has none.
    pub fn motion_duration(&self) -> Option<f64> {
        let clip = self.clip.as_ref().filter(|clip| clip.frame_count() > 1).map(Clip::duration);
        clip.or_else(|| self.vertex_cache.as_ref().filter(|c| c.frames.len() > 1).map(VertexCache::duration))
    }

    /// Checks all settings of the scene by the rules that hold for scene files.
    ///
    /// # Errors
    /// The first setting that is out of range, and its place. Grooms, colliders and hands are counted from 0.
    pub fn validate(&self) -> Result<(), SceneError> {
        let mut parts: Vec<(String, &dyn Validate)> = vec![
            ("wind".into(), &self.wind),
            ("turbulence".into(), &self.turbulence),
            ("wind_occlusion".into(), &self.wind_occlusion),
            ("solver".into(), &self.solver),
            ("volume".into(), &self.volume),
            ("neighbours".into(), &self.neighbours),
            ("picture".into(), &self.picture),
            ("ground".into(), &self.ground),
        ];
        for (k, groom) in self.grooms.iter().enumerate() {
            parts.push((format!("groom {k}, look"), &groom.look));
            parts.push((format!("groom {k}, effects"), &groom.effects));
            for (m, material) in groom.materials.iter().enumerate() {
                parts.push((format!("groom {k}, material {m}"), material));
            }
        }
        parts.extend(self.camera.iter().map(|camera| ("camera".into(), camera as &dyn Validate)));
        let numbered = |name: &str, k: usize| format!("{name} {k}");
        for (k, source) in self.wind_sources.iter().enumerate() {
            parts.push((numbered("wind_source", k), source));
        }
        for (k, charged) in self.charged.iter().enumerate() {
            parts.push((numbered("charged", k), charged));
        }
        for (k, collider) in self.colliders.iter().enumerate() {
            parts.push((numbered("collider", k), collider));
        }
        for (k, hand) in self.hands.iter().enumerate() {
            parts.push((numbered("hand", k), hand));
        }
        for (k, sheet) in self.sheets.iter().enumerate() {
            if !Range::Above(0.0).accepts(&sheet.thickness) {
                let error = OutOfRange { key: "thickness".into(), expected: "above 0 [m]" };
                return Err(SceneError { place: numbered("sheet", k), error });
            }
        }
        for (place, part) in parts {
            part.validate().map_err(|error| SceneError { place, error })?;
        }
        validate_gravity(self.gravity).map_err(|error| SceneError { place: "scene".into(), error })
    }
}

// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_made_by_code_follows_the_rules_of_scene_files() {
        let error = |scene: Scene| scene.validate().unwrap_err().to_string();
        let sheet = SceneSheet { thickness: 0.0, ..SceneSheet::default() };
        let scene = Scene { sheets: vec![sheet], ..Scene::default() };
        assert_eq!(error(scene), "sheet 0: `thickness` must be above 0 [m]");
        let shape = Shape::Sphere { center: Vec3::ZERO, radius: -1.0 };
        let scene = Scene {
            colliders: vec![Collider { joint: None, initial: InitialContact::Keep, shape }],
            ..Scene::default()
        };
        assert_eq!(error(scene), "collider 0: `shape.sphere.radius` must be above 0 [m]");
        assert_eq!(Scene::default().validate(), Ok(()));
    }
}
