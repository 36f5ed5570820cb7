//! Promise: the camera that is set automatically keeps hair and head in view, and shows them large. The box that it shows
//! holds all strands in every frame of the motion, is at most 1.5 times as large as they need, holds the face, and does
//! not depend on the current time. Hair that travels is followed: a small box that moves along its path holds it, also
//! across cuts.

use glam::{Quat, Vec3};
use hairspring::{
    body::{Body, Clip, Mesh, Trs},
    groom::Groom,
    settings::Wind,
};
use hairspring_scene::{
    Guides, Scene, SceneGroom,
    builtin::{BuiltinOptions, Style, scene},
    stage::Stage,
};

/// The fraction of points outside the box, over all frames, and the largest side of the box over that of all points.
fn outside(stage: &mut Stage, frames: usize) -> (f64, f32) {
    let (low, high) = stage.subject().unwrap().bounds;
    let (mut out, mut all) = (0, 0);
    let mut needed = (Vec3::MAX, Vec3::MIN);
    for _ in 0..frames {
        for p in stage.strands().flat_map(|s| s.points) {
            out += usize::from(p.cmplt(low).any() || p.cmpgt(high).any());
            all += 1;
            needed = (needed.0.min(*p), needed.1.max(*p));
        }
        stage.step(1.0 / 30.0);
    }
    (out as f64 / all as f64, (high - low).max_element() / (needed.1 - needed.0).max_element())
}

#[test]
fn the_box_holds_hair_that_turns_and_shakes() {
    for style in Style::ALL {
        let options = BuiltinOptions { strands: 250, guides: Guides::All, ..BuiltinOptions::new(style) };
        let mut stage = Stage::new(scene(&options)).unwrap();
        let (share, larger) = outside(&mut stage, 150);
        println!("{}: {share} outside, {larger} times as large", style.name());
        assert!(share < 2e-3, "{}: {share} of all points are outside", style.name());
        assert!(larger < 1.5, "{}: {larger} times as large as the hair", style.name());
    }
}

#[test]
fn the_box_holds_long_hair_in_gusts_and_a_quick_turn() {
    let options = BuiltinOptions { strands: 120, guides: Guides::All, ..BuiltinOptions::new(Style::Wavy) };
    let mut made = scene(&options);
    made.wind = Wind { velocity: Vec3::X * 1.5, gust: 0.6, gust_rate: 0.7 };
    // It turns by 50° in 0.3 s.
    let turned =
        |degrees: f32| Trs { rotation: Quat::from_rotation_y(degrees.to_radians()), ..Trs::default() };
    let eased = |k: usize| {
        let t = ((k as f32 / 30.0 - 0.2) / 0.3).clamp(0.0, 1.0);
        turned(50.0 * t * t * (3.0 - 2.0 * t))
    };
    made.body = made.body.map(|body| Body::rigid(body.mesh));
    made.collision = None;
    made.clip = Some(Clip {
        name: "turn".into(),
        rate: 30.0,
        joint_count: 1,
        samples: (0..=45).map(eased).collect(),
    });
    let mut stage = Stage::new(made).unwrap();
    let (share, larger) = outside(&mut stage, 46);
    println!("{share} outside, {larger} times as large");
    assert!(share < 2e-3, "{share} of all points are outside");
    assert!(larger < 1.5, "{larger} times as large as the hair");
}

#[test]
fn the_box_holds_the_head_and_not_the_whole_bust() {
    let options = BuiltinOptions { strands: 100, ..BuiltinOptions::new(Style::ShortFur) };
    let stage = Stage::new(scene(&options)).unwrap();
    let (low, high) = stage.subject().unwrap().bounds;
    let (nose, chin) = (Vec3::new(0.0, -0.036, 0.1), Vec3::new(0.0, -0.11, 0.07));
    for p in [nose, chin] {
        assert!(p.cmpge(low).all() && p.cmple(high).all(), "{p} of {low} to {high}");
    }
    assert!(low.y > -0.28, "the chest is not part of the subject: {low}");
}

