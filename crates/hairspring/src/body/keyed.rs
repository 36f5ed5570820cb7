//! Keyframed rigid motion of a body or of a separate prop.
//!
//! Two adjacent keys that are too far apart for the short time between them are a cut. It is found in the keys,
//! so it depends on no frame rate: the pose of the first key is held until the time of the second.

use super::{Clip, Trs, cuts::is_teleport};
use crate::math::{angle_between, find_keys};
use glam::{Quat, Vec3};

/// Frame rate of a keyed motion that has no other [Hz].
pub const KEYED_RATE: f64 = 60.0;

/// Longest interval between two keys that can be a cut [s]: a frame of 20 Hz, and the rounding of times to
/// milliseconds.
const MAX_CUT: f64 = 0.05 + 1e-3;

/// A time that is earlier than a key by less than this counts as that of the key [s].
const AT_KEY: f64 = 1e-4;

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

/// Returns the motion of a body's only joint through `keys`, which are in order of time, sampled at `rate`
/// [Hz]. Rotations are about `pivot` [m]. Before the first key, the pose is that of the first key. Without
/// keys, the body stays at rest. `teleport_distance` [m] decides which keys are cuts.
///
/// For an example, see [`body`](crate::body).
pub fn keyframe_clip(keys: &[Key], pivot: Vec3, rate: f64, teleport_distance: f32) -> Clip {
    let cuts: Vec<bool> = (1..keys.len()).map(|to| is_cut(keys, to, teleport_distance)).collect();
    let end = keys.last().map_or(0.0, |key| key.time);
    let frames = (f64::from(end) * rate).ceil() as usize + 1;
    let samples = (0..frames).map(|frame| at(keys, &cuts, pivot, frame as f64 / rate)).collect();
    Clip { name: "keys".into(), rate, joint_count: 1, samples }
}

