//! Hands on the hair: tools that an app takes, moves and lets go of between steps.

use super::Simulation;
use crate::collide::FrameColliders;
use crate::{
    forces::{ActiveManipulator, Manipulator, bond::Bonds},
    math::RigidTransform,
    simd::lanes::LANES,
};
use glam::Vec3;

/// A tool in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ManipulatorId(u32);

/// Tools in use.
#[derive(Default)]
pub(super) struct Tools {
    /// How many were ever taken.
    taken: u32,
    pub(super) used: Vec<ActiveManipulator>,
    /// Points of one strand, kept for their memory.
    points: Vec<Vec3>,
}

impl Simulation {
    /// Takes a tool to the hair as it is now, its space being at `pose` in the world. It acts in every step until it is let go of; a grab and a tie
    /// act on what they take hold of here. This allocates; steps do not.
    pub fn add_manipulator(&mut self, tool: Manipulator, pose: RigidTransform) -> ManipulatorId {
        let mut bonds = Vec::new();
        let mut points = std::mem::take(&mut self.tools.points);
        for (place, strand) in self.lanes.iter().enumerate() {
            if *strand != u32::MAX && tool.binds() {
                self.strand_points(place, &mut points);
                points.iter_mut().for_each(|p| *p = pose.inverse_point(*p));
                tool.bind([*strand, place as u32], &points, &mut bonds);
            }
        }
        self.tools.points = points;
        let number = self.tools.taken;
        self.tools.taken += 1;
        let bonds = Bonds::new(bonds);
        self.tools.used.push(ActiveManipulator {
            number,
            tool,
            poses: [pose; 2],
            along: pose,
            time: 0.0,
            bonds,
        });
        ManipulatorId(number)
    }

    /// Moves a tool: its space goes to `pose` in the next step. Nothing where it was let go of.
    pub fn set_manipulator_pose(&mut self, id: ManipulatorId, pose: RigidTransform) {
        if let Some(used) = self.tools.used.iter_mut().find(|used| used.number == id.0) {
            used.poses[1] = pose;
        }
    }

    /// Lets go of a tool, and of what it holds. Nothing where that was done.
    pub fn remove_manipulator(&mut self, id: ManipulatorId) {
        self.tools.used.retain(|used| used.number != id.0);
    }

    /// Lets go of every tool.
    pub fn remove_all_manipulators(&mut self) {
        self.tools.used.clear();
    }

    /// The strand (index of the groom) and the point of everything that a tool holds, strand by strand, root first.
    pub fn attached_points(&self, id: ManipulatorId) -> impl Iterator<Item = (u32, u32)> + '_ {
        let used = self.tools.used.iter().filter(move |used| used.number == id.0);
        used.flat_map(|used| used.bonds.0.iter().map(|bond| (bond.strand, bond.point)))
    }

    /// Hair was carried along by a motion.
    pub(super) fn carry_tools(&mut self, by: &RigidTransform) {
        for used in &mut self.tools.used {
            used.along = by.after(&used.along);
        }
    }

    /// Tools that went along with carried hair start with it; hair slips through ties that gather.
    pub(super) fn begin_tools(&mut self, bodies: &FrameColliders) {
        let mut tools = std::mem::take(&mut self.tools);
        for used in &mut tools.used {
            used.go_along();
            used.slip(bodies, &mut tools.points, |place, points| self.strand_points(place as usize, points));
        }
        self.tools = tools;
    }

    /// Goes on with the tools of `old`, whose strand in lane `p` is here in lane `lanes[p]`.
    pub(super) fn take_over_tools(&mut self, old: &Self, lanes: &[u32]) {
        self.tools.taken = old.tools.taken;
        self.tools.used.clone_from(&old.tools.used);
        for bond in self.tools.used.iter_mut().flat_map(|used| &mut used.bonds.0) {
            bond.place = lanes[bond.place as usize];
        }
    }

    /// Tools are where they were to go.
    pub(super) fn rest_tools(&mut self, dt: f32) {
        for used in &mut self.tools.used {
            (used.poses[0], used.along) = (used.poses[1], used.poses[1]);
            used.time += dt;
        }
    }

    /// Writes the points of the strand in a lane, in the world [m].
    fn strand_points(&self, place: usize, points: &mut Vec<Vec3>) {
        let root = self.root_position(place);
        let stride = self.tiles[place / LANES].model.stride();
        points.clear();
        points.extend(self.particles(place).step_by(stride).map(|x| root + x));
    }
}
