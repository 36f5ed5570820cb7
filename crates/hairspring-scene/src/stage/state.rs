//! Copies of the state of a stage, to return to.

use super::{Stage, clock::Clock, manipulators::HandState};
use hairspring::{
    math::RigidTransform,
    simulation::{Snapshot, SnapshotMismatch},
};

/// A copy of the state of a [`Stage`], from [`Stage::state`]. With the feature `serde`, it can be written to a file, which the same
/// version reads for the same scene.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StageState {
    simulation: Snapshot,
    clock: Clock,
    hands: Vec<HandState>,
    /// See [`Stage::move_body`].
    moved: RigidTransform,
    /// See [`StageState::bytes`].
    bytes: usize,
}

impl StageState {
    /// Returns the time since the start of the scene [s].
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Upper bound of the size of the state in memory [bytes]: that of the whole simulation.
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

impl Stage {
    /// Copies everything that a frame changes: the hair, the time, the manipulators, and the motion of
    /// [`Stage::move_body`].
    pub fn state(&self) -> StageState {
        StageState {
            simulation: self.simulation.snapshot(),
            clock: self.clock,
            hands: self.hands.state().to_vec(),
            moved: self.body.pose().moved(),
            bytes: self.simulation.bytes() + size_of::<StageState>(),
        }
    }

    /// Returns to a state of this stage, or of another one of the same scene. The settings stay as they are.
    /// The body and the colliders are posed for that time, without velocity. Colliders of
    /// [`Stage::set_user_colliders`] stay where they are.
    ///
    /// # Errors
    /// If the state is of other strands, or of another elastic model or integrator. Nothing changes then.
    pub fn restore(&mut self, state: &StageState) -> Result<(), SnapshotMismatch> {
        if !self.hands.fits(&state.hands) {
            return Err(SnapshotMismatch);
        }
        self.simulation.restore(&state.simulation)?;
        self.hands.set_state(&state.hands);
        self.clock = state.clock;
        self.body.pose_mut().move_to(state.moved);
        self.body.place(&self.scene, self.clock.time());
        self.pose_roots();
        self.update_render_points();
        Ok(())
    }
}
