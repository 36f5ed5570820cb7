//! Manipulators: the settings of each kind, and the state of one in use.

use super::{
    StrandView,
    bond::{Bond, Bonds},
    comb::Comb,
    grab::Grab,
    tie::Tie,
};
use crate::settings::{Check, Fields, Setting, Validate, with_prefix};
use crate::{
    collide::FrameColliders,
    math::{RigidTransform, nearer_start},
};
use glam::Vec3;

/// A tool that acts on hair by hand, in the space that it moves with.
///
/// For an example, see [`forces`](crate::forces).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case", deny_unknown_fields)
)]
#[non_exhaustive]
pub enum Manipulator {
    /// Fingers: points in a ball are held.
    Grab(Grab),
    /// A comb.
    Comb(Comb),
    /// A hair tie.
    Tie(Tie),
}

/// A manipulator in use.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ActiveManipulator {
    /// Identifier of the manipulator.
    pub number: u32,
    pub tool: Manipulator,
    /// Pose at the start and at the end of the next frame.
    pub poses: [RigidTransform; 2],
    /// Pose at the start if it had moved along with hair that was teleported.
    pub along: RigidTransform,
    /// Time in use at the start of the next frame [s].
    pub time: f32,
    /// The attached points.
    pub bonds: Bonds,
}

impl Manipulator {
    /// Returns whether it attaches points when it is added and then acts only on these.
    pub(crate) fn binds(&self) -> bool {
        !matches!(self, Self::Comb(_))
    }

    /// Attaches points of a strand (index in the groom, lane) with these `points` [m], in the manipulator's
    /// space.
    pub(crate) fn bind(&self, strand: [u32; 2], points: &[Vec3], bonds: &mut Vec<Bond>) {
        match self {
            Self::Grab(grab) => grab.bind(strand, points, bonds),
            Self::Tie(tie) => tie.bind(strand, points, bonds),
            Self::Comb(_) => {}
        }
    }
}

impl ActiveManipulator {
    /// Applies the manipulator to a strand of `points` points, given the `bodies`.
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

    /// After a teleport of the hair: chooses the start pose that is nearer to the end pose, so that a
    /// manipulator that moved along has no motion of its own.
    pub fn go_along(&mut self) {
        let [start, end] = self.poses;
        let distance = |pose: &RigidTransform| pose.translation.distance_squared(end.translation);
        self.poses[0] = nearer_start(start, self.along, distance);
    }

    /// If the manipulator is a tie that is still gathering, lets hair slip through it, given the `bodies`.
    /// `read` writes the points of a strand [m] in world space into `points`, given its lane.
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
            points.iter_mut().for_each(|p| *p = pose.inverse_transform_point(*p));
            let out =
                |place: Vec3| pose.inverse_transform_point(bodies.out(pose.transform_point(place), 0.0));
            if !tie.slip(self.time, points, out, bonds) {
                bonds.iter_mut().for_each(|bond| bond.point = u32::MAX);
            }
        }
        self.bonds.0.retain(|bond| bond.point != u32::MAX);
    }
}

impl Validate for Manipulator {
    fn checks(&self) -> Vec<Check> {
        let (tool, checks) = match self {
            Self::Grab(grab) => ("grab", grab.checks()),
            Self::Comb(comb) => ("comb", comb.checks()),
            Self::Tie(tie) => ("tie", tie.checks()),
        };
        with_prefix(tool, checks).collect()
    }
}

impl Setting for Manipulator {
    const FIELDS: Fields =
        &[("grab", Grab::PARAMETERS), ("comb", Comb::PARAMETERS), ("tie", Tie::PARAMETERS)];

    fn table_checks(&self) -> Vec<Check> {
        self.checks()
    }
}
