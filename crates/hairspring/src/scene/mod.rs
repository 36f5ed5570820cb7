//! A scene: everything that a shot needs, in memory, however it was made (by code, or read from a file by `hairspring-io`).

pub mod bench;
pub mod builtin;
mod camera;
mod look;
mod settings;
pub mod swing;

pub use camera::Camera;
pub use look::{HairColor, HairLook};
pub use settings::{
    Collider, Effects, Guides, Integrator, Neighbours, Quality, Shape, Solver, Volume, VolumeMethod, Wind,
};

use crate::{
    body::{Body, Clip},
    groom::Groom,
    material::Material,
};
use glam::Vec3;

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
    /// Further simple shapes that hair collides with.
    pub colliders: Vec<Collider>,
    /// Motion of the body's joints; `None`: at rest.
    pub clip: Option<Clip>,
    /// Moving air.
    pub wind: Wind,
    /// Gravity [m/s²]; the default of a scene file is (0, −9.81, 0).
    pub gravity: Vec3,
    /// Time steps and contact.
    pub solver: Solver,
    /// How hair meets hair.
    pub volume: Volume,
    /// How strands meet each other one by one.
    pub neighbours: Neighbours,
    /// Where it is seen from; `None`: framed automatically.
    pub camera: Option<Camera>,
}
