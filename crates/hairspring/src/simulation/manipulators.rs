//! Manipulators: tools that an application adds, moves and removes between steps.

use super::Simulation;
use crate::collide::FrameColliders;
use crate::{
    forces::{ActiveManipulator, Manipulator, bond::Bonds},
    math::RigidTransform,
    simd::lanes::LANES,
};
use glam::Vec3;

/// Identifies an active manipulator.
///
/// For an example, see [`forces`](crate::forces).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ManipulatorId(u32);

/// The active manipulators.
#[derive(Clone, Default)]
pub(super) struct Tools {
    /// Number of manipulators that were ever added.
    taken: u32,
    pub(super) used: Vec<ActiveManipulator>,
    /// Points of one strand, kept to reuse the memory.
    points: Vec<Vec3>,
}

impl Simulation {
    /// Adds a manipulator at the current state of the hair, with its space at `pose` in the world. It acts in
    /// every step until it is removed. A grab and a tie act on the points that they attach to here. This
    /// allocates memory; steps do not.
    pub fn add_manipulator(&mut self, tool: Manipulator, pose: RigidTransform) -> ManipulatorId {
        let mut bonds = Vec::new();
        let mut points = std::mem::take(&mut self.state.tools.points);
        for (place, strand) in self.model.lanes.iter().enumerate() {
            if *strand != u32::MAX && tool.binds() {
                self.strand_points(place, &mut points);
                points.iter_mut().for_each(|p| *p = pose.inverse_point(*p));
                tool.bind([*strand, place as u32], &points, &mut bonds);
            }
        }
        self.state.tools.points = points;
        let number = self.state.tools.taken;
        self.state.tools.taken += 1;
        let bonds = Bonds::new(bonds);
        self.state.tools.used.push(ActiveManipulator {
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
        if let Some(used) = self.state.tools.used.iter_mut().find(|used| used.number == id.0) {
            used.poses[1] = pose;
        }
    }

    /// Removes a manipulator and releases its points. Does nothing if it was already removed.
    pub fn remove_manipulator(&mut self, id: ManipulatorId) {
        self.state.tools.used.retain(|used| used.number != id.0);
    }

    /// Removes all manipulators.
    pub fn remove_all_manipulators(&mut self) {
        self.state.tools.used.clear();
    }

    /// The strand (index of the groom) and the point of everything that a manipulator is attached to, strand
    /// by strand from the root.
    pub fn attached_points(&self, id: ManipulatorId) -> impl Iterator<Item = (u32, u32)> + '_ {
        let used = self.state.tools.used.iter().filter(move |used| used.number == id.0);
        used.flat_map(|used| used.bonds.0.iter().map(|bond| (bond.strand, bond.point)))
    }

    /// Updates where manipulators would be if they had moved rigidly with the hair.
    pub(super) fn carry_tools(&mut self, by: &RigidTransform) {
        for used in &mut self.state.tools.used {
            used.along = by.after(&used.along);
        }
    }

    /// Starts the frame: manipulators that move with the hair start from its new pose, and hair slips through
    /// gathering ties.
    pub(super) fn begin_tools(&mut self, bodies: &FrameColliders) {
        let mut tools = std::mem::take(&mut self.state.tools);
        for used in &mut tools.used {
            used.go_along();
            used.slip(bodies, &mut tools.points, |place, points| self.strand_points(place as usize, points));
        }
        self.state.tools = tools;
    }

    /// Takes over the manipulators of `old`, whose strand in lane `p` is in lane `lanes[p]` here.
    pub(super) fn take_over_tools(&mut self, old: &Self, lanes: &[u32]) {
        self.state.tools.taken = old.state.tools.taken;
        self.state.tools.used.clone_from(&old.state.tools.used);
        for bond in self.state.tools.used.iter_mut().flat_map(|used| &mut used.bonds.0) {
            bond.place = lanes[bond.place as usize];
        }
    }

    /// Ends the frame: the manipulators have reached their poses.
    pub(super) fn rest_tools(&mut self, dt: f32) {
        for used in &mut self.state.tools.used {
            (used.poses[0], used.along) = (used.poses[1], used.poses[1]);
            used.time += dt;
        }
    }

    /// Writes the world positions of the points of the strand in a lane [m].
    fn strand_points(&self, place: usize, points: &mut Vec<Vec3>) {
        let root = self.root_position(place);
        let stride = self.model.tiles[place / LANES].model.stride();
        points.clear();
        points.extend(self.particles(place).step_by(stride).map(|x| root + x));
    }
}
