//! The built-in scene: a bust with a full head of hair that nods, turns and shakes. It is generated in code,
//! without files.

mod borders;
mod brows;
mod bust;
mod field;
mod groom;
mod grow;
mod hand;
mod motion;
mod nets;
mod random;
mod roots;
mod sdf;
mod shape;
mod style;

pub use bust::head;
pub use hand::{Hand, hand};
pub use style::Style;

use super::{Camera, Guides, HairLook, Scene, SceneGroom};
use glam::vec3;
use hairspring::material::Material;

/// Options of the built-in scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuiltinOptions {
    /// Number of hairs on the scalp. Default 100,000: a human head.
    pub strands: u32,
    /// Points per hair, 3 or more. Default: [`Style::points`].
    pub points: u32,
    /// The hairstyle. Default wavy.
    pub style: Style,
    /// Random seed of the groom. Default 1.
    pub seed: u32,
    /// The simulated hairs. Default: 2,000 of them.
    pub guides: Guides,
}

impl BuiltinOptions {
    /// Returns the defaults for a style.
    pub fn new(style: Style) -> Self {
        Self { strands: 100_000, points: style.points(), style, seed: 1, guides: Guides::Count(2_000) }
    }
}

impl Default for BuiltinOptions {
    fn default() -> Self {
        Self::new(Style::default())
    }
}

/// Builds the scene. The result is bitwise identical for the same options and any number of threads.
pub fn scene(options: &BuiltinOptions) -> Scene {
    let (mut body, collision) = rayon::join(bust::drawn, bust::collision);
    let (strands, points) = (options.strands as usize, options.points.max(3) as usize);
    let mut scene = settings(options);
    scene.grooms[0].groom = groom::groom(&body.mesh, &options.style.cut(), strands, points, options.seed);
    scene.grooms[1].groom = brows::groom(options.seed);
    if options.strands > 0 {
        bust::shade_scalp(&mut body.mesh, scene.grooms[0].look.root_color);
    }
    scene.clip = Some(motion::clip(&body));
    (scene.body, scene.collision) = (Some(body), Some(collision));
    scene
}

/// Returns the scene without its geometry, which is immediate: its two grooms (hair; brows, lashes and the fine
/// hair of the hairline) have no strands, and there is no body.
pub fn settings(options: &BuiltinOptions) -> Scene {
    let hair = SceneGroom {
        name: "Head hair".into(),
        materials: vec![options.style.material()],
        guides: options.guides,
        look: options.style.look(),
        ..SceneGroom::default()
    };
    let face_hair = SceneGroom {
        name: "Brows and lashes".into(),
        materials: vec![Material::default()],
        guides: Guides::All,
        // Brows are darker than the hair of the head.
        look: HairLook {
            root_color: hair.look.root_color * 0.45,
            tip_color: hair.look.root_color * 0.65,
            ..HairLook::default()
        },
        ..SceneGroom::default()
    };
    Scene {
        name: format!("built-in, {}", options.style.name()),
        grooms: vec![hair, face_hair],
        gravity: vec3(0.0, -9.81, 0.0),
        camera: Some(camera(options.style)),
        ..Scene::default()
    }
}

/// Returns a portrait camera: a three-quarter view from her left, slightly above the eyes, far enough to
/// avoid foreshortening of the face.
fn camera(style: Style) -> Camera {
    // A halo stands higher than falling hair.
    let (height, fov) = if style == Style::Coily { (-0.01, 21.0) } else { (-0.06, 18.0) };
    Camera { position: vec3(0.60, 0.05, 1.28), target: vec3(0.0, height, -0.005), fov, ..Camera::default() }
}
