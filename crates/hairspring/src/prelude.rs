//! The types that most programs need: `use hairspring::prelude::*;`. For an example, see the [crate](crate#quick-start).

pub use crate::{
    air::{Air, Flow, Turbulence, WindOcclusion, WindSource},
    collide::{
        Collider, ColliderPose, ColliderShape, Hull, MovingCollider, SignedDistanceField, ThinShell, voxelize,
    },
    follow::{Follow, assign_guides, choose_guides},
    forces::{ForceField, Manipulator, StrandView},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{
        Effects, Integrator, Neighbours, OutOfRange, Quality, Response, Solver, Validate, Volume,
        VolumeMethod, Wind,
    },
    simulation::{
        BuildError, ContactPoint, DebugLine, DebugLineKind, DebugRenderMode, ForceId, GroupId, Hold,
        ManipulatorId, PointsError, Simulation, SimulationBuilder, Snapshot, SnapshotMismatch, StepError,
        StepInput, StepReport,
    },
};
pub use glam::{Mat3, Quat, Vec3};
