//! A scene: everything that a shot needs, in memory, however it was made (by code, or read from a file by `hairspring-io`).

pub mod builtin;
mod camera;
mod ground;
mod hand;
mod look;
mod settings;
pub mod stage;

pub use camera::Camera;
pub use ground::Ground;
pub use hand::Hand;
pub use look::{HairColor, HairLook};
pub use settings::{Collider, Guides, Shape};

use glam::Vec3;
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::{Body, Clip},
    forces::charge::Charged,
    groom::Groom,
    material::Material,
    settings::{Effects, Neighbours, Solver, Volume, Wind},
};

/// One hairstyle of a scene and how it is simulated and drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneGroom {
    /// The strands, in the rest pose of the body [m].
    pub groom: Groom,
    /// Fibre of each group; a group past the end uses the last. Empty: [`Material::default`].
    pub materials: Vec<Material>,
    /// Which strands are simulated.
    pub guides: Guides,
    /// What is laid over the follow hairs.
    pub effects: Effects,
    /// How it is drawn.
    pub look: HairLook,
}

/// An open mesh that hair collides with: a cape, a leaf, a hand made of one surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneSheet {
    /// The mesh, in the same rest pose and with the same joints as the scene's body.
    pub body: Body,
    /// How far hair stays from it, on both sides [m], above 0. Default of a scene file: [`SceneSheet::THICKNESS`].
    pub thickness: f32,
}

impl SceneSheet {
    /// 2 mm: what falls at half a metre a second moves as far in a substep at the default of four.
    pub const THICKNESS: f32 = 0.002;
}

/// Grooms, body, motion and settings: the input of a simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Shown in reports.
    pub name: String,
    /// The hairstyles.
    pub grooms: Vec<SceneGroom>,
    /// What is drawn and what roots are bound to; `None`: hair in the air, roots fixed.
    pub body: Option<Body>,
    /// Closed mesh that hair collides with, in the same rest pose and with the same joints as `body`;
    /// `None`: the body's own mesh where `solver.collide_body` is on.
    pub collision: Option<Body>,
    /// Open meshes that hair collides with on both sides.
    pub sheets: Vec<SceneSheet>,
    /// Further simple shapes that hair collides with.
    pub colliders: Vec<Collider>,
    /// Motion of the body's joints; `None`: at rest.
    pub clip: Option<Clip>,
    /// The wind of all points.
    pub wind: Wind,
    /// What blows besides.
    pub wind_sources: Vec<WindSource>,
    /// Eddies in the air.
    pub turbulence: Turbulence,
    /// Who stands in the lee.
    pub wind_occlusion: WindOcclusion,
    /// Charged bodies.
    pub charged: Vec<Charged>,
    /// Gravity [m/s²]; the default of a scene file is (0, −9.81, 0).
    pub gravity: Vec3,
    /// Time steps and contact.
    pub solver: Solver,
    /// How hair meets hair.
    pub volume: Volume,
    /// How strands meet their neighbours, one by one.
    pub neighbours: Neighbours,
    /// Where it is seen from; `None`: framed automatically.
    pub camera: Option<Camera>,
    /// What it stands on in the picture.
    pub ground: Ground,
    /// What hands hold to the hair.
    pub hands: Vec<Hand>,
}

// The README's example is a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
