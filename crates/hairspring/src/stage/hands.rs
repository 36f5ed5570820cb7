//! The scene's hands at work: each takes hold, moves and lets go when its settings say so, at the start of a frame.

use super::{
    StageError,
    body::{StagedBody, joint_of},
    hair::StagedHair,
};
use crate::{
    collide::Rigid,
    scene::{Hand, Scene},
    simulation::ToolId,
};

/// Where a hand is in its work.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Work {
    Before,
    /// With its tool in each groom's hair; grooms count alike.
    Now(ToolId),
    After,
}

/// All hands of a scene.
pub(super) struct StagedHands {
    work: Vec<Work>,
    /// Joint of each; `None`: the world.
    joints: Vec<Option<usize>>,
}

impl StagedHands {
    pub(super) fn new(scene: &Scene) -> Result<Self, StageError> {
        let joints = scene.hands.iter().map(|h| joint_of(scene, h.joint.as_deref(), "a hand"));
        Ok(Self { work: vec![Work::Before; scene.hands.len()], joints: joints.collect::<Result<_, _>>()? })
    }

    /// Back to before they began.
    pub(super) fn reset(&mut self) {
        self.work.fill(Work::Before);
    }

    /// Takes and lets go what is due at `time` [s], the body being posed for it.
    pub(super) fn begin(&mut self, hands: &[Hand], time: f32, body: &StagedBody, hair: &mut [StagedHair]) {
        for (k, hand) in hands.iter().enumerate() {
            if self.work[k] == Work::Before && hand.from <= time {
                let pose = self.pose(k, hand, time, body);
                let ids = hair.iter_mut().map(|hair| hair.take(hand.tool, pose));
                self.work[k] = ids.last().map_or(Work::After, Work::Now);
            }
            if let (Work::Now(id), Some(until)) = (self.work[k], hand.until)
                && until <= time
            {
                hair.iter_mut().for_each(|hair| hair.let_go(id));
                self.work[k] = Work::After;
            }
        }
    }

    /// Sends them to where they are at `time` [s], the end of a frame for which the body is posed.
    pub(super) fn advance(&self, hands: &[Hand], time: f32, body: &StagedBody, hair: &mut [StagedHair]) {
        for (k, hand) in hands.iter().enumerate() {
            if let Work::Now(id) = self.work[k] {
                let pose = self.pose(k, hand, time, body);
                hair.iter_mut().for_each(|hair| hair.carry(id, pose));
            }
        }
    }

    fn pose(&self, k: usize, hand: &Hand, time: f32, body: &StagedBody) -> Rigid {
        let joint = body.carried(self.joints[k]);
        Rigid { translation: joint.point(hand.moved(time)), ..joint }
    }
}
