//! Promise: hair that falls during the pre-roll ends where it would have fallen in the scene, and stays at
//! rest there.
//!
//! Grown hair stands off the skin. `solver.preroll` lets it fall before the first frame, onto a body at
//! rest. The tests use a skinned body whose head is not at the origin, and a ball in the world. The result
//! of the pre-roll becomes the groom. The first frame shows it, the sag-free start keeps it in balance,
//! follow hairs rest with their guides, and every reset returns to it.

use crate::support::{play, points};
use glam::{Quat, Vec3};
use hairspring::{
    groom::{Groom, Growth, grow},
    settings::Solver,
};
use hairspring_scene::{
    Collider, Guides, InitialContact, Scene, SceneGroom, Shape,
    builtin::{BuiltinOptions, scene as builtin},
    stage::Stage,
};
use hairspring_test::farthest;

const HEAD: f32 = 0.09;

/// Hair of 12 cm that stands straight off a ball.
fn ball(guides: Guides) -> Scene {
    let strands = (0..80).map(|k| {
        let around = Quat::from_rotation_y(2.4 * k as f32) * Vec3::X;
        let out = (around * (0.1 + 0.9 * k as f32 / 80.0) + Vec3::Y * 0.8).normalize();
        (0..12).map(|i| out * (HEAD + 0.12 * i as f32 / 11.0)).collect::<Vec<_>>()
    });
    let groom = Groom::from_strands(strands, 35e-6);
    let shape = Shape::Sphere { center: Vec3::ZERO, radius: HEAD };
    Scene {
        grooms: vec![SceneGroom { groom, guides, ..SceneGroom::default() }],
        colliders: vec![Collider { shape, initial: InitialContact::Keep, joint: None }],
        gravity: Vec3::new(0.0, -9.81, 0.0),
        ..Scene::default()
    }
}

/// Hair grown on the built-in head, which does not move.
fn head() -> Scene {
    let mut scene = builtin(&BuiltinOptions { strands: 1, ..BuiltinOptions::default() });
    let mesh = &scene.body.as_ref().unwrap().mesh;
    let scalp = mesh.parts.iter().find(|part| part.name == "scalp").unwrap().triangles.clone();
    let growth = Growth { strands: 200, points: 16, length: 0.2, spread: 0.15, fall: 0.9 };
    scene.grooms[0].groom = grow(mesh, &growth, |t| scalp.contains(&(t as u32)));
    scene.grooms[0].guides = Guides::All;
    scene.clip = None;
    scene
}

/// A stage of this scene with a pre-roll of `preroll` [s].
fn stage(scene: &Scene, preroll: f32, sag_free: bool) -> Stage {
    let solver = Solver { preroll, sag_free, ..Solver::default() };
    Stage::new(Scene { solver, ..scene.clone() }).unwrap()
}

#[test]
fn the_progress_of_a_preroll_counts_its_frames() {
    let counts = |preroll: f32| {
        let solver = Solver { preroll, ..Solver::default() };
        let mut counts = Vec::new();
        let scene = Scene { solver, ..ball(Guides::Count(4)) };
        Stage::with_preroll_progress(scene, &mut |done, all| counts.push((done, all))).unwrap();
        counts
    };
    assert_eq!(counts(0.0), []);
    assert_eq!(counts(0.1), [0, 1, 2, 3, 4, 5, 6].map(|done| (done, 6)));
}

#[test]
fn preroll_gives_the_result_of_falling_in_the_scene() {
    for (name, scene) in [("ball", ball(Guides::All)), ("head", head())] {
        let mut falling = stage(&scene, 0.0, false);
        let start = points(&falling);
        play(&mut falling, 60);
        let moved = farthest(&start, &points(&falling));
        let difference = farthest(&points(&falling), &points(&stage(&scene, 1.0, true)));
        println!("{name}: falls by {moved:.3} m in a second; the pre-roll differs by {difference:.1e} m");
        assert!(moved > 0.05, "{name}: hair falls by only {moved} m");
        // Contact amplifies differences in rounding.
        assert!(difference < 1e-3, "{name}: the pre-roll differs by {difference} m");
    }
}

#[test]
fn hair_is_at_rest_after_preroll() {
    for (name, scene) in [("all", ball(Guides::All)), ("guides", ball(Guides::Count(20))), ("head", head())] {
        let mut stage = stage(&scene, 3.0, true);
        let start = points(&stage);
        play(&mut stage, 30);
        let moved = farthest(&start, &points(&stage));
        println!("{name}: moves by at most {moved:.1e} m in half a second");
        assert!(moved < 1e-3, "{name}: hair moves by {moved} m in half a second");
        let measure = stage.measure();
        assert_eq!(
            (measure.inside_points, measure.non_finite),
            (0, 0),
            "{name}: points are inside or not finite"
        );
        stage.reset();
        assert!(points(&stage) == start, "{name}: a reset does not restore the start");
    }
    let inside = |stage: Stage| points(&stage).iter().map(|p| HEAD - p.length()).fold(0.0, f32::max);
    let deepest = inside(stage(&ball(Guides::All), 3.0, true));
    assert!(deepest < 1e-4, "hair penetrates the ball by {deepest} m");
}
