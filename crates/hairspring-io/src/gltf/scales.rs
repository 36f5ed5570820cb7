//! Scales of joints that hair cannot follow: those of almost 0, and those with another sign than at rest.

use super::skeleton::Skeleton;
use glam::Vec3;
use hairspring::body::{Joint, Trs};
use std::collections::HashSet;

/// Smallest scale of a joint along each axis [1]. Animators scale an object to 0 to hide it.
const SMALLEST_SCALE: f32 = 1e-4;

/// The scales of an animation that hair cannot follow.
#[derive(Default)]
pub(super) struct Scales {
    /// Joints that it scales to almost 0.
    hidden: Found,
    /// Joints that it mirrors.
    mirrored: Found,
}

/// Joints, and the first of them with the time [s] when it is found.
#[derive(Default)]
struct Found {
    joints: HashSet<usize>,
    first: Option<(usize, f32)>,
}

impl Found {
    fn add(&mut self, joint: usize, time: f32) {
        self.joints.insert(joint);
        self.first.get_or_insert((joint, time));
    }

    /// The first joint and the number of others in a sentence, and the time [s].
    fn named(&self, skeleton: &Skeleton) -> Option<(String, f32)> {
        let (joint, time) = self.first?;
        let more = match self.joints.len() - 1 {
            0 => String::new(),
            n => format!(" and {n} more"),
        };
        Some((format!("the joint {:?}{more}", skeleton.joints[joint].name), time))
    }
}

impl Scales {
    /// Checks the last frame of `samples`, which is at `time` [s]. Joints whose scale is almost 0 get that of the frame before
    /// it, or 1.
    pub(super) fn check(&mut self, samples: &mut [Trs], joints: &[Joint], time: f32) {
        let joint_count = joints.len();
        let (earlier, last) = samples.split_at_mut(samples.len() - joint_count);
        for (joint, local) in last.iter_mut().enumerate() {
            if local.scale.abs().min_element() < SMALLEST_SCALE {
                let before = earlier.get(earlier.len().wrapping_sub(joint_count - joint));
                local.scale = before.map_or(Vec3::ONE, |before| before.scale);
                self.hidden.add(joint, time);
            }
            let is_mirrored = |local: &Trs| local.scale.element_product() < 0.0;
            // Hair is built on the rest pose.
            if is_mirrored(&joints[joint].rest) != is_mirrored(local) {
                self.mirrored.add(joint, time);
            }
        }
    }

    /// Notes about the scales of the animation with this name.
    pub(super) fn notes(&self, animation: &str, skeleton: &Skeleton) -> impl Iterator<Item = String> {
        let hidden = self.hidden.named(skeleton).map(|(joints, time)| {
            format!(
                "animation {animation:?} scales {joints} to 0 at {time:.2} s, which hair cannot follow; the scale before it is kept"
            )
        });
        let mirrored = self.mirrored.named(skeleton).map(|(joints, time)| {
            format!(
                "animation {animation:?} mirrors {joints} at {time:.2} s, because its scale has another sign than at rest; hair is not mirrored and may point into the body; keep the sign of the scale"
            )
        });
        hidden.into_iter().chain(mirrored)
    }
}
