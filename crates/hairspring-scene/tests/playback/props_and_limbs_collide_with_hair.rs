//! Promise: a thing beside the body, and a limb of it, meets hair as it goes.
//!
//! A prop is a part of the body's mesh with a joint of its own. Hair must meet it as it meets a collider that was written as one: on its way through the frame and
//! not where the frame ends, where a bar thrown at 10 m/s has jumped seventeen centimeters. So it takes with it what hangs in its way, and nothing is
//! left inside of it or behind. A limb is one surface with the body, which deforms: the same bar as an arm of the board must do the same. So must a sheet
//! of 2 mm that the arm waves at 5 m/s.

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
/// Way of the bar in a frame at 10 m/s [m], and where it is after the third: past the hair, which reaches farther.
const STRIDE: f32 = 10.0 / 60.0;
const LAST: f32 = 0.04;
const FRAMES: u32 = 3;
/// How far below the roots the bar goes [m].
const BELOW: f32 = 0.08;

/// A closed box.
fn cuboid(mesh: &mut Mesh, middle: Vec3, half: Vec3) {
    let first = mesh.positions.len() as u32;
    let corner = |k: u32| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) * 2.0 - 1.0;
    mesh.positions.extend((0..8).map(|k| middle + corner(k) * half));
    mesh.normals.extend((0..8).map(|k| corner(k).normalize()));
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(|i| i + first));
    mesh.triangles.extend(quads.into_iter().flat_map(halves));
}

/// A curtain that hangs from a board, and a bar that is thrown at it: a thing by itself, or a child of the board's joint.
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
fn a_bar_that_is_thrown_takes_hair_with_it() {
    throw(None);
}

#[test]
fn an_arm_takes_hair_with_it() {
    throw(Some(0));
}

#[test]
fn a_sheet_that_is_waved_takes_hair_with_it() {
    wave(false);
}

#[test]
fn a_sheet_on_an_arm_takes_hair_with_it() {
    // Each asks for parts of the frame, and not for as many.
    wave(true);
}

/// Waves a strip of two rows of quads in the bar's middle, across the way; the bar itself meets hair or nothing.
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
    waved.sheets = vec![SceneSheet { body: strip, thickness: SceneSheet::THICKNESS }];
    waved.solver.collide_body = collide_body;
    play(waved);
}

fn throw(parent: Option<u32>) {
    play(scene(parent, STRIDE));
}

fn play(scene: Scene) {
    let mut stage = Stage::new(scene).unwrap();
    for _ in 0..FRAMES {
        stage.step(1.0 / 60.0);
    }
    let points: Vec<Vec3> = stage.strands().flat_map(|strands| strands.points.to_vec()).collect();
    let depth = |p: &Vec3| stage.obstacles().iter().map(|o| -o.now().distance(*p)).fold(f32::MIN, f32::max);
    let deepest = points.chunks(POINTS).flat_map(|strand| &strand[1..]).map(depth).fold(f32::MIN, f32::max);
    // What crosses the bar's height does so before it.
    let taken = points.chunks(POINTS).filter(|strand| {
        let at = strand.windows(2).find(|ends| ends[1].y < -BELOW);
        at.is_none_or(|ends| ends[1].x > LAST)
    });
    let taken = taken.count();
    println!("{taken} of 31 strands go with the bar, {:.3} mm deep the deepest point", 1e3 * deepest);
    assert_eq!(taken, 31, "strands that go with the bar");
    assert!(deepest < 1e-4, "{deepest} m deep");
}
