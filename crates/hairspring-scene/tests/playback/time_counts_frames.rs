//! Promise: time is a count of frames.
//!
//! After any number of frames at a fixed rate, the body is where its clip places it at that time, without
//! accumulated error. A frame at 23.976, 29.97 or 59.94 Hz, which is longer by a thousandth, has as many
//! substeps as one at 24, 30 or 60 Hz.

use glam::Vec3;
use hairspring::{
    body::{Body, Clip, Mesh, Trs},
    groom::Groom,
    settings::Solver,
};
use hairspring_scene::{
    Guides, Scene, SceneGroom,
    stage::{FrameRate, Stage},
};

/// A strand on a plate that moves at 0.1 m/s along X for an hour.
fn scene(substeps: u32) -> Scene {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let mesh = Mesh {
        positions: corners.map(|(x, z)| Vec3::new(x, 0.0, z) * 0.1).into(),
        normals: vec![Vec3::Y; 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let place = |x: f32| Trs { translation: Vec3::X * x, ..Trs::default() };
    let samples = (0..=36).map(|k| place(10.0 * k as f32)).collect();
    let strand: Vec<Vec3> = (0..4).map(|i| Vec3::Y * (0.01 * i as f32)).collect();
    let groom = SceneGroom {
        groom: Groom::from_strands([strand], 35e-6),
        guides: Guides::All,
        ..SceneGroom::default()
    };
    Scene {
        grooms: vec![groom],
        body: Some(Body::rigid(mesh)),
        clip: Some(Clip { name: "walk".into(), rate: 0.01, joint_count: 1, samples }),
        solver: Solver { substeps, collide_body: false, ..Solver::default() },
        ..Scene::default()
    }
}

fn root(stage: &Stage) -> f32 {
    stage.strands().next().unwrap().points[0].x
}

#[test]
fn after_ten_minutes_the_body_matches_its_clip() {
    for (frames, seconds, count) in
        [(24, 1, 14_400), (60, 1, 36_000), (240, 1, 144_000), (60_000, 1001, 36_000)]
    {
        let rate = FrameRate::new(frames, seconds).unwrap();
        let mut stage = Stage::new(scene(1)).unwrap();
        (0..count).for_each(|_| _ = stage.advance_frame(rate));
        stage.update_render_points();
        let time = rate.time_of(count);
        assert_eq!(stage.time(), time, "at {rate} Hz");
        let error = (f64::from(root(&stage)) - 0.1 * time).abs();
        assert!(error < 1e-5, "at {rate} Hz the root is {error} m from its place after {count} frames");
    }
}

#[test]
fn steps_of_any_length_add_up_without_error() {
    let mut stage = Stage::new(scene(1)).unwrap();
    (0..36_000).for_each(|_| _ = stage.advance(1.0 / 60.0));
    stage.update_render_points();
    // 1/60 s in single precision, 36,000 times.
    assert!((stage.time() - 36_000.0 * f64::from(1.0_f32 / 60.0)).abs() < 1e-9);
    assert!((root(&stage) - 60.0).abs() < 1e-4, "the root is at {} m instead of 60 m", root(&stage));
}

#[test]
fn fractional_rates_have_as_many_substeps_as_integer_rates() {
    for substeps in [1, 4, 64] {
        for whole in [24, 30, 60] {
            let mut stage = Stage::new(scene(substeps)).unwrap();
            let [exact, slower] = [(whole, 1), (whole * 1000, 1001)].map(|(frames, seconds)| {
                stage.advance_frame(FrameRate::new(frames, seconds).unwrap()).step.substeps
            });
            assert_eq!(exact, (60 * substeps).div_ceil(whole));
            assert_eq!(slower, exact, "{whole} Hz, {substeps} substeps");
        }
    }
}
