//! A collider that moves during a frame.

use super::{ColliderPose, ColliderShape};
use crate::math::RigidTransform;

/// A collider with its pose at the start and at the end of a frame.
#[derive(Clone)]
pub struct MovingCollider {
    /// The shape in its own space.
    pub shape: ColliderShape,
    /// Pose at the start.
    pub start: RigidTransform,
    /// Pose at the end.
    pub end: RigidTransform,
}

impl MovingCollider {
    /// A shape that stays at `pose`.
    pub fn at_rest(shape: ColliderShape, pose: RigidTransform) -> Self {
        Self { shape, start: pose, end: pose }
    }

    /// Returns the collider at the end of a frame throughout which it has moved.
    pub fn now(&self) -> ColliderPose {
        ColliderPose::new(self.shape.clone(), self.start.matrix(), self.end.matrix(), 1.0)
    }

    /// Returns the start pose for hair that was moved rigidly by `by` before the frame. The collider may or
    /// may not have moved with the hair; the start pose that is closer to the end pose is used.
    pub(crate) fn start(&self, by: Option<&RigidTransform>) -> RigidTransform {
        let Some(by) = by else { return self.start };
        let carried = by.after(&self.start);
        let far = |from: &RigidTransform| {
            let turned = 1.0 - from.rotation.dot(self.end.rotation).abs();
            from.translation.distance_squared(self.end.translation) + turned
        };
        if far(&carried) < far(&self.start) { carried } else { self.start }
    }
}
