//! Hands of a scene: a manipulator with its motion and the time during which it acts.

use glam::Vec3;
use hairspring::settings::{Check, Validate, check, from_0};
use hairspring::{forces::Manipulator, math::find_keys};
use serde::{Deserialize, Serialize};

/// A hand with a manipulator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hand {
    /// The manipulator, in the space of the body's rest pose [m].
    pub tool: Manipulator,
    /// Name of the body joint that moves it; `None`: it is fixed in the world.
    #[serde(default)]
    pub joint: Option<String>,
    /// Displacement keys: time [s], then x, y, z [m], in the joint's space. Motion is linear between keys and
    /// constant before the first and after the last. Times must increase. Empty, the default: no motion.
    #[serde(default)]
    pub path: Vec<[f32; 4]>,
    /// Time at which it starts to act [s], 0 or more. Default 0.
    #[serde(default)]
    pub from: f32,
    /// Time at which it stops [s], after `from`; `None`, the default: never.
    #[serde(default)]
    pub until: Option<f32>,
}

impl Hand {
    /// Creates a hand that does not move and never stops acting.
    pub fn new(tool: Manipulator) -> Self {
        Self { tool, joint: None, path: Vec::new(), from: 0.0, until: None }
    }

    /// Returns the displacement at `time` [s].
    pub fn moved(&self, time: f64) -> Vec3 {
        let place = |k: usize| Vec3::from_slice(&self.path[k][1..]);
        let way = find_keys(self.path.len(), |k| self.path[k][0], time);
        way.map_or(Vec3::ZERO, |(a, b, share)| place(a).lerp(place(b), share))
    }
}

impl Validate for Hand {
    fn checks(&self) -> Vec<Check> {
        let finite = self.path.iter().flatten().all(|x| x.is_finite());
        let path = finite && self.path.windows(2).all(|w| w[0][0] < w[1][0]);
        let mut checks = vec![
            check(path, "path", "finite, with increasing times [s]"),
            check(from_0(self.from), "from", "0 or more [s]"),
            check(self.until.is_none_or(|t| t.is_finite() && t > self.from), "until", "after `from` [s]"),
        ];
        checks.extend(self.tool.checks());
        checks
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
