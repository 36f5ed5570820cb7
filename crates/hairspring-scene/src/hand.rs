//! Hands of a scene: a manipulator with its motion and the time during which it acts.

use glam::Vec3;
use hairspring::{forces::Manipulator, math::find_keys, settings::define_settings};

define_settings! {
    /// A hand with a manipulator.
    #[derive(Clone, Debug, PartialEq)]
    entry struct Hand {
        /// The manipulator, in the space of the body's rest pose [m].
        tool: Manipulator, "none", {table};
        /// Name of the body joint that moves the hand.
        #[serde(default)]
        joint: Option<String>, "none", {text "the name of a joint of the body"}, default "fixed in the world";
        /// Displacement keys: time [s], then x, y, z [m], in the joint's space. Motion is linear between keys and
        /// constant before the first and after the last.
        #[serde(default)]
        path: Vec<[f32; 4]> = Vec::new(), "s, m", {
            check |hand| hand.path_is_valid() => "finite, with increasing times [s]"
        };
        /// Time at which the hand starts to act.
        #[serde(default)]
        from: f32 = 0.0, ["s"], {0 or more};
        /// Time at which the hand stops.
        #[serde(default)]
        until: Option<f32>, ["s"], {
            check |hand| hand.until.is_none_or(|t| t.is_finite() && t > hand.from) => "after `from`"
        }, default "never";
    }
}

impl Hand {
    /// Returns whether the keys are finite, with increasing times.
    fn path_is_valid(&self) -> bool {
        let finite = self.path.iter().flatten().all(|x| x.is_finite());
        finite && self.path.windows(2).all(|w| w[0][0] < w[1][0])
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring::forces::grab::Grab;

    #[test]
    fn a_path_is_linear_between_its_keys_and_constant_outside() {
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
