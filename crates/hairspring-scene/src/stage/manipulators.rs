//! The scene's hands at work: each takes hold, moves and lets go when its settings say so, at the start of a frame.

use super::body::StagedBody;
use crate::Hand;
use hairspring::{
    math::RigidTransform,
    simulation::{ManipulatorId, Simulation},
};

/// Where a hand is in its work.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Work {
    Before,
    /// With its tool in the hair.
    Now(ManipulatorId),
    After,
}

/// All hands of a scene.
pub(super) struct StagedHands {
    work: Vec<Work>,
    /// Joint of each; `None`: the world.
    joints: Vec<Option<usize>>,
}

impl StagedHands {
    /// One for each of `joints`, before they begin.
    pub(super) fn new(joints: Vec<Option<usize>>) -> Self {
        Self { work: vec![Work::Before; joints.len()], joints }
    }

    /// Takes up the hands `now` in place of those `before`: a hand of the same settings goes on with its work, all others let go, and new ones are
    /// yet to begin.
    pub(super) fn update_settings(
        &mut self,
        (before, now): (&[Hand], &[Hand]),
        joints: Vec<Option<usize>>,
        hair: &mut Simulation,
    ) {
        let mut old: Vec<(&Hand, Work)> = before.iter().zip(self.work.drain(..)).collect();
        let going_on = |hand: &Hand| {
            let same = old.iter().position(|(before, _)| *before == hand);
            same.map_or(Work::Before, |k| old.remove(k).1)
        };
        self.work = now.iter().map(going_on).collect();
        self.joints = joints;
        for (_, work) in old {
            if let Work::Now(id) = work {
                hair.remove_manipulator(id);
            }
        }
    }

    /// Back to before they began.
    pub(super) fn reset(&mut self) {
        self.work.fill(Work::Before);
    }

    /// Takes and lets go what is due at `time` [s], the body being posed for it.
    pub(super) fn begin(&mut self, hands: &[Hand], time: f64, body: &StagedBody, hair: &mut Simulation) {
        // Rounded as the settings are: a hand that begins at 0.1 s begins in the frame at 6/60 s.
        let now = time as f32;
        for (k, hand) in hands.iter().enumerate() {
            if self.work[k] == Work::Before && hand.from <= now {
                let pose = self.pose(k, hand, time, body);
                self.work[k] = Work::Now(hair.add_manipulator(hand.tool, pose));
            }
            if let (Work::Now(id), Some(until)) = (self.work[k], hand.until)
                && until <= now
            {
                hair.remove_manipulator(id);
                self.work[k] = Work::After;
            }
        }
    }

    /// Sends them to where they are at `time` [s], the end of a frame for which the body is posed.
    pub(super) fn advance(&self, hands: &[Hand], time: f64, body: &StagedBody, hair: &mut Simulation) {
        for (k, hand) in hands.iter().enumerate() {
            if let Work::Now(id) = self.work[k] {
                let pose = self.pose(k, hand, time, body);
                hair.set_manipulator_pose(id, pose);
            }
        }
    }

    fn pose(&self, k: usize, hand: &Hand, time: f64, body: &StagedBody) -> RigidTransform {
        let joint = body.carried(self.joints[k]);
        RigidTransform { translation: joint.point(hand.moved(time)), ..joint }
    }
}
