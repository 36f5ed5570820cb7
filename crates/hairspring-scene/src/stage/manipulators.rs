//! The scene's hands: each adds, moves and removes its manipulator according to its settings, at the start of
//! a frame.

use super::body::StagedBody;
use crate::Hand;
use hairspring::{
    math::RigidTransform,
    simulation::{ManipulatorId, Simulation},
};

/// State of a hand.
#[derive(Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum HandState {
    /// It has yet to begin.
    Before,
    /// Its manipulator is in use.
    Now(ManipulatorId),
    /// It has stopped.
    After,
}

/// All hands of a scene.
pub(super) struct StagedHands {
    work: Vec<HandState>,
    /// Joint of each; `None`: fixed in the world.
    joints: Vec<Option<usize>>,
}

impl StagedHands {
    /// Creates one hand for each of `joints`, before they begin.
    pub(super) fn new(joints: Vec<Option<usize>>) -> Self {
        Self { work: vec![HandState::Before; joints.len()], joints }
    }

    /// Replaces the hands `before` by `now`. A hand with the same settings keeps its state. Other old hands
    /// stop, and new ones have yet to begin.
    pub(super) fn update_settings(
        &mut self,
        (before, now): (&[Hand], &[Hand]),
        joints: Vec<Option<usize>>,
        hair: &mut Simulation,
    ) {
        let mut old: Vec<(&Hand, HandState)> = before.iter().zip(self.work.drain(..)).collect();
        let going_on = |hand: &Hand| {
            let same = old.iter().position(|(before, _)| *before == hand);
            same.map_or(HandState::Before, |k| old.remove(k).1)
        };
        self.work = now.iter().map(going_on).collect();
        self.joints = joints;
        for (_, work) in old {
            if let HandState::Now(id) = work {
                hair.remove_manipulator(id);
            }
        }
    }

    /// The state of each hand.
    pub(super) fn state(&self) -> &[HandState] {
        &self.work
    }

    /// Whether `state` is one of as many hands.
    pub(super) fn fits(&self, state: &[HandState]) -> bool {
        self.work.len() == state.len()
    }

    /// Returns to a state of [`StagedHands::state`], which fits.
    pub(super) fn set_state(&mut self, state: &[HandState]) {
        self.work.copy_from_slice(state);
    }

    /// Resets all hands to before they begin.
    pub(super) fn reset(&mut self) {
        self.work.fill(HandState::Before);
    }

    /// Adds and removes the manipulators that are due at `time` [s], with the body posed for that time.
    pub(super) fn begin(&mut self, hands: &[Hand], time: f64, body: &StagedBody, hair: &mut Simulation) {
        // Rounded like the settings: a hand that begins at 0.1 s begins in the frame at 6/60 s.
        let now = time as f32;
        for (k, hand) in hands.iter().enumerate() {
            if self.work[k] == HandState::Before && hand.from <= now {
                let pose = self.pose(k, hand, time, body);
                self.work[k] = HandState::Now(hair.add_manipulator(hand.tool, pose));
            }
            if let (HandState::Now(id), Some(until)) = (self.work[k], hand.until)
                && until <= now
            {
                hair.remove_manipulator(id);
                self.work[k] = HandState::After;
            }
        }
    }

    /// Sets the poses of the manipulators for `time` [s], the end of a frame for which the body is posed.
    pub(super) fn advance(&self, hands: &[Hand], time: f64, body: &StagedBody, hair: &mut Simulation) {
        for (k, hand) in hands.iter().enumerate() {
            if let HandState::Now(id) = self.work[k] {
                let pose = self.pose(k, hand, time, body);
                hair.set_manipulator_pose(id, pose);
            }
        }
    }

    fn pose(&self, k: usize, hand: &Hand, time: f64, body: &StagedBody) -> RigidTransform {
        let joint = body.pose().carried(self.joints[k]);
        RigidTransform { translation: joint.transform_point(hand.moved(time)), ..joint }
    }
}
