//! The head's motion: nods, turns to both sides, a shake, and a return to rest.

use super::bust::{CHEST, HEAD, NECK};
use glam::{EulerRot, Quat};
use hairspring::body::{Body, Clip, Trs, ease};
use std::f32::consts::TAU;

/// Frame rate [Hz].
const RATE: f32 = 60.0;
/// Duration [s].
const DURATION: f32 = 5.0;

/// A key: time [s], angle [degrees].
type Key = (f32, f32);

/// Nods: positive looks down. Within the neck's range of about 45° each way.
const PITCH: [Key; 10] = [
    (0.20, 0.0),
    (0.50, 17.0),
    (0.80, -9.0),
    (1.10, 13.0),
    (1.45, 0.0),
    (2.00, -4.0),
    (2.55, 5.0),
    (3.10, -4.0),
    (3.60, 3.0),
    (4.70, 0.0),
];
/// Turns: positive to the left. Within the neck's range of about 70°; peak speed under 250°/s.
const YAW: [Key; 7] =
    [(1.35, 0.0), (1.95, 50.0), (2.15, 50.0), (2.90, -46.0), (3.10, -46.0), (3.55, 0.0), (4.8, 0.0)];
/// Tilts of the head toward the shoulder: positive to the right.
const ROLL: [Key; 5] = [(1.35, 0.0), (2.00, -5.0), (2.95, 5.0), (3.55, 0.0), (4.8, 0.0)];
/// Start and end of the shake [s].
const SHAKE: (f32, f32) = (3.50, 4.75);
/// Amplitude of the shake [degrees]: a firm "no". The peak speed is 2π · 20° · 2.3 Hz = 290°/s.
const SWING: f32 = 20.0;
/// Frequency of the shake [Hz].
const SHAKE_RATE: f32 = 2.3;
/// Fractions of each angle taken by the chest, the neck and the head.
const SHARES: [(usize, f32); 3] = [(CHEST, 0.07), (NECK, 0.33), (HEAD, 0.60)];

/// Creates the motion of the bust's joints. The first and the last frame are the rest pose, without velocity.
pub fn clip(body: &Body) -> Clip {
    let rest = body.rest_pose();
    let frames = (DURATION * RATE) as usize + 1;
    let mut samples = Vec::with_capacity(frames * rest.len());
    for frame in 0..frames {
        let t = frame as f32 / RATE;
        let (yaw, pitch, roll) = (eased(&YAW, t) + shake(t), eased(&PITCH, t), eased(&ROLL, t));
        let mut pose: Vec<Trs> = rest.clone();
        for (joint, share) in SHARES {
            let [yaw, pitch, roll] = [yaw, pitch, roll].map(|a| (a * share).to_radians());
            pose[joint].rotation = Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
        }
        samples.extend(pose);
    }
    Clip { name: "nods, turns and a shake".into(), rate: f64::from(RATE), joint_count: rest.len(), samples }
}

/// Returns the shake's angle at `t` [s] in degrees: a sine with a smooth envelope.
fn shake(t: f32) -> f32 {
    let u = (t - SHAKE.0) / (SHAKE.1 - SHAKE.0);
    if !(0.0..=1.0).contains(&u) {
        return 0.0;
    }
    let window = ease((u * 4.0).min((1.0 - u) * 4.0).min(1.0));
    window * SWING * (TAU * SHAKE_RATE * (t - SHAKE.0)).sin()
}

/// Returns the angle between keys, with zero velocity and acceleration at each. It is 0 before the first key
/// and constant after the last.
fn eased(keys: &[Key], t: f32) -> f32 {
    let first = (0.0, 0.0);
    let mut before = first;
    for key in keys {
        if t < key.0 {
            return before.1 + (key.1 - before.1) * ease((t - before.0) / (key.0 - before.0));
        }
        before = *key;
    }
    before.1
}
