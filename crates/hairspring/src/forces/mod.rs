//! External forces: what acts on the points apart from gravity, collisions and root constraints. They are
//! computed once a frame and stay constant for its substeps.
//!
//! Each force adds to a point's own diagonal block and to its right-hand side. It is therefore implicit, and
//! couples no two strands. The hair volume writes first; then each force adds its part, strand by strand.
//! Each has its own file:
//!
//! | force | |
//! | --- | --- |
//! | [`global_shape`] | a weak spring to the rest shape |
//! | [`grab`] | a hand that holds the points in a ball |
//! | [`comb`] | tines that drag hair transverse to itself |
//! | [`tie`] | a ring that gathers strands |
//! | [`charge`] | charged bodies, and charged hair |
//! | [`wind`] | air whose velocity varies in space |
//!
//! # Example
//! ```
//! use hairspring::{forces::grab::Grab, prelude::*};
//!
//! let strand: Vec<Vec3> = (0..8).map(|i| Vec3::NEG_Y * (0.01 * i as f32)).collect();
//! let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).build()?;
//! let hand = Grab { center: Vec3::NEG_Y * 0.07, radius: 0.005, pull: 60.0, damping: 1.0 };
//! let id = simulation.add_manipulator(Manipulator::Grab(hand), RigidTransform::default());
//! // The tip, which is point 7 of strand 0.
//! assert!(simulation.attached_points(id).eq([(0, 7)]));
//! # Ok::<(), hairspring::simulation::BuildError>(())
//! ```

pub(crate) mod bond;
pub mod charge;
pub mod comb;
mod force_field;
pub(crate) mod global_shape;
pub mod grab;
mod hair_field;
mod manipulator;
mod strand_batch;
mod strand_view;
pub mod tie;
mod wind;

pub(crate) use charge::{Charges, LineCharge};
pub use force_field::ForceField;
pub(crate) use hair_field::HairField;
pub(crate) use manipulator::ActiveManipulator;
pub use manipulator::Manipulator;
pub(crate) use strand_batch::StrandBatch;
pub use strand_view::StrandView;
pub(crate) use wind::WindSampler;

use crate::{
    math::RigidTransform,
    simd::lanes::Row,
    strand::tile::{anisotropic_drag, position_spring},
};
use glam::Vec3;

/// The per-point forces of all tiles in a frame. Each array has shape `[points]` over all tiles, or is empty
/// if it is not in use.
#[derive(Default)]
pub(crate) struct ForceBuffers {
    /// See `Tile::external_acceleration`.
    pub external_acceleration: Vec<[Row; 3]>,
    /// See `Tile::position_spring`.
    pub position_spring: Vec<[Row; position_spring::ROWS]>,
    /// See `Tile::anisotropic_drag`.
    pub anisotropic_drag: Vec<[Row; anisotropic_drag::ROWS]>,
    /// See `Tile::wind_delta`.
    pub wind_delta: Vec<[Row; 3]>,
}

/// Which force buffers are in use in a frame.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct ForceMask {
    /// Accelerations.
    pub external_acceleration: bool,
    /// Springs to a position and drag toward a velocity. They also use the accelerations.
    pub position_spring: bool,
    /// Drag transverse to the strands.
    pub anisotropic_drag: bool,
    /// Air velocity that differs from the directional wind.
    pub wind_delta: bool,
}

impl ForceBuffers {
    /// Resizes the buffers in `kinds` for `points` points and sets all forces to zero.
    pub fn prepare(&mut self, points: usize, kinds: ForceMask) {
        let size = |on: bool| if on { points } else { 0 };
        self.external_acceleration
            .resize(size(kinds.external_acceleration || kinds.position_spring), [Row::default(); 3]);
        self.position_spring.resize(size(kinds.position_spring), [Row::default(); position_spring::ROWS]);
        self.anisotropic_drag.resize(size(kinds.anisotropic_drag), [Row::default(); anisotropic_drag::ROWS]);
        self.wind_delta.resize(size(kinds.wind_delta), [Row::default(); 3]);
        self.external_acceleration.fill([Row::default(); 3]);
        self.position_spring.fill([Row::default(); position_spring::ROWS]);
        self.anisotropic_drag.fill([Row::default(); anisotropic_drag::ROWS]);
        self.wind_delta.fill([Row::default(); 3]);
    }

    /// Returns the memory used, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.external_acceleration[..])
            + size_of_val(&self.position_spring[..])
            + size_of_val(&self.anisotropic_drag[..])
            + size_of_val(&self.wind_delta[..])
    }
}

/// The motion of the anchor in a frame: its pose at the start and at the end, and the frame's duration [s].
#[derive(Clone, Copy)]
pub(crate) struct FrameMotion {
    pub anchor: [RigidTransform; 2],
    pub dt: f32,
}

impl FrameMotion {
    /// Rotation vector of the anchor over time [rad/s].
    pub fn spin(&self) -> Vec3 {
        let [start, end] = self.anchor;
        let turn = end.rotation * start.rotation.inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        turn.to_scaled_axis() / self.dt
    }
}
