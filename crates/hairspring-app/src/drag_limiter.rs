//! Limits the motion of what the pointer drags to that of a person: no faster than an arm. An open hand turns
//! its palm to the head and its fingers perpendicular to the stroke.

use crate::{player::STEP, pointer_collider::Pushed};
use glam::{Mat3, Quat, Vec3};
use hairspring::{collide::ColliderShape, math::RigidTransform};
use hairspring_scene::stage::PosedBody;

/// Maximum speed of a dragged tool or pushed object [m/s]: that of a throwing hand. If steps take longer than
/// real time, the pointer is correspondingly faster in the scene than on the desk.
pub const FASTEST: f32 = 4.0;

/// Maximum speed of an open hand [m/s]: a quick stroke. If steps take long, four meters per second would act
/// as a blow that ruffles the hair.
pub const FASTEST_STROKE: f32 = 1.5;

/// Maximum speed of the head [m/s]: a head that is shaken hard.
pub const FASTEST_HEAD: f32 = 1.5;

/// Rate at which a hand assumes its orientation [1/s]: within a fifth of a second.
const TURN: f32 = 12.0;

/// Weight of the last step's motion in the stroke direction [1].
const STROKE: f32 = 0.15;

/// Speed below which a stroke turns the fingers only partially [m/s].
const SLOW: f32 = 0.3;

/// Space for hair between the hand and the skin, relative to the hand's length [1]: 5 mm.
const ROOM: f32 = 0.03;

/// Distance over which the skin is averaged to a plane under the palm, relative to the hand's length [1].
const PALM: f32 = 0.2;

/// An object that follows the pointer.
#[derive(Clone, Copy, Default)]
pub struct Pulled {
    /// The current pose.
    pub now: RigidTransform,
    /// The pose of the pointer.
    pub wanted: RigidTransform,
}

impl Pulled {
    /// Creates an object that is grabbed at `pose`.
    pub fn at(pose: RigidTransform) -> Self {
        Self { now: pose, wanted: pose }
    }

    /// Whether the object is, or is going, away from where it would be by itself.
    pub fn acts(&self) -> bool {
        [self.now, self.wanted].iter().any(|pose| *pose != RigidTransform::default())
    }

    /// Advances by one step, with at most `fastest` [m/s]. Returns whether the object moved.
    pub fn go(&mut self, fastest: f32) -> bool {
        let way = self.wanted.translation - self.now.translation;
        let moved = self.now != self.wanted;
        let translation = self.now.translation + way.clamp_length_max(fastest * STEP);
        self.now = RigidTransform { translation, ..self.wanted };
        moved
    }
}

/// A request to push an object, and the orientation of the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// A ball or a hand.
    pub what: Pushed,
    /// Center of the object at the pointer [m].
    pub at: Vec3,
    /// The right and the up direction of the picture.
    pub axes: [Vec3; 2],
}

/// The object that is being pushed.
pub struct Pushing {
    push: Push,
    pulled: Pulled,
    /// Colliders of `push.what`, in its own space.
    shapes: Vec<ColliderShape>,
    /// Distance by which a hand is lifted off the skin [m].
    lift: f32,
    /// Velocity of the stroke, averaged over a few steps [m/s].
    stroke: Vec3,
}

impl Pushing {
    /// Creates the object over this body.
    pub fn new(push: Push, body: Option<PosedBody>) -> Self {
        let (shapes, mut place) =
            (push.what.shapes(), RigidTransform { translation: push.at, ..RigidTransform::default() });
        if let Pushed::Hand(length) = push.what {
            let back = back(&push, length, push.at, body);
            place.rotation = turned(push.axes[0], back);
            place.translation += back * lift(&shapes, place, length, body);
        }
        Self { shapes, push, pulled: Pulled::at(place), lift: 0.0, stroke: Vec3::ZERO }
    }

    /// Updates the target of the pointer.
    pub fn want(&mut self, push: Push) {
        if push.what != self.push.what {
            self.shapes = push.what.shapes();
        }
        self.push = push;
    }

    /// The colliders of the object, and their pose.
    pub fn placed(&self) -> (&[ColliderShape], RigidTransform) {
        (&self.shapes, self.pulled.now)
    }

    /// The object and its pose, for drawing.
    pub fn shown(&self) -> (Pushed, RigidTransform) {
        (self.push.what, self.pulled.now)
    }

