//! A collider that moves during a frame.

use super::{ColliderPose, ColliderShape};
use crate::math::RigidTransform;

/// A collider and its pose at the start and the end of a frame.
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

    /// As it is at the end of the frame, having moved in all of it.
    pub fn now(&self) -> ColliderPose {
        ColliderPose::new(self.shape.clone(), self.start.matrix(), self.end.matrix(), 1.0)
    }

    /// Its start for hair that was carried along by `by` before the frame: the obstacle was too, or it was not, whichever leaves it less far to go.
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
