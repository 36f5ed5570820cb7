//! Promise: a global shape returns hair to its authored place, with the offset of a closed form, and has no
//! effect when it is off.
//!
//! A point on a spring of f Hz sags by g/ω² under gravity. A strand without bending stiffness sags by that
//! over its whole length. A strand with a fiber of its own returns to its style after a shake. The pull
//! moves with the root, and follows its curve from root to tip and the values painted on each strand.

use glam::{Quat, Vec3};
use hairspring::{
    groom::{Groom, StrandScale},
    material::{GlobalShape, Material, Model},
    math::RigidTransform,
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{FRAME, farthest, points, roots, step, translation};
use std::{f32::consts::TAU, sync::Arc};

const POINTS: usize = 24;
const SEGMENT: f32 = 0.01;
const GRAVITY: f32 = 9.81;

/// Strands that extend sideways.
struct Brush {
    simulation: Simulation,
    groom: Arc<Groom>,
    points: Vec<Vec3>,
}

impl Brush {
    fn new(material: Material, solver: Solver, scales: Vec<StrandScale>) -> Self {
        let strands = (0..4).map(|s| {
            (0..POINTS).map(move |i| Vec3::new(SEGMENT * i as f32, 0.0, 0.05 * s as f32)).collect::<Vec<_>>()
        });
        let mut groom = Groom::from_strands(strands, 40e-6);
        groom.scales = scales;
        let groom = Arc::new(groom);
        let simulation = Simulation::builder(groom.clone())
            .materials(&[material])
            .solver(Solver { sag_free: false, ..solver })
            .build()
            .unwrap();
        Self { simulation, points: groom.points.clone(), groom }
    }

    fn step(&mut self, head: RigidTransform) {
        step(&mut self.simulation, head, &roots(&self.groom, head), &[]);
        self.points = points(&self.simulation);
    }

    /// Half a second of shaking by 5 cm at 2 Hz, then rest for `rest` frames.
    fn shake(&mut self, rest: u32) {
        for frame in 1..=30 + rest {
            let x = if frame <= 30 { 0.05 * (TAU * 2.0 * frame as f32 * FRAME).sin() } else { 0.0 };
            self.step(translation(Vec3::new(0.0, x, x)));
        }
    }

    /// How far point `i` of strand `s` is below its authored place [m].
    fn sag(&self, s: usize, i: usize) -> f32 {
        (self.groom.strand(s)[i] - self.points[s * POINTS + i]).y
    }
}

fn global_shape(pull: f32, tip: f32) -> GlobalShape {
    GlobalShape { pull, profile: vec![1.0, tip], damping: 0.5 }
}

/// g/ω² at `pull` [Hz].
fn closed_form(pull: f32) -> f32 {
    GRAVITY / (TAU * pull).powi(2)
}

#[test]
fn hair_returns_with_the_offset_of_the_closed_form() {
    for model in [Model::Curvature, Model::Springs] {
        let limp = Material {
            model,
            bend: 0.0,
            drag: 0.0,
            global_shape: global_shape(20.0, 1.0),
            ..Material::default()
        };
        let mut brush = Brush::new(limp, Solver::default(), Vec::new());
        brush.shake(180);
        // Points near the root are also held by the root.
        for i in 6..POINTS {
            let (sag, want) = (brush.sag(0, i), closed_form(20.0));
            if i % 8 == 7 {
                println!("{model:?}, point {i}: {sag} m, closed form {want}");
            }
            assert!((sag / want - 1.0).abs() < 0.01, "{model:?}, point {i}: {sag} m, closed form {want}");
        }
    }
    // With its fiber hair sags less; without a global shape it hangs down.
    let sag_with = |global_shape: GlobalShape| {
        let mut brush =
            Brush::new(Material { global_shape, ..Material::default() }, Solver::default(), Vec::new());
        brush.shake(240);
        (6..POINTS).map(|i| brush.sag(0, i)).fold(0.0, f32::max)
    };
    let (held, hangs) = (sag_with(global_shape(10.0, 1.0)), sag_with(GlobalShape::default()));
    println!("sags by {held} m, bound {}; without a global shape by {hangs} m", closed_form(10.0));
    assert!(
        held < 1.05 * closed_form(10.0) && hangs > 0.1,
        "{held} m with a global shape, {hangs} m without"
    );
}

#[test]
fn the_curve_and_painted_values_scale_the_pull() {
    let limp = |global_shape| Material {
        model: Model::Curvature,
        bend: 0.0,
        drag: 0.0,
        global_shape,
        ..Material::default()
    };
    let scale = |global_shape| StrandScale { global_shape, ..StrandScale::default() };
    let mut brush = Brush::new(
        limp(global_shape(20.0, 1.0)),
        Solver::default(),
        [1.0, 2.0, 0.5, 0.0].map(scale).to_vec(),
    );
    brush.shake(240);
    for (s, scale) in [(0, 1.0), (1, 2.0), (2, 0.5)] {
        let (sag, want) = (brush.sag(s, 20), closed_form(20.0 * scale));
        println!("painted {scale}: {sag} m, closed form {want}");
        assert!((sag / want - 1.0).abs() < 0.02, "painted {scale}: {sag} m, closed form {want}");
    }
    assert!(brush.sag(3, 20) > 0.1, "painted 0, it sags by only {} m", brush.sag(3, 20));
    // Half the frequency at the tip gives four times the sag there, with interpolation along the strand.
    let mut brush = Brush::new(limp(global_shape(30.0, 0.5)), Solver::default(), Vec::new());
    brush.shake(240);
    for i in [8, 16, POINTS - 1] {
        let share = 1.0 - 0.5 * i as f32 / (POINTS - 1) as f32;
        let (sag, want) = (brush.sag(0, i), closed_form(30.0 * share));
        println!("point {i}: {sag} m, closed form {want}");
        assert!((sag / want - 1.0).abs() < 0.1, "point {i}: {sag} m, closed form {want}");
    }
}

#[test]
fn a_global_shape_that_is_off_has_no_effect() {
    let played = |global_shape: GlobalShape, on: bool| {
        let solver = Solver { global_shape: on, ..Solver::default() };
        let mut brush = Brush::new(Material { global_shape, ..Material::default() }, solver, Vec::new());
        brush.shake(30);
        brush.points.iter().flat_map(|p| p.to_array()).map(f32::to_bits).collect::<Vec<_>>()
    };
    let none = played(GlobalShape::default(), true);
    assert!(played(global_shape(20.0, 1.0), false) == none, "a global shape that is off changed the result");
    assert!(played(global_shape(20.0, 1.0), true) != none, "a global shape that is on had no effect");
}

#[test]
fn the_global_shape_moves_with_the_head() {
    let material = Material { global_shape: global_shape(20.0, 1.0), drag: 0.05, ..Material::default() };
    let mut brush = Brush::new(material, Solver::default(), Vec::new());
    // A quarter turn about the vertical and a translation of 3 m, in a second.
    let at = |frame: u32| {
        let share = (frame as f32 / 60.0).min(1.0);
        let share = share * share * (3.0 - 2.0 * share);
        RigidTransform {
            rotation: Quat::from_rotation_y(0.25 * TAU * share),
            translation: Vec3::X * (3.0 * share),
        }
    };
    let (mut worst, mut last) = (0.0f32, 0.0f32);
    for frame in 1..=180 {
        brush.step(at(frame));
        let style: Vec<Vec3> = brush.groom.points.iter().map(|p| at(frame).transform_point(*p)).collect();
        last = farthest(&style, &brush.points);
        worst = worst.max(last);
    }
    println!("offset in motion {worst} m, at rest {last} m, closed form {}", closed_form(20.0));
    // In addition to gravity, the translation and the rotation accelerate the tip by 6 m/s² each.
    assert!(worst < 3.0 * closed_form(20.0), "the offset in motion is {worst} m");
    // A fiber that hangs out over its root has a slightly larger offset at its end.
    assert!(last < 1.05 * closed_form(20.0), "the offset at rest is {last} m");
}
