//! What a hand holds to the hair: settings of any of them, and the state of one in use.

use super::{
    StrandView,
    bond::{Bond, Bonds},
    comb::Comb,
    grab::Grab,
    tie::Tie,
};
use crate::{collide::FrameColliders, math::RigidTransform};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What a hand holds to the hair, in the space that it moves with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Manipulator {
    /// Its fingers: what is in a ball is held.
    Grab(Grab),
    /// A comb.
    Comb(Comb),
    /// A hair tie.
    Tie(Tie),
}

/// A tool in use.
#[derive(Clone)]
pub(crate) struct ActiveManipulator {
    /// Who it is.
    pub number: u32,
    pub tool: Manipulator,
    /// Where it is at the start and at the end of the next frame.
    pub poses: [RigidTransform; 2],
    /// Where it would be at the start, had it gone along with hair that was carried.
    pub along: RigidTransform,
    /// How long it has been in use at the start of the next frame [s].
    pub time: f32,
    /// What it holds.
    pub bonds: Bonds,
}

impl Manipulator {
    /// Whether it holds points that it has hold of, and no others.
    pub(crate) fn binds(&self) -> bool {
        !matches!(self, Self::Comb(_))
    }

    /// Binds what it takes hold of of a strand (index of the groom, lane) with these `points` [m], in the tool's space.
    pub(crate) fn bind(&self, strand: [u32; 2], points: &[Vec3], bonds: &mut Vec<Bond>) {
        match self {
            Self::Grab(grab) => grab.bind(strand, points, bonds),
            Self::Tie(tie) => tie.bind(strand, points, bonds),
            Self::Comb(_) => {}
        }
    }
}

impl ActiveManipulator {
    /// Acts on a strand of so many `points` among `bodies`.
    pub fn act(&self, bodies: &FrameColliders, strand: &mut StrandView, points: usize) {
        match &self.tool {
            Manipulator::Grab(grab) => self.bonds.act(grab.spring(), self.poses, [1.0; 2], bodies, strand),
            Manipulator::Comb(comb) => comb.act(self.poses, strand, points),
            Manipulator::Tie(tie) => {
                let shares = [0.0, strand.frame.dt].map(|after| tie.gathered(self.time + after));
                self.bonds.act(tie.spring(), self.poses, shares, bodies, strand);
            }
        }
    }

    /// Where hair was carried, a tool that went along has no way of its own: its start is where the end is nearer.
    pub fn go_along(&mut self) {
        let away = |pose: &RigidTransform| pose.translation.distance_squared(self.poses[1].translation);
        if away(&self.along) < away(&self.poses[0]) {
            self.poses[0] = self.along;
        }
    }

    /// Where the tool is a tie that still gathers among `bodies`, lets hair slip through it; `read` writes into `points` those of a strand [m] in the world, by its lane.
    pub fn slip(
        &mut self,
        bodies: &FrameColliders,
        points: &mut Vec<Vec3>,
        read: impl Fn(u32, &mut Vec<Vec3>),
    ) {
        let Manipulator::Tie(tie) = &self.tool else { return };
        if !tie.settles(self.time) {
            return;
        }
        let pose = self.poses[0];
        for bonds in self.bonds.0.chunks_exact_mut(2) {
            read(bonds[0].place, points);
            points.iter_mut().for_each(|p| *p = pose.inverse_point(*p));
            let out = |place: Vec3| pose.inverse_point(bodies.out(pose.point(place), 0.0));
            if !tie.slip(self.time, points, out, bonds) {
                bonds.iter_mut().for_each(|bond| bond.point = u32::MAX);
            }
        }
        self.bonds.0.retain(|bond| bond.point != u32::MAX);
    }
}