/// A tuft on a board that travels 3 m.
fn traveler() -> Scene {
    let corners = [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let mesh = Mesh {
        positions: corners.to_vec(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        ..Mesh::default()
    };
    let at =
        |k: usize| Trs { translation: Vec3::X * k as f32 * 0.05, rotation: Quat::IDENTITY, ..Trs::default() };
    let clip =
        Clip { name: "travel".into(), rate: 30.0, joint_count: 1, samples: (0..=60).map(at).collect() };
    let strand: Vec<Vec3> = (0..8).map(|k| Vec3::Y * (0.001 + 0.02 * k as f32)).collect();
    let groom = SceneGroom { groom: Groom::from_strands(&[strand], 35e-6), ..SceneGroom::default() };
    Scene {
        grooms: vec![groom],
        body: Some(Body::rigid(mesh)),
        clip: Some(clip),
        gravity: Vec3::Y * -9.81,
        ..Scene::default()
    }
}

#[test]
fn the_box_holds_the_whole_way_at_any_time() {
    let mut stage = Stage::new(traveler()).unwrap();
    let first = stage.subject();
    let (low, high) = first.clone().unwrap().bounds;
    assert!(low.x < 0.0 && high.x > 3.0, "{low} to {high}");
    assert_eq!(outside(&mut stage, 61).0, 0.0);
    assert_eq!(stage.subject(), first);
}

/// The fraction of points outside the box that moves along the path, over all frames.
fn outside_the_moving_box(stage: &mut Stage, frames: usize) -> f64 {
    let subject = stage.subject().unwrap();
    let (mut out, mut all) = (0, 0);
    for _ in 0..frames {
        let [low, high] =
            [subject.moving_bounds.0, subject.moving_bounds.1].map(|p| p + subject.path.offset(stage.time()));
        for p in stage.strands().flat_map(|s| s.points) {
            out += usize::from(p.cmplt(low).any() || p.cmpgt(high).any());
            all += 1;
        }
        stage.step(1.0 / 30.0);
    }
    out as f64 / all as f64
}

#[test]
fn the_box_that_follows_holds_hair_that_travels_and_is_small() {
    let mut stage = Stage::new(traveler()).unwrap();
    let subject = stage.subject().unwrap();
    assert!(subject.travels());
    let size = |(low, high): (Vec3, Vec3)| (high - low).max_element();
    println!("{} m of {} m", size(subject.moving_bounds), size(subject.bounds));
    assert!(size(subject.moving_bounds) < 0.8, "{:?}", subject.moving_bounds);
    assert_eq!(outside_the_moving_box(&mut stage, 61), 0.0);
}

#[test]
fn the_box_that_follows_is_placed_elsewhere_at_a_cut() {
    let mut scene = traveler();
    for sample in &mut scene.clip.as_mut().unwrap().samples[31..] {
        sample.translation += Vec3::new(0.0, 0.0, 20.0);
    }
    let mut stage = Stage::new(scene).unwrap();
    let path = stage.subject().unwrap().path;
    assert_eq!(outside_the_moving_box(&mut stage, 61), 0.0);
    // The camera does not leave the hair before the cut.
    assert!(path.offset(30.9 / 30.0).z.abs() < 1e-3, "{}", path.offset(30.9 / 30.0));
    assert!((path.offset(31.0 / 30.0).z - 20.0).abs() < 1e-3, "{}", path.offset(31.0 / 30.0));
}

#[test]
fn a_head_that_turns_in_place_does_not_travel() {
    for style in Style::ALL {
        let options = BuiltinOptions { strands: 250, ..BuiltinOptions::new(style) };
        assert!(!Stage::new(scene(&options)).unwrap().subject().unwrap().travels(), "{}", style.name());
    }
}

#[test]
fn the_box_holds_hair_that_is_blown_and_hair_that_falls() {
    let still = Scene { clip: None, ..traveler() };
    let box_of = |scene: Scene| Stage::new(scene).unwrap().subject().unwrap().bounds;
    let (_, calm) = box_of(still.clone());
    let wind = Wind { velocity: Vec3::X * 8.0, ..Wind::default() };
    let (_, windy) = box_of(Scene { wind, ..still.clone() });
    assert!(windy.x > calm.x + 0.1, "{windy} and {calm}");
    let mut falling = still;
    falling.solver.sag_free = false;
    let strand: Vec<Vec3> = (0..8).map(|k| Vec3::new(0.02 * k as f32, 0.001, 0.0)).collect();
    falling.grooms[0].groom = Groom::from_strands(&[strand], 35e-6);
    let mut stage = Stage::new(falling).unwrap();
    assert!(stage.subject().unwrap().bounds.0.y < -0.05);
    assert_eq!(outside(&mut stage, 150).0, 0.0);
}
