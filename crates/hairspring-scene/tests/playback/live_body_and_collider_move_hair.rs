//! Promise: an app can move the body as a whole and a ball, and both move hair.
//!
//! Roots stay on a body that the app moves in addition to its clip. A ball keeps all hair out, including
//! follow hairs. It passes on its velocity, but a new ball starts with zero velocity. Frames that are
//! advanced without updating the render points give the same result.

use crate::support::play;
use glam::{Quat, Vec3};
use hairspring::{collide::ColliderShape, groom::Groom, material::Material, math::RigidTransform};
use hairspring_scene::{
    Guides, InitialContact, Scene, SceneGroom,
    builtin::{self, BuiltinOptions},
    stage::Stage,
};
use hairspring_test::{FRAME, REST, farthest, line, translation};

#[test]
fn roots_stay_on_a_body_moved_by_the_app() {
    let options = BuiltinOptions { strands: 200, guides: Guides::Count(40), ..BuiltinOptions::default() };
    let scene = builtin::scene(&options);
    let [mut here, mut carried] = [0; 2].map(|_| Stage::new(scene.clone()).unwrap());
    let motion = |frame: u32| RigidTransform {
        rotation: Quat::from_rotation_y(0.02 * frame as f32),
        translation: Vec3::new(0.01 * frame as f32, 0.0, -0.005 * frame as f32),
    };
    let roots = |stage: &Stage| -> Vec<Vec3> {
        stage
            .strands()
            .flat_map(|s| {
                (0..s.groom.strand_count()).map(|k| s.points[s.groom.range(k).start]).collect::<Vec<_>>()
            })
            .collect()
    };
    for frame in 1..30 {
        carried.move_body(motion(frame));
        here.step(FRAME);
        carried.step(FRAME);
        let (still, moved) = (roots(&here), roots(&carried));
        let expected: Vec<Vec3> = still.iter().map(|root| motion(frame).transform_point(*root)).collect();
        let error = farthest(&expected, &moved);
        assert!(error < 2e-6, "frame {frame}: a root is {error} m from its place on the body");
        let anchor = motion(frame) * here.body_anchor();
        assert!(anchor.translation.distance(carried.body_anchor().translation) < 1e-6);
        // The head's distance field moves with the body.
        let end = carried.colliders()[0].end;
        assert!(end.translation.distance(carried.body_anchor().translation) < 1e-6);
    }
    // The motion has an effect: hair lags behind.
    let tips = |stage: &Stage| stage.strands().next().unwrap().points[31];
    let lag = motion(29).transform_point(tips(&here)).distance(tips(&carried));
    assert!(lag > 1e-3, "hair lags by only {lag} m");
    carried.reset();
    here.reset();
    assert_eq!(carried.body_anchor(), here.body_anchor());
    here.step(FRAME);
    carried.step(FRAME);
    assert_eq!(carried.strands().next().unwrap().points, here.strands().next().unwrap().points);
}

/// A curtain of strands that hang from a rail along X; one in six is simulated.
fn curtain() -> Stage {
    let strands = (0..48).map(|s| {
        let root = Vec3::X * ((s as f32 - 23.5) * 0.004);
        line(root, root - Vec3::Y * 0.5, 32)
    });
    let groom = SceneGroom {
        groom: Groom::from_strands(strands, 40e-6),
        materials: vec![Material::default()],
        guides: Guides::Count(8),
        ..SceneGroom::default()
    };
    Stage::new(Scene { grooms: vec![groom], gravity: Vec3::NEG_Y * 9.81, ..Scene::default() }).unwrap()
}

fn sphere(radius: f32) -> ColliderShape {
    ColliderShape::Sphere { center: Vec3::ZERO, radius }
}

#[test]
fn a_ball_takes_hair_along_without_penetration() {
    let mut stage = curtain();
    let radius = 0.05;
    let ball = |frame: u32| Vec3::new(0.0, -0.35, 0.15 - (frame as f32 * FRAME).min(0.3));
    for frame in 0..40 {
        stage.set_user_colliders(&[sphere(radius)], translation(ball(frame)));
        stage.step(FRAME);
        let collider = stage.colliders().last().unwrap();
        assert!(matches!(collider.shape, ColliderShape::Sphere { radius: r, .. } if r == radius));
        assert_eq!(collider.end.translation, ball(frame));
        let from = if frame == 0 { ball(0) } else { ball(frame - 1) };
        assert_eq!(collider.start.translation, from, "frame {frame}");
        let points = stage.strands().next().unwrap().points.to_vec();
        let depth = points.iter().map(|p| radius - p.distance(ball(frame))).fold(0.0, f32::max);
        assert!(depth < 1e-4, "frame {frame}: hair penetrates the ball by {depth} m");
        let measured = stage.measure();
        assert_eq!(measured.non_finite, 0);
    }
    let pushed = stage.strands().next().unwrap().points.iter().map(|p| -p.z).fold(0.0, f32::max);
    assert!(pushed > 0.1, "the ball moved hair by only {pushed} m");
    stage.set_user_colliders(&[], REST);
    assert!(stage.colliders().is_empty());
    for wrong in [f32::NAN, 0.0, -1.0] {
        stage.set_user_colliders(&[sphere(wrong)], REST);
        assert!(stage.colliders().is_empty(), "a radius of {wrong} was accepted");
    }
    play(&mut stage, 300);
    let left = stage.strands().next().unwrap().points.iter().map(|p| p.z.abs()).fold(0.0, f32::max);
    assert!(left < 0.01, "hair is {left} m from its old place after the ball was removed");
}

#[test]
fn a_ball_stays_when_settings_change() {
    let mut stage = curtain();
    let center = Vec3::new(0.0, -0.35, 0.03);
    stage.set_user_colliders(&[sphere(0.05)], translation(center));
    let sphere = hairspring_scene::Shape::Sphere { center: Vec3::X, radius: 0.1 };
    let colliders =
        vec![hairspring_scene::Collider { joint: None, initial: InitialContact::Keep, shape: sphere }];
    let grooms = vec![SceneGroom { materials: vec![Material::default()], ..SceneGroom::default() }];
    let settings = Scene { colliders, grooms, ..stage.scene().clone() };
    stage.update_settings(settings).unwrap();
    assert_eq!(stage.colliders().len(), 2);
    assert_eq!(stage.colliders()[1].end.translation, center);
    play(&mut stage, 60);
    let strands = stage.strands().next().unwrap();
    let depth = strands.points.iter().map(|p| 0.05 - p.distance(center)).fold(0.0, f32::max);
    assert!(depth < 1e-4, "hair penetrates the ball by {depth} m");
    stage.reset();
    assert_eq!(stage.colliders()[1].start, stage.colliders()[1].end);
    assert_eq!(stage.colliders()[1].end.translation, center);
}

#[test]
fn skipped_render_updates_change_nothing() {
    let options = BuiltinOptions { strands: 200, guides: Guides::Count(40), ..BuiltinOptions::default() };
    let scene = builtin::scene(&options);
    let [mut seen, mut unseen] = [0; 2].map(|_| Stage::new(scene.clone()).unwrap());
    let points = |stage: &Stage| stage.strands().map(|s| s.points.to_vec()).collect::<Vec<_>>();
    let before = points(&unseen);
    for _ in 0..30 {
        seen.step(FRAME);
        unseen.advance(FRAME);
    }
    assert_eq!(points(&unseen), before, "the render points changed without an update");
    unseen.update_render_points();
    assert_eq!(points(&unseen), points(&seen), "the results differ");
}
