//! What stands in the way of wind, and of where hair is pulled to, in a frame.

use crate::collide::MovingCollider;
use crate::math::RigidTransform;
use glam::Vec3;

/// All obstacles of a frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameColliders<'a> {
    obstacles: &'a [MovingCollider],
    carried: Option<&'a RigidTransform>,
}

impl<'a> FrameColliders<'a> {
    /// These obstacles, for hair that was `carried` along before the frame.
    pub fn new((obstacles, carried): (&'a [MovingCollider], Option<&'a RigidTransform>)) -> Self {
        Self { obstacles, carried }
    }

    /// `place` at the start of the frame, or the nearest that is no deeper in a body than `-clearance`, which is 0 or less [m].
    pub fn out(&self, place: Vec3, clearance: f32) -> Vec3 {
        self.obstacles.iter().fold(place, |place, o| out_of(o, &o.start(self.carried), place, clearance))
    }

    /// The same at its end.
    pub fn out_at_end(&self, place: Vec3, clearance: f32) -> Vec3 {
        self.obstacles.iter().fold(place, |place, o| out_of(o, &o.end, place, clearance))
    }

    /// Distance from `place` to the nearest body at the start of the frame, below 0 inside [m].
    pub fn clearance(&self, place: Vec3) -> f32 {
        let distance = |o: &MovingCollider| o.shape.distance(o.start(self.carried).inverse_point(place));
        self.obstacles.iter().map(distance).fold(f32::INFINITY, f32::min)
    }
}

fn out_of(obstacle: &MovingCollider, pose: &RigidTransform, place: Vec3, clearance: f32) -> Vec3 {
    let (distance, normal) = obstacle.shape.distance_and_normal(pose.inverse_point(place));
    place - pose.rotation * normal * (distance - clearance).min(0.0)
}
