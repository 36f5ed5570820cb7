//! The scene's charged bodies at their current poses.

use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    forces::charge::{Charged, ChargedBall},
    math::RigidTransform,
};

/// Charged bodies in motion.
#[derive(Default)]
pub(super) struct StagedCharged {
    /// The joint that carries each; `None`: fixed.
    joints: Vec<Option<usize>>,
    balls: Vec<ChargedBall>,
}

impl StagedCharged {
    /// Creates the charged bodies at rest, each carried by one of `joints`.
    pub(super) fn new(settings: &[Charged], joints: Vec<Option<usize>>) -> Self {
        let balls = settings.iter().map(|c| ChargedBall {
            radius: c.radius,
            charge: c.charge,
            ..ChargedBall::default()
        });
        Self { joints, balls: balls.collect() }
    }

    /// Returns colliders for the solid ones, in order.
    pub(super) fn colliders(&self, settings: &[Charged]) -> Vec<MovingCollider> {
        let solid = settings.iter().filter(|c| c.solid);
        let ball = |c: &Charged| {
            let shape = ColliderShape::Sphere { center: Vec3::ZERO, radius: c.radius };
            MovingCollider::at_rest(shape, RigidTransform::default())
        };
        solid.map(ball).collect()
    }

    /// Starts a new frame where the last one ended.
    pub(super) fn rest(&mut self) {
        for ball in &mut self.balls {
            ball.centers[0] = ball.centers[1];
        }
    }

    /// Moves the start of balls on joints that have a cut, and the `colliders` of the solid ones, across the
    /// cut. `by` returns the rigid motion of a joint due to the cut.
    pub(super) fn cut(
        &mut self,
        settings: &[Charged],
        by: impl Fn(usize) -> Option<RigidTransform>,
        colliders: &mut [MovingCollider],
    ) {
        let mut colliders = colliders.iter_mut();
        for ((ball, charged), joint) in self.balls.iter_mut().zip(settings).zip(&self.joints) {
            let collider = if charged.solid { colliders.next() } else { None };
            let Some(by) = joint.and_then(&by) else { continue };
            ball.centers[0] = by.transform_point(ball.centers[0]);
            if let Some(collider) = collider {
                collider.start = by * collider.start;
            }
        }
    }

    /// Updates the end positions for a frame that ends at `time` [s], and those of the `colliders` of solid
    /// ones. `carried` returns the motion of a joint since rest.
    pub(super) fn advance(
        &mut self,
        settings: &[Charged],
        time: f64,
        carried: impl Fn(Option<usize>) -> RigidTransform,
        colliders: &mut [MovingCollider],
    ) {
        let mut colliders = colliders.iter_mut();
        for ((ball, charged), joint) in self.balls.iter_mut().zip(settings).zip(&self.joints) {
            let pose = carried(*joint);
            ball.centers[1] = pose.transform_point(charged.center(time));
            if charged.solid
                && let Some(collider) = colliders.next()
            {
                collider.end = RigidTransform { translation: ball.centers[1], ..pose };
            }
        }
    }

    /// Returns all charged balls, with their motion in the last frame.
    pub(super) fn balls(&self) -> &[ChargedBall] {
        &self.balls
    }
}
