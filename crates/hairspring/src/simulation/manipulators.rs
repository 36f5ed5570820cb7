//! Manipulators: tools that an application adds, moves and removes between steps.

use super::Simulation;
use crate::collide::FrameColliders;
use crate::{
    forces::{ActiveManipulator, Manipulator, bond::Bonds},
    math::RigidTransform,
};
use glam::Vec3;

/// Identifies an active manipulator. The identifier of a removed one is not used again by the same simulation, not even
/// after [`Simulation::restore`].
///
/// For an example, see [`forces`](crate::forces).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ManipulatorId(u32);

/// The active manipulators.
#[derive(Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Manipulators {
    /// Number of manipulators that were ever added. A restored snapshot does not lower it.
    pub(super) added: u32,
    pub(super) active: Vec<ActiveManipulator>,
    /// Points of one strand, kept to reuse the memory.
    points: Vec<Vec3>,
}

impl Simulation {
    /// Adds a manipulator at the current state of the hair, with its space at `pose` in the world. It acts in
    /// every step until it is removed. A grab and a tie act on the points that they attach to here. This
    /// allocates memory; steps do not.
    pub fn add_manipulator(&mut self, tool: Manipulator, pose: RigidTransform) -> ManipulatorId {
        let mut bonds = Vec::new();
        let mut points = std::mem::take(&mut self.state.manipulators.points);
        for (place, strand) in self.model.groom_strands.iter().enumerate() {
            if *strand != u32::MAX && tool.binds() {
                self.strand_points(place, &mut points);
                points.iter_mut().for_each(|p| *p = pose.inverse_transform_point(*p));
                tool.bind([*strand, place as u32], &points, &mut bonds);
            }
        }
        self.state.manipulators.points = points;
        let number = self.state.manipulators.added;
        self.state.manipulators.added += 1;
        let bonds = Bonds::new(bonds);
        self.state.manipulators.active.push(ActiveManipulator {
            number,
            tool,
            poses: [pose; 2],
            along: pose,
            time: 0.0,
            bonds,
        });
        ManipulatorId(number)
    }

    /// Moves a manipulator: its space moves to `pose` in the next step. Does nothing if it was removed.
    pub fn set_manipulator_pose(&mut self, id: ManipulatorId, pose: RigidTransform) {
        if let Some(active) = self.state.manipulators.active.iter_mut().find(|active| active.number == id.0) {
            active.poses[1] = pose;
        }
    }

    /// Removes a manipulator and releases its points. Does nothing if it was already removed.
    pub fn remove_manipulator(&mut self, id: ManipulatorId) {
        self.state.manipulators.active.retain(|active| active.number != id.0);
    }

    /// Removes all manipulators.
    pub fn remove_all_manipulators(&mut self) {
        self.state.manipulators.active.clear();
    }

    /// The strand (index of the groom) and the point of everything that a manipulator is attached to, strand
    /// by strand from the root.
    pub fn attached_points(&self, id: ManipulatorId) -> impl Iterator<Item = (u32, u32)> + '_ {
        let active = self.state.manipulators.active.iter().filter(move |active| active.number == id.0);
        active.flat_map(|active| active.bonds.0.iter().map(|bond| (bond.strand, bond.point)))
    }

    /// Updates where manipulators would be if they had moved rigidly with the hair.
    pub(super) fn carry_manipulators(&mut self, by: &RigidTransform) {
        for active in &mut self.state.manipulators.active {
            active.along = *by * active.along;
        }
    }

    /// Starts the frame: manipulators that move with the hair start from its new pose, and hair slips through
    /// gathering ties.
    pub(super) fn begin_manipulators(&mut self, bodies: &FrameColliders) {
        let mut manipulators = std::mem::take(&mut self.state.manipulators);
        for active in &mut manipulators.active {
            active.go_along();
            active.slip(bodies, &mut manipulators.points, |place, points| {
                self.strand_points(place as usize, points)
            });
        }
        self.state.manipulators = manipulators;
    }

    /// Takes over the manipulators of `old`, whose strand in lane `p` is in lane `lanes[p]` here.
    pub(super) fn take_over_manipulators(&mut self, old: &Self, lanes: &[u32]) {
        let added = &mut self.state.manipulators.added;
        *added = old.state.manipulators.added.max(*added);
        self.state.manipulators.active.clone_from(&old.state.manipulators.active);
        for bond in self.state.manipulators.active.iter_mut().flat_map(|active| &mut active.bonds.0) {
            bond.place = lanes[bond.place as usize];
        }
    }

    /// Ends the frame: the manipulators have reached their poses.
    pub(super) fn end_manipulators(&mut self, dt: f32) {
        for active in &mut self.state.manipulators.active {
            (active.poses[0], active.along) = (active.poses[1], active.poses[1]);
            active.time += dt;
        }
    }

    /// Writes the world positions of the points of the strand in a lane [m].
    fn strand_points(&self, place: usize, points: &mut Vec<Vec3>) {
        points.clear();
        points.extend(self.strand(place).points());
    }
}
