//! Promise: a moving prop and a moving limb of the body collide with hair on their whole path.
//!
//! A prop is a part of the body's mesh with a joint of its own. It must collide like an explicit collider:
//! along its path through the frame and not only where the frame ends. A bar thrown at 10 m/s moves by 17
//! cm in a frame. It takes all hair in its path along, and no hair remains inside or behind it. A limb is
//! part of the deforming surface of the body: the same bar as an arm of the board must give the same
//! result. So must a sheet of 2 mm that the arm waves at 5 m/s.

use crate::support::points;
use glam::{Affine3A, Vec3};
use hairspring::{
    body::{Body, Clip, Joint, Mesh, Skin, Trs},
    groom::{Groom, bind_roots},
    material::Material,
    settings::Solver,
};
use hairspring_scene::{Guides, Scene, SceneGroom, SceneSheet, stage::Stage};

const POINTS: usize = 16;
const LENGTH: f32 = 0.16;
/// Path of the bar in a frame at 10 m/s [m], and its position after the third frame: past the hair, which
/// is longer.
const STRIDE: f32 = 10.0 / 60.0;
const LAST: f32 = 0.04;
const FRAMES: u32 = 3;
/// Distance of the bar below the roots [m].
const BELOW: f32 = 0.08;

/// Adds a closed box.
fn cuboid(mesh: &mut Mesh, middle: Vec3, half: Vec3) {
    let first = mesh.positions.len() as u32;
    let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 2.0 - 1.0;
    mesh.positions.extend((0..8).map(|k| middle + corner(k) * half));
    mesh.normals.extend((0..8).map(|k| corner(k).normalize()));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(|i| i + first));
    mesh.triangles.extend(quads.into_iter().flat_map(halves));
}

/// A curtain that hangs from a board, and a bar that is thrown at it: independent, or a child of the
/// board's joint.
fn scene(parent: Option<u32>, stride: f32) -> Scene {
    let mut mesh = Mesh::default();
    cuboid(&mut mesh, Vec3::Y * 0.01, Vec3::new(0.05, 0.01, 0.08));
    cuboid(&mut mesh, Vec3::new(LAST, -BELOW, 0.0), Vec3::new(0.01, 0.01, 0.08));
    let joint = |name: &str, parent| Joint { name: name.into(), parent, rest: Trs::default() };
    let skin = Skin {
        joints: (0..16).map(|v| [v / 8, 0, 0, 0]).collect(),
        weights: vec![[1.0, 0.0, 0.0, 0.0]; 16],
        inverse_bind: vec![Affine3A::IDENTITY; 2],
    };
    let body = Body { mesh, joints: vec![joint("board", None), joint("bar", parent)], skin: Some(skin) };
    let bar =
        |frame: u32| Trs { translation: Vec3::X * (-stride * (FRAMES - frame) as f32), ..Trs::default() };
    let samples = (0..=FRAMES).flat_map(|frame| [Trs::default(), bar(frame)]).collect();
    let clip = Clip { name: "throw".into(), rate: 60.0, joint_count: 2, samples };
    let strand = |k: usize| {
        let root = Vec3::new(0.0, 0.0, 0.003 * k as f32 - 0.045);
        (0..POINTS)
            .map(move |i| root - Vec3::Y * (LENGTH * i as f32 / (POINTS - 1) as f32))
            .collect::<Vec<_>>()
    };
    let mut groom = Groom::from_strands((0..31).map(strand), 35e-6);
    bind_roots(&mut groom, &body.mesh);
    let groom = SceneGroom {
        groom,
        materials: vec![Material::default()],
        guides: Guides::All,
        ..SceneGroom::default()
    };
    Scene {
        grooms: vec![groom],
        body: Some(body),
        clip: Some(clip),
        gravity: Vec3::new(0.0, -9.81, 0.0),
        solver: Solver { collide_body: true, ..Solver::default() },
        ..Scene::default()
    }
}

#[test]
fn a_thrown_bar_takes_hair_along() {
    throw(None);
}

#[test]
fn an_arm_takes_hair_along() {
    throw(Some(0));
}

#[test]
fn a_waved_sheet_takes_hair_along() {
    wave(false);
}

#[test]
fn a_sheet_on_an_arm_takes_hair_along() {
    // The arm and the sheet each need time slices, but not the same number.
    wave(true);
}

/// Waves a strip of two rows of quads through the hair, with the bar as its middle. The bar itself collides
/// or does not.
fn wave(collide_body: bool) {
    let mut waved = scene(Some(0), 0.5 * STRIDE);
    let board = waved.body.as_ref().unwrap();
    let height = |k: usize| 0.01 * (k as f32 - 1.0) - BELOW;
    let positions = (0..3).flat_map(|k| [-0.08, 0.08].map(|z| Vec3::new(LAST, height(k), z))).collect();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];
    let skin = Skin {
        joints: vec![[1, 0, 0, 0]; 6],
        weights: vec![[1.0, 0.0, 0.0, 0.0]; 6],
        inverse_bind: vec![Affine3A::IDENTITY; 2],
    };
    let mesh = Mesh { positions, triangles, ..Mesh::default() };
    let strip = Body { mesh, joints: board.joints.clone(), skin: Some(skin) };
    waved.sheets =
        vec![SceneSheet { body: strip, thickness: SceneSheet::THICKNESS, ..SceneSheet::default() }];
    waved.solver.collide_body = collide_body;
    play(waved);
}

fn throw(parent: Option<u32>) {
    play(scene(parent, STRIDE));
}

fn play(scene: Scene) {
    let mut stage = Stage::new(scene).unwrap();
    crate::support::play(&mut stage, FRAMES as usize);
    let points = points(&stage);
    assert!(points.iter().all(|p| p.is_finite()), "a point is not finite");
    let depth =
        |p: &Vec3| stage.colliders().iter().map(|o| -o.end_pose().distance(*p)).fold(f32::MIN, f32::max);
    let deepest = points.chunks(POINTS).flat_map(|strand| &strand[1..]).map(depth).fold(f32::MIN, f32::max);
    // A strand that reaches below the bar must pass in front of it.
    let taken = points.chunks(POINTS).filter(|strand| {
        let at = strand.windows(2).find(|ends| ends[1].y < -BELOW);
        at.is_none_or(|ends| ends[1].x > LAST)
    });
    let taken = taken.count();
    println!(
        "the bar takes {taken} of 31 strands along; the deepest point is {:.3} mm inside",
        1e3 * deepest
    );
    assert_eq!(taken, 31, "the bar does not take all strands along");
    assert!(deepest < 1e-4, "a point is {deepest} m inside");
}
