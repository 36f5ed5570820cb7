//! Promise: the timeline goes back to any cached frame, and the scene plays on from there as it did before.
//! A range plays in a loop. A changed setting empties the cache, because its frames would not be played again.

mod support;

use glam::Vec3;
use hairspring_app::{Action, Document, Session, Snapshot};
use hairspring_scene::stage::Value;
use hairspring_test::farthest;
use std::sync::Arc;
use support::SMALL;

/// Largest difference of points that were played twice [m].
const SAME: f32 = 1e-6;

fn session() -> Session {
    let document = Document::new("scene.toml".as_ref(), SMALL.into()).unwrap();
    let mut session = Session::new(document, 2, None, || ()).unwrap();
    session.act(Action::Play(false)).unwrap();
    session.act(Action::Reset).unwrap();
    // Actions are done in order, so a snapshot with values is one after the reset.
    session.act(Action::Show(Some(Value::Speed))).unwrap();
    wait(&session, |s| s.frame == 0 && !s.stages[0].values.is_empty());
    session
}

fn wait(session: &Session, done: impl Fn(&Snapshot) -> bool) -> Arc<Snapshot> {
    for _ in 0..12_000 {
        if let Some(snapshot) = session.latest().filter(|s| s.scene == session.begun() && done(s)) {
            return snapshot;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("it did not happen within a minute");
}

fn step(session: &mut Session, to: u64) -> Arc<Snapshot> {
    let from = wait(session, |_| true).frame;
    (from..to).for_each(|_| session.act(Action::Step).unwrap());
    wait(session, |s| s.frame == to)
}

fn seek(session: &mut Session, frame: u64) -> Arc<Snapshot> {
    session.act(Action::Seek(frame)).unwrap();
    wait(session, |s| s.frame == frame)
}

fn points(snapshot: &Snapshot) -> Vec<Vec3> {
    snapshot.stages[0].points().flatten().copied().collect()
}

#[test]
fn a_cached_frame_is_restored_and_playback_continues_identically() {
    let mut session = session();
    let [early, late] = [12, 30].map(|frame| points(&step(&mut session, frame)));
    let shown = wait(&session, |s| s.frame == 30);
    assert_eq!(shown.cached.frames, (0..=30).collect::<Vec<_>>());
    assert!(shown.cached.bytes[0] > 0 && shown.cached.bytes[0] <= shown.cached.bytes[1]);
    let back = seek(&mut session, 12);
    assert!(farthest(&points(&back), &early) <= SAME, "another shape is shown");
    assert!((back.time - 0.2).abs() < 1e-9 && !session.playing());
    assert_eq!(back.cached.frames.last(), Some(&30), "later frames are forgotten");
    let again = points(&step(&mut session, 30));
    assert!(farthest(&again, &late) <= SAME, "the scene plays on otherwise: {} m", farthest(&again, &late));
}

#[test]
fn a_grab_is_cached_and_released_when_the_timeline_returns() {
    let mut session = session();
    let free = points(&step(&mut session, 30));
    seek(&mut session, 10);
    session.act(Action::Grab(Vec3::new(0.0, 1.5, -0.05), 0.2)).unwrap();
    session.act(Action::Carry(Vec3::new(0.3, 1.5, -0.05))).unwrap();
    let held = points(&step(&mut session, 20));
    let kept = wait(&session, |s| s.frame == 20);
    assert_eq!(kept.cached.frames.last(), Some(&20), "frames without the grab are still cached");
    seek(&mut session, 15);
    assert!(farthest(&points(&seek(&mut session, 20)), &held) <= SAME);
    seek(&mut session, 10);
    let again = points(&step(&mut session, 30));
    assert!(farthest(&again, &free) <= SAME, "the grab lasts: {} m", farthest(&again, &free));
}

#[test]
fn a_changed_setting_empties_the_cache() {
    let mut session = session();
    step(&mut session, 10);
    session
        .act(Action::Set("gravity".parse().unwrap(), Some([0.0, -1.0, 0.0].into_iter().collect())))
        .unwrap();
    let left = wait(&session, |s| s.cached.frames != (0..=10).collect::<Vec<_>>());
    assert_eq!(left.cached.frames, [10]);
}

#[test]
fn a_range_plays_in_a_loop() {
    let mut session = session();
    let there = points(&step(&mut session, 8));
    session.act(Action::Range(Some((8, 14)))).unwrap();
    session.act(Action::Play(true)).unwrap();
    let mut seen = std::collections::BTreeSet::new();
    wait(&session, |s| s.step > 60);
    session.act(Action::Play(false)).unwrap();
    for _ in 0..20 {
        session.act(Action::Step).unwrap();
        let snapshot = wait(&session, |_| true);
        seen.insert(snapshot.frame);
        std::thread::sleep(std::time::Duration::from_millis(30));
    }
    assert!(seen.iter().all(|frame| (8..=14).contains(frame)), "{seen:?}");
    assert!(farthest(&points(&seek(&mut session, 8)), &there) <= SAME);
    session.act(Action::Range(None)).unwrap();
    assert!(step(&mut session, 20).frame == 20);
}
