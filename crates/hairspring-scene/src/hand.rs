//! Hands of a scene: what is held to the hair, from when to when, and how it moves.

use glam::Vec3;
use hairspring::{forces::Manipulator, math::between};
use serde::{Deserialize, Serialize};

/// A hand with a tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hand {
    /// What it holds to the hair, in the space of the body's rest pose [m].
    pub tool: Manipulator,
    /// Name of the body's joint that moves it; `None`: it stays in the world.
    #[serde(default)]
    pub joint: Option<String>,
    /// How far it has moved at a time: time [s], then x, y, z [m], in the joint's space; straight in between, at rest before the first and after the
    /// last. Times rise. Empty, the default: not at all.
    #[serde(default)]
    pub path: Vec<[f32; 4]>,
    /// When it takes hold [s], 0 or more. Default 0.
    #[serde(default)]
    pub from: f32,
    /// When it lets go [s], after `from`; `None`, the default: never.
    #[serde(default)]
    pub until: Option<f32>,
}

impl Hand {
    /// A hand that stays where it is and never lets go.
    pub fn new(tool: Manipulator) -> Self {
        Self { tool, joint: None, path: Vec::new(), from: 0.0, until: None }
    }

    /// How far it has moved at `time` [s].
    pub fn moved(&self, time: f64) -> Vec3 {
        let place = |k: usize| Vec3::from_slice(&self.path[k][1..]);
        let way = between(self.path.len(), |k| self.path[k][0], time);
        way.map_or(Vec3::ZERO, |(a, b, share)| place(a).lerp(place(b), share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring::forces::grab::Grab;

    #[test]
    fn a_path_is_straight_between_its_keys_and_still_outside() {
        let grab = Grab { center: Vec3::ZERO, radius: 0.1, pull: 60.0, damping: 1.0 };
        let mut hand = Hand::new(Manipulator::Grab(grab));
        assert_eq!(hand.moved(3.0), Vec3::ZERO);
        hand.path = vec![[1.0, 0.0, 0.0, 0.2], [2.0, 0.4, 0.0, 0.2], [4.0, 0.4, 1.0, 0.2]];
        for (time, at) in
            [(0.0, [0.0, 0.0, 0.2]), (1.5, [0.2, 0.0, 0.2]), (3.0, [0.4, 0.5, 0.2]), (9.0, [0.4, 1.0, 0.2])]
        {
            assert!(hand.moved(time).distance(Vec3::from(at)) < 1e-6, "{} at {time}", hand.moved(time));
        }
    }
}