    /// Advances by one step over this body. Returns whether the object moved.
    pub fn go(&mut self, body: Option<PosedBody>) -> bool {
        let before = self.pulled.now;
        self.pulled.wanted = RigidTransform { translation: self.push.at, ..before };
        if let Pushed::Hand(length) = self.push.what {
            // Each step is limited in length, so that the hand cannot pass through to the other side of the
            // head.
            let way = (self.push.at - before.translation).clamp_length_max(FASTEST_STROKE * STEP);
            let back = back(&self.push, length, before.translation + way, body);
            let speed = self.stroke.length();
            let across = back.cross(self.stroke).normalize_or_zero();
            let fingers = before.rotation * Vec3::Y;
            let across = if across.dot(fingers) < 0.0 { -across } else { across };
            let share = if across == Vec3::ZERO { 0.0 } else { (speed / SLOW).min(1.0) };
            let wanted = turned(fingers.lerp(across, share), back);
            let place = RigidTransform {
                rotation: before.rotation.slerp(wanted, soon(TURN)),
                translation: before.translation + way,
            };
            // It descends more slowly than it rises, so that it glides over a nose instead of dropping behind
            // it.
            self.lift = (self.lift * (1.0 - soon(TURN))).max(lift(&self.shapes, place, length, body));
            self.pulled.wanted =
                RigidTransform { translation: place.translation + back * self.lift, ..place };
        }
        let fastest = if let Pushed::Hand(_) = self.push.what { FASTEST_STROKE } else { FASTEST };
        let moved = self.pulled.go(fastest);
        self.stroke += STROKE * ((self.pulled.now.translation - before.translation) / STEP - self.stroke);
        moved
    }
}

/// Fraction of the remaining distance that is covered in a step at this rate [1/s].
fn soon(rate: f32) -> f32 {
    1.0 - (-rate * STEP).exp()
}

/// A hand that points along `fingers` as far as possible with its back toward `back`.
fn turned(fingers: Vec3, back: Vec3) -> Quat {
    let fingers = fingers.reject_from_normalized(back).try_normalize();
    let fingers = fingers.unwrap_or_else(|| back.any_orthonormal_vector());
    Quat::from_mat3(&Mat3::from_cols(fingers.cross(back), fingers, back)).normalize()
}

/// Direction of the back of a hand with its center at `p`: away from the skin near it, otherwise toward the
/// viewer.
fn back(push: &Push, length: f32, p: Vec3, body: Option<PosedBody>) -> Vec3 {
    let viewer = push.axes[0].cross(push.axes[1]).normalize_or(Vec3::Z);
    let Some((nearest, normal)) = body.and_then(|body| skin(&body, p, PALM * length)) else { return viewer };
    // The hand begins to turn at a distance of its length, and lies flat at half of it.
    let near = (2.0 - 2.0 * p.distance(nearest) / length).clamp(0.0, 1.0);
    viewer.lerp(normal, near * near * (3.0 - 2.0 * near)).normalize_or(normal)
}

/// Distance by which a hand with these shapes at `place` must be lifted, so that hair has space under its
/// joints [m].
fn lift(shapes: &[ColliderShape], place: RigidTransform, length: f32, body: Option<PosedBody>) -> f32 {
    let Some(body) = body else { return 0.0 };
    // Vertices farther away than the hand's length cannot touch it.
    let skin: Vec<(Vec3, Vec3)> = body
        .positions
        .iter()
        .zip(body.normals)
        .filter(|(q, _)| q.distance_squared(place.translation) < length * length)
        .map(|(q, n)| (*q, *n))
        .collect();
    let joints = shapes.iter().flat_map(|shape| match shape {
        ColliderShape::Capsule { a, b, radius } => vec![(*a, *radius), (*b, *radius)],
        _ => Vec::new(),
    });
    let missing = joints.filter_map(|(joint, radius)| {
        let p = place.transform_point(joint);
        let away = |q: &Vec3| q.distance_squared(p);
        let (q, n) = skin.iter().min_by(|a, b| away(&a.0).total_cmp(&away(&b.0)))?;
        Some(radius + ROOM * length - (p - *q).dot(*n))
    });
    missing.fold(0.0, f32::max)
}

