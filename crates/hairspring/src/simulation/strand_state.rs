//! The state of the simulated strands: everything that a step changes, and copies of it.

use super::{Simulation, manipulators::Manipulators, teleport::Motion};
use crate::{
    forces::charge::ChargedBall,
    math::RigidTransform,
    simd::lanes::Row,
    strand::tile::{HistoryRows, HoldRows, RootRows, SegmentContactRows, StateRows},
    strand_contact::Contact,
};

/// Positions, velocities, tensions and contact forces of the simulated strands, and the motion of their roots.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct StrandState {
    /// Pose of the anchor at the end of the last step.
    pub(super) anchor: RigidTransform,
    /// Motion of the roots; shape `[tiles]`.
    pub(super) roots: Vec<RootRows>,
    /// Shape `[points]` of all tiles.
    pub(super) points: Vec<StateRows>,
    /// As long as `points` for the second-order integrator, else empty.
    pub(super) history: Vec<HistoryRows>,
    /// Remaining time for which each strand still counts as touching [s]; one row for each tile.
    pub(super) contact_age: Vec<Row>,
    /// Contacts of the segment that ends at each point; empty if segments are not tested.
    pub(super) segment_contacts: Vec<SegmentContactRows>,
    /// Holds on points, for each tile.
    pub(super) holds: Vec<Vec<HoldRows>>,
    /// Active manipulators.
    pub(super) manipulators: Manipulators,
    pub(super) charged: Vec<ChargedBall>,
    /// How the anchor moved in the last frame.
    pub(super) motion: Motion,
    /// Length of the last substep [s]; 0 before the first.
    pub(super) last_h: f32,
}

/// A copy of the state of a [`Simulation`], from [`Simulation::snapshot`]. With the feature `serde`, it can be written to a
/// file, which the same version of the library reads.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snapshot {
    /// See [`Simulation::fingerprint`].
    fingerprint: u64,
    state: StrandState,
    /// Contacts between strands.
    contacts: Vec<Contact>,
    /// Whether segments were tested in the last frame.
    segments: bool,
}

impl std::fmt::Debug for Snapshot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Snapshot")
            .field("fingerprint", &self.fingerprint)
            .field("anchor", &self.state.anchor)
            .finish_non_exhaustive()
    }
}

/// The reason that a [`Snapshot`] cannot be restored.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the snapshot is of other strands, or of another elastic model, integrator or setting of `segment_contacts`"
)]
pub struct SnapshotMismatch;

impl Simulation {
    /// Copies everything that a step changes: positions, velocities, tensions, contacts, manipulators, holds
    /// and the pose of the anchor. After [`Simulation::restore`], the same inputs give the same bits again.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            fingerprint: self.fingerprint(),
            state: self.state.clone(),
            contacts: self.neighbours.as_ref().map(|n| n.contacts().to_vec()).unwrap_or_default(),
            segments: self.frame.segments,
        }
    }

    /// Returns to the state of `snapshot`, which may be from another simulation of the same strands with the
    /// same model, integrator and `solver.segment_contacts`. It allocates no memory unless the number of manipulators or
    /// holds changed. Rest shapes are not compared, because other settings may differ.
    ///
    /// # Errors
    /// If the snapshot is of other strands or other numbers of points, or one of these settings differs; the state is then
    /// unchanged.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), SnapshotMismatch> {
        let (own, other) = (&self.state, &snapshot.state);
        let alike = self.fingerprint() == snapshot.fingerprint
            && own.roots.len() == other.roots.len()
            && own.points.len() == other.points.len()
            && own.history.len() == other.history.len()
            && own.contact_age.len() == other.contact_age.len()
            && own.holds.len() == other.holds.len()
            && own.segment_contacts.len() == other.segment_contacts.len();
        if !alike {
            return Err(SnapshotMismatch);
        }
        let added = own.manipulators.added.max(other.manipulators.added);
        self.state.clone_from(other);
        self.state.manipulators.added = added;
        self.frame.segments = snapshot.segments;
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.set_contacts(&snapshot.contacts);
        }
        Ok(())
    }

    /// A hash (FNV-1a) that two simulations share if each strand has the same index, place in memory, number of points
    /// and elastic model, and the integrator is the same.
    fn fingerprint(&self) -> u64 {
        let model = &*self.model;
        let strands = model.groom_strands.iter().zip(&model.strand_of_lane).filter(|(s, _)| **s != u32::MAX);
        let strands = strands.flat_map(|(s, k)| [*s, *k, model.groom.range(*s as usize).len() as u32]);
        let tiles = model.tiles.iter().flat_map(|tile| [tile.first, tile.points, tile.model as u32]);
        let numbers = strands.chain(tiles).chain([model.solver.integrator as u32]);
        let bytes = numbers.flat_map(u32::to_le_bytes);
        bytes
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }
}
