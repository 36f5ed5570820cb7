//! Keyframed rigid motion of a body or of a separate prop.

use super::{Clip, Trs};
use crate::math::find_keys;
use glam::{Quat, Vec3};

/// Frame rate of the clip [Hz].
const RATE: f64 = 60.0;

/// A keyframe of a rigid body. Motion between keys is eased and comes to rest at every key.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Time [s], 0 or more.
    pub time: f32,
    /// Translation from the rest pose [m].
    pub position: Vec3,
    /// Rotation from the rest pose.
    pub rotation: Quat,
}

/// Returns the motion of a body's only joint through `keys`, which are in order of time. Rotations are about
/// `pivot` [m]. Before the first key, the pose is that of the first key. Without keys, the body stays at
/// rest.
///
/// For an example, see [`body`](crate::body).
pub fn keyframe_clip(keys: &[Key], pivot: Vec3) -> Clip {
    let end = keys.last().map_or(0.0, |key| key.time);
    let frames = (f64::from(end) * RATE).ceil() as usize + 1;
    let samples = (0..frames).map(|frame| at(keys, pivot, frame as f64 / RATE)).collect();
    Clip { name: "keys".into(), rate: RATE, joint_count: 1, samples }
}

/// Combines the motion of a body with that of separate props. `own` moves the first joints of the result;
/// `None` keeps them at `rest`. Each clip in `others` moves one more joint. The result is as long as the
/// longest clip; shorter clips hold their last frame.
///
/// ```
/// use glam::Vec3;
/// use hairspring::body::{Trs, combine_clips, keyframe_clip};
///
/// // A body at rest, and a prop that is the second joint.
/// let prop = keyframe_clip(&[], Vec3::ZERO);
/// let clip = combine_clips(None, &[Trs::default()], &[prop]);
/// assert_eq!(clip.joint_count, 2);
/// ```
pub fn combine_clips(own: Option<Clip>, rest: &[Trs], others: &[Clip]) -> Clip {
    let still = || Clip { name: "keys".into(), rate: RATE, joint_count: rest.len(), samples: rest.to_vec() };
    let own = own.unwrap_or_else(still);
    let end = others.iter().map(Clip::duration).fold(own.duration(), f64::max);
    // The tolerance avoids an extra frame from rounding.
    let frames = (end * own.rate - 1e-3).ceil() as usize + 1;
    let all = || std::iter::once(&own).chain(others);
    let frame = |f: usize| all().flat_map(move |clip| clip.sample(f as f64 / own.rate));
    let (joint_count, samples) =
        (all().map(|clip| clip.joint_count).sum(), (0..frames).flat_map(frame).collect());
    Clip { name: own.name.clone(), rate: own.rate, joint_count, samples }
}

fn at(keys: &[Key], pivot: Vec3, time: f64) -> Trs {
    let Some((from, to, share)) = find_keys(keys.len(), |k| keys[k].time, time) else {
        return Trs::default();
    };
    let (from, to, t) = (&keys[from], &keys[to], ease(share));
    let rotation = from.rotation.slerp(to.rotation, t);
    let moved = from.position.lerp(to.position, t);
    Trs { translation: moved + pivot - rotation * pivot, rotation, scale: Vec3::ONE }
}

/// Smooth step from 0 to 1 with zero velocity and acceleration at both ends: the minimum-jerk profile of
/// human motion (Flash and Hogan 1985).
///
/// ```
/// use hairspring::body::ease;
///
/// assert_eq!([ease(0.0), ease(0.5), ease(1.0)], [0.0, 0.5, 1.0]);
/// ```
pub fn ease(t: f32) -> f32 {
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
        let clip = keyframe_clip(&[key(0.5, 0.0, 0.0), key(1.0, 0.2, 1.0), key(2.0, 0.0, 0.0)], pivot);
        assert_eq!((clip.frame_count(), clip.joint_count), (121, 1));
        for (time, x, turn) in
            [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.2, 1.0), (1.5, 0.1, 0.5), (3.0, 0.0, 0.0)]
        {
            let pose = clip.sample(time)[0];
            let pivoted = pose.to_affine().transform_point3(pivot);
            assert!(pivoted.distance(pivot + Vec3::X * x) < 1e-5, "{pivoted} at {time} s");
            assert!(pose.rotation.angle_between(Quat::from_rotation_z(turn)) < 1e-3, "{time} s");
        }
        assert_eq!(keyframe_clip(&[key(0.0, 1.0, 0.0)], pivot).frame_count(), 1);
        assert_eq!(keyframe_clip(&[], pivot).sample(1.0), [Trs::default()]);
    }

    #[test]
    fn a_combined_clip_has_one_more_joint_for_each_prop() {
        let way = |end: f32| {
            let key = |time: f32, x: f32| Key { time, position: Vec3::X * x, rotation: Quat::IDENTITY };
            keyframe_clip(&[key(0.0, 0.0), key(end, end)], Vec3::ZERO)
        };
        let rest = [Trs { translation: Vec3::Y, ..Trs::default() }];
        let own = Clip { name: "own".into(), rate: 30.0, joint_count: 1, samples: [rest[0]; 16].into() };
        for own in [None, Some(own)] {
            let clip = combine_clips(own, &rest, &[way(1.0), way(2.0)]);
            assert_eq!(
                (clip.joint_count, clip.frame_count()),
                (3, 1 + (2.0 * clip.rate) as usize),
                "{}",
                clip.name
            );
            for (time, x) in [(0.0, [0.0, 0.0]), (0.5, [0.5, 0.207]), (1.5, [1.0, 1.793]), (9.0, [1.0, 2.0])]
            {
                let pose = clip.sample(time);
                assert_eq!(pose[0], rest[0]);
                for (k, x) in x.into_iter().enumerate() {
                    assert!((pose[k + 1].translation.x - x).abs() < 2e-3, "{k} at {time} s: {pose:?}");
                }
            }
        }
    }
}
