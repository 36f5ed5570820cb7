//! The bodies of a frame, as colliders for the wind and for the targets of manipulators.

use crate::collide::MovingCollider;
use crate::math::RigidTransform;
use glam::Vec3;

/// All colliders of a frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameColliders<'a> {
    colliders: &'a [MovingCollider],
    carried: Option<&'a RigidTransform>,
}

impl<'a> FrameColliders<'a> {
    /// Creates the set for hair that was moved rigidly by `carried` before the frame.
    pub fn new((colliders, carried): (&'a [MovingCollider], Option<&'a RigidTransform>)) -> Self {
        Self { colliders, carried }
    }

    /// Projects `place` out of the bodies at the start of the frame: to the nearest place that is at most
    /// `-clearance` deep. `clearance` is 0 or less [m].
    pub fn out(&self, place: Vec3, clearance: f32) -> Vec3 {
        self.colliders.iter().fold(place, |place, o| out_of(o, &o.start(self.carried), place, clearance))
    }

    /// Projects `place` out of the bodies at the end of the frame; see [`Self::out`].
    pub fn out_at_end(&self, place: Vec3, clearance: f32) -> Vec3 {
        self.colliders.iter().fold(place, |place, o| out_of(o, &o.end, place, clearance))
    }

    /// Distance from `place` to the nearest body at the start of the frame, below 0 inside [m].
    pub fn clearance(&self, place: Vec3) -> f32 {
        let distance =
            |o: &MovingCollider| o.shape.distance(o.start(self.carried).inverse_transform_point(place));
        self.colliders.iter().map(distance).fold(f32::INFINITY, f32::min)
    }
}

fn out_of(collider: &MovingCollider, pose: &RigidTransform, place: Vec3, clearance: f32) -> Vec3 {
    let (distance, normal) = collider.shape.distance_and_normal(pose.inverse_transform_point(place));
    place - pose.rotation * normal * (distance - clearance).min(0.0)
}
