//! A collider that moves during a frame.

use super::{ColliderPose, ColliderShape};
use crate::math::{RigidTransform, nearer_start};

/// A collider with its pose at the start and at the end of a frame.
///
/// ```
/// use glam::Vec3;
/// use hairspring::{collide::{ColliderShape, MovingCollider}, math::RigidTransform};
///
/// let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.1 };
/// let (start, end) = (RigidTransform::IDENTITY, RigidTransform::from_translation(Vec3::X * 0.01));
/// let collider = MovingCollider::new(ball, start, end).with_user_data(42);
/// assert!(collider.end_pose().distance(Vec3::X * 0.01) < 0.0);
/// assert_eq!(collider.user_data, 42);
/// ```
#[derive(Clone, Debug)]
pub struct MovingCollider {
    /// The shape in its own space.
    pub shape: ColliderShape,
    /// Pose at the start.
    pub start: RigidTransform,
    /// Pose at the end.
    pub end: RigidTransform,
    /// Data of the user, such as an entity of the engine. The simulation does not read it.
    /// [`Simulation::contact_points`](crate::simulation::Simulation::contact_points) returns it. Default 0.
    pub user_data: u128,
}

impl MovingCollider {
    /// Creates a collider that moves from `start` to `end` during the frame.
    pub fn new(shape: ColliderShape, start: RigidTransform, end: RigidTransform) -> Self {
        Self { shape, start, end, user_data: 0 }
    }

    /// Creates a collider that stays at `pose`.
    pub fn at_rest(shape: ColliderShape, pose: RigidTransform) -> Self {
        Self::new(shape, pose, pose)
    }

    /// Sets [`Self::user_data`].
    pub fn with_user_data(self, user_data: u128) -> Self {
        Self { user_data, ..self }
    }

    /// Returns the pose at the end of the frame, with the motion of the whole frame.
    pub fn end_pose(&self) -> ColliderPose {
        ColliderPose::new(self.shape.clone(), self.start.matrix(), self.end.matrix(), 1.0)
    }

    /// Returns the start pose for hair that was moved rigidly by `by` before the frame; see [`nearer_start`].
    pub(crate) fn start(&self, by: Option<&RigidTransform>) -> RigidTransform {
        let Some(by) = by else { return self.start };
        nearer_start(self.start, *by * self.start, |from| {
            let turned = 1.0 - from.rotation.dot(self.end.rotation).abs();
            from.translation.distance_squared(self.end.translation) + turned
        })
    }
}