/// The point of a body that is nearest to `p`, and the mean normal around it, weighted by a Gaussian of width
/// `size` [m]; `None` if there is no vertex.
fn skin(body: &PosedBody, p: Vec3, size: f32) -> Option<(Vec3, Vec3)> {
    let away = |q: &Vec3| q.distance_squared(p);
    let nearest =
        *body.positions.iter().filter(|q| q.is_finite()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let (least, scale) = (away(&nearest), -0.5 / (size * size));
    let mut normal = Vec3::ZERO;
    for (q, n) in body.positions.iter().zip(body.normals) {
        let power = scale * (away(q) - least);
        // Normals farther away than four widths are ignored.
        if power > -8.0 {
            normal += *n * power.exp();
        }
    }
    Some((nearest, normal.try_normalize()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairspring::{body::Mesh, math::angle_between};
    use hairspring_scene::builtin::Hand;

    const LENGTH: f32 = Hand::LENGTH;

    /// A head: a sphere of 9 cm around the origin.
    fn head() -> Mesh {
        let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
        let on = |k: usize| {
            let y = 1.0 - (2.0 * k as f32 + 1.0) / 4000.0;
            let (sin, cos) = (golden * k as f32).sin_cos();
            Vec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin)
        };
        let normals: Vec<Vec3> = (0..4000).map(on).collect();
        Mesh { positions: normals.iter().map(|n| *n * 0.09).collect(), normals, ..Mesh::default() }
    }

    fn posed(mesh: &Mesh) -> PosedBody<'_> {
        PosedBody { mesh, positions: &mesh.positions, normals: &mesh.normals }
    }

    fn push(at: Vec3) -> Push {
        Push { what: Pushed::Hand(LENGTH), at, axes: [Vec3::X, Vec3::Y] }
    }

    #[test]
    fn a_hand_away_from_the_body_shows_its_back_and_points_sideways() {
        let hand = Pushing::new(push(Vec3::Z), None).pulled.now;
        assert!((hand.rotation * Vec3::Z).distance(Vec3::Z) < 1e-6, "its back is seen");
        assert!((hand.rotation * Vec3::Y).distance(Vec3::X) < 1e-6, "fingers to the right");
        assert!((hand.rotation * Vec3::NEG_X).distance(Vec3::Y) < 1e-6, "the thumb on top");
    }

    #[test]
    fn a_hand_moves_around_a_head_with_its_palm_toward_it_and_limited_speed() {
        let head = head();
        let mut pushing = Pushing::new(push(Vec3::new(0.0, 0.0, 0.12)), Some(posed(&head)));
        // Straight through the head, from its front to beyond its side, in one move.
        let beyond = Vec3::new(0.3, 0.0, 0.03);
        pushing.want(push(beyond));
        let mut last = pushing.pulled.now;
        for step in 0..40 {
            pushing.go(Some(posed(&head)));
            let now = pushing.pulled.now;
            let way = now.translation.distance(last.translation);
            assert!(way < FASTEST_STROKE * STEP * 1.001, "step {step}: {way} m");
            let turn = angle_between(now.rotation, last.rotation);
            assert!(turn * 0.7 * LENGTH < FASTEST * STEP, "step {step}: {turn} rad");
            let off = now.translation.length() - 0.09;
            assert!(off > 0.01, "step {step}: its middle is {off} m off the skin");
            let leaning = (now.rotation * Vec3::Z).dot(now.translation.normalize());
            assert!(off > 0.05 || leaning > 0.8, "step {step}: its back looks {leaning} outward");
            last = now;
        }
        assert!(last.translation.distance(beyond) < 1e-3, "it came to {}", last.translation);
    }

    #[test]
    fn the_fingers_of_a_hand_turn_across_the_stroke() {
        for (way, along) in
            [(Vec3::NEG_Y, Vec3::X), (Vec3::X, Vec3::Y), (Vec3::new(1.0, -1.0, 0.0), Vec3::ONE)]
        {
            let mut pushing = Pushing::new(push(Vec3::Z), None);
            for step in 0..60 {
                pushing.want(push(Vec3::Z + way * (0.01 * step as f32)));
                pushing.go(None);
            }
            let fingers = pushing.pulled.now.rotation * Vec3::Y;
            let along = (along * Vec3::new(1.0, 1.0, 0.0)).normalize();
            assert!(fingers.dot(along).abs() > 0.99, "{way}: {fingers}");
            assert!((pushing.pulled.now.rotation * Vec3::Z).distance(Vec3::Z) < 1e-4);
        }
    }
}
