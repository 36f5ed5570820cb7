//! Promise: a stage returns to a state that was copied earlier, and plays on as it did from there, also on
//! another stage of the same scene. A grab, a hand of the scene and a moved body are part of the state.

use crate::support::{play, points};
use glam::Vec3;
use hairspring::{
    forces::{Manipulator, grab::Grab},
    math::RigidTransform,
};
use hairspring_scene::{
    Guides, Hand, Scene,
    builtin::{BuiltinOptions, scene as builtin},
    stage::Stage,
};
use hairspring_test::farthest;

/// Largest difference of points that were played twice [m]. The distance field of a moving body is built anew.
const SAME: f32 = 1e-6;

fn grab(radius: f32) -> Manipulator {
    Manipulator::Grab(Grab { center: Vec3::ZERO, radius, pull: 60.0, damping: 1.0 })
}

fn head() -> Scene {
    let options = BuiltinOptions { strands: 60, guides: Guides::All, ..BuiltinOptions::default() };
    let hand = Hand { from: 0.2, until: Some(0.5), ..Hand::new(grab(0.05)) };
    Scene { hands: vec![hand], ..builtin(&options) }
}

#[test]
fn playback_from_a_restored_state_repeats_the_earlier_one() {
    let mut stage = Stage::new(head()).unwrap();
    play(&mut stage, 10);
    stage.move_body(RigidTransform { translation: Vec3::X * 0.02, ..RigidTransform::default() });
    stage.add_manipulator(
        grab(0.1),
        RigidTransform { translation: Vec3::Y * 1.6, ..RigidTransform::default() },
    );
    play(&mut stage, 10);
    let (state, then) = (stage.state(), points(&stage));
    let time = stage.time();
    play(&mut stage, 30);
    let after = points(&stage);
    let mut other = Stage::new(head()).unwrap();
    for stage in [&mut stage, &mut other] {
        stage.restore(&state).unwrap();
        assert_eq!(stage.time(), time);
        assert!(farthest(&points(stage), &then) <= SAME, "the restored hair is elsewhere");
        play(stage, 30);
        let off = farthest(&points(stage), &after);
        assert!(off <= SAME, "after the restored state, hair moves elsewhere: {off} m");
    }
    assert!(state.bytes() > 60 * 3 * size_of::<Vec3>());
}

#[test]
fn a_state_of_other_hair_is_refused_and_changes_nothing() {
    let state = Stage::new(head()).unwrap().state();
    let fewer = BuiltinOptions { strands: 20, guides: Guides::All, ..BuiltinOptions::default() };
    for scene in [builtin(&fewer), Scene { hands: Vec::new(), ..head() }] {
        let mut stage = Stage::new(scene).unwrap();
        play(&mut stage, 3);
        let before = (points(&stage), stage.time());
        assert!(stage.restore(&state).is_err());
        assert!((points(&stage), stage.time()) == before);
    }
}
