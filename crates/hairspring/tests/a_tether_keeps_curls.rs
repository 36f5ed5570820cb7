//! Promise: a tether lets no point much farther from its root than it is at rest, times what the material says; it pulls nothing that is nearer; and without one
//! hair is held by its length alone, which no point of it ever leaves.
//!
//! Curls of 40 cm of hair hang 15 cm long. A root that jerks up and down by 10 cm pulls them open: a tether of 1.2 lets them go to 18 cm and the little that
//! it gives way.

use glam::Vec3;
use hairspring::{
    collide::Rigid,
    groom::Groom,
    material::{Material, Model},
    scene::Solver,
    simulation::{Air, Drive, Simulation},
};
use std::{f32::consts::TAU, sync::Arc};

const FRAME: f32 = 1.0 / 60.0;
const POINTS: usize = 64;

/// A curl that hangs down: radius 8 mm, a turn in every 2 cm of height.
fn curl() -> Groom {
    let point = |i: usize| {
        let height = 0.15 * i as f32 / (POINTS - 1) as f32;
        let (sin, cos) = (TAU * height / 0.02).sin_cos();
        Vec3::new(0.008 * (cos - 1.0), -height, 0.008 * sin)
    };
    Groom::from_strands([(0..POINTS).map(point).collect::<Vec<_>>()], 35e-6)
}

/// The farthest that any point gets from its root in a shake of two seconds, over how far it is at rest, and over how much hair there is up to it.
fn farthest(model: Model, tether: Option<f32>) -> [f32; 2] {
    let groom = Arc::new(curl());
    let material = Material { model, tether, ..Material::default() };
    let mut simulation = Simulation::new(
        groom.clone(),
        &[0],
        &[material],
        Solver::default(),
        Vec3::NEG_Y * 9.81,
        Rigid::default(),
        &[],
    );
    let rest = groom.strand(0);
    let mut arc = vec![0.0; POINTS];
    (1..POINTS).for_each(|i| arc[i] = arc[i - 1] + rest[i].distance(rest[i - 1]));
    let mut points = rest.to_vec();
    let mut most = [0.0_f32; 2];
    for frame in 1..=120 {
        let y = 0.1 * (TAU * 2.0 * frame as f32 * FRAME).sin();
        let pose = Rigid { translation: Vec3::Y * y, ..Rigid::default() };
        simulation.step(&Drive {
            dt: FRAME,
            anchor: pose,
            roots: &[Rigid { translation: pose.point(rest[0]), ..pose }],
            obstacles: &[],
            air: Air::default(),
        });
        simulation.write_points(&mut points);
        // Near the root, where the chord is short, a millimetre is much of it.
        for i in POINTS / 4..POINTS {
            let far = points[i].distance(points[0]);
            most = [most[0].max(far / rest[i].distance(rest[0])), most[1].max(far / arc[i])];
        }
    }
    most
}

#[test]
fn a_tether_holds_curls_together() {
    for model in [Model::Rod, Model::Curvature, Model::Springs] {
        let (free, held) = (farthest(model, None), farthest(model, Some(1.2)));
        println!("{model:?}: {free:.3?} without, {held:.3?} with");
        assert!(free[0] > 1.4, "{model:?}: the shake opens a free curl, to {:.3}", free[0]);
        assert!(held[0] < 1.25, "{model:?}: {:.3}", held[0]);
    }
}

#[test]
fn no_point_leaves_the_length_of_its_hair_without_one() {
    for model in [Model::Rod, Model::Curvature, Model::Springs] {
        assert!(farthest(model, None)[1] <= 1.011, "{model:?}");
    }
}

#[test]
fn a_tether_that_is_long_enough_changes_no_bit() {
    assert_eq!(farthest(Model::Rod, None), farthest(Model::Rod, Some(100.0)));
}
