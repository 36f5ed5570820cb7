//! The types that most programs need: `use hairspring::prelude::*;`. For an example, see the [crate](crate#quick-start).

pub use crate::{
    air::Air,
    collide::{Collider, ColliderPose, ColliderShape, MovingCollider, SignedDistanceField},
    forces::{ForceField, Manipulator, StrandView},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Integrator, Neighbours, Quality, Response, Solver, Volume, VolumeMethod, Wind},
    simulation::{ForceId, GroupId, ManipulatorId, Simulation, Snapshot, StepInput, StepReport},
};
pub use glam::{Quat, Vec3};
