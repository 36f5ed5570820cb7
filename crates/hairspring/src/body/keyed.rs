//! Motion by hand: a body that goes from key to key as one rigid piece.

use super::{Clip, Trs};
use glam::{Quat, Vec3};

/// Frames a second of the clip [Hz].
const RATE: f32 = 60.0;

/// Where a body is at a time. Between keys it moves as people do, and is at rest at each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// When [s], 0 or more.
    pub time: f32,
    /// How far from its rest pose it is [m].
    pub position: Vec3,
    /// How it is turned from its rest pose.
    pub rotation: Quat,
}

/// The motion of a body's only joint through keys in order of time, of which there is one at least; it turns about `pivot` [m]. Before the first key it
/// is as at the first.
pub fn keyed(keys: &[Key], pivot: Vec3) -> Clip {
    let end = keys.last().map_or(0.0, |key| key.time);
    let frames = (end * RATE).ceil() as usize + 1;
    let samples = (0..frames).map(|frame| at(keys, pivot, frame as f32 / RATE)).collect();
    Clip { name: "keys".into(), rate: RATE, joint_count: 1, samples }
}

fn at(keys: &[Key], pivot: Vec3, time: f32) -> Trs {
    let next = keys.partition_point(|key| key.time <= time);
    let [from, to] = [next.saturating_sub(1), next.min(keys.len() - 1)].map(|k| &keys[k]);
    let span = to.time - from.time;
    let t = if span > 0.0 { ease(((time - from.time) / span).clamp(0.0, 1.0)) } else { 0.0 };
    let rotation = from.rotation.slerp(to.rotation, t);
    let moved = from.position.lerp(to.position, t);
    Trs { translation: moved + pivot - rotation * pivot, rotation, scale: Vec3::ONE }
}

/// 0 to 1 with no speed nor acceleration at both ends (minimum jerk; Flash and Hogan 1985): how people move.
pub(crate) fn ease(t: f32) -> f32 {
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_at_its_keys_and_turns_about_its_pivot() {
        let key = |time: f32, x: f32, turn: f32| Key {
            time,
            position: Vec3::X * x,
            rotation: Quat::from_rotation_z(turn),
        };
        let pivot = Vec3::Y;
        let clip = keyed(&[key(0.5, 0.0, 0.0), key(1.0, 0.2, 1.0), key(2.0, 0.0, 0.0)], pivot);
        assert_eq!((clip.frame_count(), clip.joint_count), (121, 1));
        for (time, x, turn) in
            [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.2, 1.0), (1.5, 0.1, 0.5), (3.0, 0.0, 0.0)]
        {
            let pose = clip.sample(time)[0];
            let pivoted = pose.to_affine().transform_point3(pivot);
            assert!(pivoted.distance(pivot + Vec3::X * x) < 1e-5, "{pivoted} at {time} s");
            assert!(pose.rotation.angle_between(Quat::from_rotation_z(turn)) < 1e-3, "{time} s");
        }
        assert_eq!(keyed(&[key(0.0, 1.0, 0.0)], pivot).frame_count(), 1);
    }
}