/// Combines the motion of a body with that of separate props. `own` moves the first joints of the result;
/// `None` keeps them at `rest`. Each clip in `others` moves one more joint. The result is as long as the
/// longest clip; shorter clips hold their last frame.
///
/// ```
/// use glam::Vec3;
/// use hairspring::body::{KEYED_RATE, Trs, combine_clips, keyframe_clip};
///
/// // A body at rest, and a prop that is the second joint.
/// let prop = keyframe_clip(&[], Vec3::ZERO, KEYED_RATE, 1.0);
/// let clip = combine_clips(None, &[Trs::default()], &[prop]);
/// assert_eq!(clip.joint_count, 2);
/// ```
pub fn combine_clips(own: Option<Clip>, rest: &[Trs], others: &[Clip]) -> Clip {
    let still =
        || Clip { name: "keys".into(), rate: KEYED_RATE, joint_count: rest.len(), samples: rest.to_vec() };
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

/// Returns whether the body is placed at key `to` instead of moving there from the key before. Like a cut
/// between frames, it deviates too far from the motion before it and from that after it.
fn is_cut(keys: &[Key], to: usize, teleport_distance: f32) -> bool {
    let length = |to: usize| f64::from(keys[to].time) - f64::from(keys[to - 1].time);
    let dt = length(to);
    if dt > MAX_CUT {
        return false;
    }
    let motion = |to: usize| {
        let (a, b) = (&keys[to - 1], &keys[to]);
        let turn = b.rotation * a.rotation.inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        (b.position - a.position, turn)
    };
    let (moved, turn) = motion(to);
    // Outside the keys, and at two keys of the same time, the body has no velocity.
    let differs = |other: usize| {
        let (mut predicted, mut spin) = (Vec3::ZERO, Vec3::ZERO);
        if (1..keys.len()).contains(&other) && length(other) > 0.0 {
            let share = (dt / length(other)) as f32;
            let (moved, turn) = motion(other);
            (predicted, spin) = (moved * share, turn.to_scaled_axis() * share);
        }
        let turned = angle_between(turn, Quat::from_scaled_axis(spin));
        is_teleport((moved - predicted).length(), turned, teleport_distance, dt)
    };
    differs(to - 1) && differs(to + 1)
}

/// Returns the pose at `time` [s]. `cuts` tells for each interval between two keys whether it is a cut.
fn at(keys: &[Key], cuts: &[bool], pivot: Vec3, time: f64) -> Trs {
    let Some((a, b, share)) = find_keys(keys.len(), |k| keys[k].time, time) else {
        return Trs::default();
    };
    let (from, to) = (&keys[a], &keys[b]);
    let t = match a < b && cuts[a] {
        true => f32::from(f64::from(to.time) - time < AT_KEY),
        false => ease(share),
    };
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
        let clip = keyframe_clip(
            &[key(0.5, 0.0, 0.0), key(1.0, 0.2, 1.0), key(2.0, 0.0, 0.0)],
            pivot,
            KEYED_RATE,
            1.0,
        );
        assert_eq!((clip.frame_count(), clip.joint_count), (121, 1));
        for (time, x, turn) in
            [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.2, 1.0), (1.5, 0.1, 0.5), (3.0, 0.0, 0.0)]
        {
            let pose = clip.sample(time)[0];
            let pivoted = pose.to_affine().transform_point3(pivot);
            assert!(pivoted.distance(pivot + Vec3::X * x) < 1e-5, "{pivoted} at {time} s");
            assert!(angle_between(pose.rotation, Quat::from_rotation_z(turn)) < 1e-5, "{time} s");
        }
        assert_eq!(keyframe_clip(&[key(0.0, 1.0, 0.0)], pivot, KEYED_RATE, 1.0).frame_count(), 1);
        assert_eq!(keyframe_clip(&[], pivot, KEYED_RATE, 1.0).sample(1.0), [Trs::default()]);
    }

    #[test]
    fn adjacent_keys_that_are_too_far_apart_are_a_cut_at_any_rate() {
        let key = |(time, x, turn): (f32, f32, f32)| Key {
            time,
            position: Vec3::X * x,
            rotation: Quat::from_rotation_y(turn),
        };
        let cuts = |keys: &[(f32, f32, f32)]| -> Vec<usize> {
            let keys: Vec<Key> = keys.iter().copied().map(key).collect();
            (1..keys.len()).filter(|to| is_cut(&keys, *to, 1.0)).collect()
        };
        for start in [0.5, 0.505, 0.51, 0.52] {
            for dt in [0.0, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 30.0, 0.04, 0.041, 0.041_667, 0.042, 0.05] {
                let [rest, from] = [(0.0, 0.0, 0.0), (start, 0.0, 0.0)];
                assert_eq!(cuts(&[rest, from, (start + dt, 5.0, 0.0)]), [2], "{start} {dt}");
                assert_eq!(cuts(&[rest, from, (start + dt, 0.0, 3.0), (1.0, 0.1, 3.0)]), [2], "{start} {dt}");
                let back = [from, (start + dt, 5.0, 0.0), (start + 2.0 * dt, 0.0, 0.0)];
                assert_eq!(cuts(&back), [1, 2], "{start} {dt}");
            }
        }
        // Below the limits, slower, and a motion that accelerates over several keys.
        assert_eq!(cuts(&[(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.54, 0.9, 1.5)]), []);
        assert_eq!(cuts(&[(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.56, 5.0, 3.0)]), []);
        let ways = [0.0_f32, 0.3, 1.0, 2.2, 3.9, 5.7, 7.5];
        let ride: Vec<_> = ways.iter().zip(0_u8..).map(|(x, k)| (f32::from(k) / 24.0, *x, 0.0)).collect();
        assert_eq!(cuts(&ride), []);
    }

    #[test]
    fn a_cut_is_one_step_of_the_clip() {
        let key = |time: f32, x: f32| Key { time, position: Vec3::X * x, rotation: Quat::IDENTITY };
        for rate in [24.0, 30.0, 60.0, 120.0] {
            for (start, end) in [(0.5, 0.541), (0.51, 0.543), (0.52, 0.553), (0.5, 0.55)] {
                let clip =
                    keyframe_clip(&[key(0.0, 0.0), key(start, 0.0), key(end, 5.0)], Vec3::ZERO, rate, 1.0);
                let xs: Vec<f32> = clip.samples.iter().map(|pose| pose.translation.x).collect();
                let step = (f64::from(end) * rate - 0.01).ceil() as usize;
                assert!(xs[..step].iter().all(|x| *x == 0.0), "{start} to {end} at {rate} Hz: {xs:?}");
                assert!(xs[step..].iter().all(|x| *x == 5.0), "{start} to {end} at {rate} Hz: {xs:?}");
            }
        }
    }

    #[test]
    fn a_combined_clip_has_one_more_joint_for_each_prop() {
        let way = |end: f32| {
            let key = |time: f32, x: f32| Key { time, position: Vec3::X * x, rotation: Quat::IDENTITY };
            keyframe_clip(&[key(0.0, 0.0), key(end, end)], Vec3::ZERO, KEYED_RATE, 1.0)
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
