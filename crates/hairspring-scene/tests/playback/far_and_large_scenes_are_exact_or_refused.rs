//! Promise: scenes that are far from the origin or very large are simulated exactly, or refused with a
//! one-sentence error.
//!
//! Hair at 100 m from the origin moves as it does at the origin. A scene is refused where single precision
//! does not resolve its segments, at rest or where a clip moves them, and where lengths would overflow in a
//! frame. Two grooms that are far apart share a volume with bounded memory.

use crate::support::play;
use glam::{Quat, Vec3};
use hairspring::{
    body::{Body, Clip, KEYED_RATE, Key, Mesh, Trs, keyframe_clip},
    groom::Groom,
    settings::{Effects, Solver, Volume, VolumeMethod},
};
use hairspring_scene::{
    Guides, Scene, SceneGroom,
    stage::{Stage, StageError},
};
use hairspring_test::{FRAME, farthest};

const POINTS: usize = 10;

/// Strands of `POINTS` points that extend outward from `middle`.
fn groom(middle: Vec3, segment: f32) -> SceneGroom {
    let strand = |k: usize| -> Vec<Vec3> {
        let root = middle + Vec3::new(0.002 * (k % 4) as f32, 0.0, 0.002 * (k / 4) as f32);
        (0..POINTS).map(|i| root + Vec3::new(0.8, 0.6, 0.0) * (segment * i as f32)).collect()
    };
    SceneGroom {
        groom: Groom::from_strands((0..16).map(strand), 35e-6),
        guides: Guides::All,
        ..SceneGroom::default()
    }
}

fn scene(grooms: Vec<SceneGroom>) -> Scene {
    let solver = Solver { sag_free: false, ..Solver::default() };
    Scene { grooms, gravity: Vec3::new(0.0, -9.81, 0.0), solver, ..Scene::default() }
}

/// The error for a scene that is refused.
fn refused(scene: Scene) -> String {
    match Stage::new(scene) {
        Ok(_) => panic!("the scene was accepted"),
        Err(
            error @ (StageError::TooFar { .. }
            | StageError::MovedTooFar { .. }
            | StageError::OutOfRange { .. }
            | StageError::Settings(_)),
        ) => error.to_string(),
        Err(other) => panic!("{other}"),
    }
}

/// The points of the first groom, relative to their roots.
fn shape(stage: &Stage) -> Vec<Vec3> {
    let strands = stage.strands().next().unwrap();
    strands.points.chunks(POINTS).flat_map(|strand| strand.iter().map(|p| *p - strand[0])).collect()
}

#[test]
fn hair_at_a_hundred_meters_moves_as_at_the_origin() {
    let [here, there] = [Vec3::ZERO, Vec3::new(100.0, 0.0, -100.0)].map(|middle| {
        let mut stage = Stage::new(scene(vec![groom(middle, 0.01)])).unwrap();
        play(&mut stage, 60);
        shape(&stage)
    });
    let difference = farthest(&here, &there);
    assert!(difference < 1e-3, "hair at 100 m differs by {difference} m");
}

#[test]
fn hair_too_far_from_the_origin_is_refused() {
    for away in [5e3, 1e5, 1e7, 1e30] {
        let message = refused(scene(vec![groom(Vec3::ZERO, 0.005), groom(Vec3::X * away, 0.005)]));
        assert!(
            message.starts_with("groom 1: strand 0 is ") && message.contains("nearer to the origin"),
            "{message}"
        );
    }
}

#[test]
fn a_clip_that_moves_hair_too_far_is_refused() {
    let key = |time: f32, x: f32| Key { time, position: Vec3::X * x, rotation: Quat::IDENTITY };
    let moved = |away: f32| Scene {
        body: Some(Body::rigid(plate())),
        clip: Some(keyframe_clip(&[key(0.0, 0.0), key(10.0, away)], Vec3::ZERO, KEYED_RATE, 1.0)),
        ..scene(vec![groom(Vec3::ZERO, 0.005)])
    };
    let message = refused(moved(5e3));
    assert!(message.starts_with("groom 0, in frame 600 of the clip 'keys': strand 0 is 5000"), "{message}");
    assert!(message.contains("nearer to the origin"), "{message}");
    assert!(Stage::new(moved(500.0)).is_ok());
}

fn plate() -> Mesh {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    Mesh {
        positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z)).into(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

#[test]
fn lengths_that_overflow_are_refused() {
    let huge = |groom: SceneGroom| {
        let points = groom.groom.points.iter().map(|p| *p * 1e25).collect();
        SceneGroom { groom: Groom { points, ..groom.groom }, ..groom }
    };
    assert!(refused(scene(vec![huge(groom(Vec3::ZERO, 0.01))])).contains("groom 0"));
    for effects in [
        Effects { curl_radius: 3e38, ..Effects::default() },
        Effects { noise: f32::NAN, ..Effects::default() },
    ] {
        let curled = SceneGroom { effects, guides: Guides::Count(4), ..groom(Vec3::ZERO, 0.01) };
        assert!(refused(scene(vec![curled.clone()])).contains("groom 0, effects: "));
        // The same settings are refused as a later change.
        let plain = SceneGroom { effects: Effects::default(), ..curled.clone() };
        let mut stage = Stage::new(scene(vec![plain])).unwrap();
        let error = stage.update_settings(scene(vec![curled])).unwrap_err().to_string();
        assert!(error.starts_with("groom 0, effects: "), "{error}");
    }
    let away = Trs { translation: Vec3::Y * 1e30, ..Trs::default() };
    let mut moved = scene(vec![groom(Vec3::ZERO, 0.01)]);
    moved.body = Some(Body::rigid(plate()));
    let samples = vec![Trs::default(), away];
    moved.clip = Some(Clip { name: "away".into(), rate: 30.0, joint_count: 1, samples });
    assert!(refused(moved).contains("a translation of the clip"));
}

#[test]
fn a_volume_of_grooms_far_apart_is_bounded() {
    for method in [VolumeMethod::Density, VolumeMethod::Incompressible] {
        for (away, frames) in
            [(Vec3::X * 200.0, 10), (Vec3::X * 1000.0, 10), (Vec3::splat(30.0), 2), (Vec3::splat(900.0), 2)]
        {
            let mut scene = scene(vec![groom(Vec3::ZERO, 0.007), groom(away, 0.007)]);
            scene.volume = Volume { method, ..Volume::default() };
            let mut stage = Stage::new(scene).unwrap();
            assert!(stage.notes().iter().any(|note| note.contains("more than two million cells")));
            for _ in 0..frames {
                stage.step(FRAME);
                let nodes = stage.volume().unwrap().nodes;
                assert!(nodes <= 1 << 21, "{nodes} nodes at {away}, {method:?}");
            }
            assert!(stage.strands().flat_map(|s| s.points).all(|p| p.is_finite()));
        }
    }
}
