//! Promise: the hand tool strokes a head of hair. Hair gives way, and neither simulated nor follow hair
//! penetrates the hand. The hand collides where it is drawn, and its speed is limited. Releasing it removes
//! it, and the hair returns to where it was.

mod support;

use glam::Vec3;
use hairspring::math::RigidTransform;
use hairspring_app::{Action, Document, Push, Pushed, Session};
use hairspring_test::farthest;
use support::SMALL;

const LENGTH: f32 = hairspring_scene::builtin::Hand::LENGTH;

/// The state after a step: the pushed collider and its pose, all points [m], the deepest penetration into
/// the collider [m], and the number of colliders.
struct Seen {
    pushed: Option<(Pushed, RigidTransform)>,
    points: Vec<Vec3>,
    depth: f32,
    colliders: usize,
}

/// A paused session that advances only by explicit steps.
fn still() -> Session {
    let document = Document::new("scene.toml".as_ref(), SMALL.into()).unwrap();
    let mut session = Session::new(document, 2, None, || ()).unwrap();
    session.act(Action::Play(false)).unwrap();
    // A scene that is opened while the session is paused stays at its first frame.
    session.act(Action::New(SMALL.into())).unwrap();
    session
}

/// Runs one step with this push.
fn step(session: &mut Session, number: u64, push: Option<Push>) -> Seen {
    session.act(Action::Push(push)).unwrap();
    session.act(Action::Step).unwrap();
    for _ in 0..6000 {
        let Some(now) = session.latest().filter(|s| s.scene == session.begun() && s.step == number) else {
            std::thread::sleep(std::time::Duration::from_millis(2));
            continue;
        };
        let stage = &now.stages[0];
        let count = stage.pushed.map_or(0, |(what, _)| what.shapes().len());
        let hand: Vec<_> =
            stage.colliders[stage.colliders.len() - count..].iter().map(|o| o.end_pose()).collect();
        let points: Vec<Vec3> = stage.points().flatten().copied().collect();
        let deep = |p: &Vec3| hand.iter().map(|s| -s.distance(*p)).fold(0.0, f32::max);
        let depth = points.iter().map(deep).fold(0.0, f32::max);
        return Seen { pushed: stage.pushed, points, depth, colliders: stage.colliders.len() };
    }
    panic!("step {number} was not reached");
}

#[test]
fn hair_gives_way_to_the_hand_without_penetration() {
    let [mut stroked, mut alone] = [still(), still()];
    // From the temple over the ear to the back of the head.
    let way = |k: u64| Vec3::new(-0.105, 0.05 - 0.001 * k as f32, 0.07 - 0.004 * k as f32);
    let push = |k: u64| Push { what: Pushed::Hand(LENGTH), at: way(k), axes: [Vec3::X, Vec3::Y] };
    let bare = step(&mut alone, 1, None).colliders;
    let mut last: Option<RigidTransform> = None;
    let (mut deepest, mut moved) = (0f32, 0f32);
    for k in 1..=40 {
        let seen = step(&mut stroked, k, Some(push(k)));
        let other = if k == 1 { None } else { Some(step(&mut alone, k, None)) };
        let (what, pose) = seen.pushed.expect("the hand is missing");
        assert_eq!(what, Pushed::Hand(LENGTH));
        assert_eq!(seen.colliders, bare + what.shapes().len());
        if let Some(last) = last {
            let way = pose.translation.distance(last.translation);
            assert!(way < 1.5 / 60.0 + 1e-6, "step {k}: {way} m");
        }
        deepest = deepest.max(seen.depth);
        if let Some(other) = other {
            moved = moved.max(farthest(&seen.points, &other.points));
        }
        last = Some(pose);
    }
    assert!(deepest < 1e-4, "hair penetrates the hand by {deepest} m");
    assert!(moved > 0.1, "hair gave way by {moved} m");
    let mut left = 0.0;
    for k in 41..=160 {
        let (seen, other) = (step(&mut stroked, k, None), step(&mut alone, k, None));
        assert!(seen.pushed.is_none() && seen.colliders == bare, "the released hand is still in the scene");
        left = seen.points.iter().zip(&other.points).map(|(a, b)| a.distance(*b)).sum::<f32>()
            / seen.points.len() as f32;
    }
    assert!(left < 1e-3, "the mean offset two seconds later is {left} m");
}
