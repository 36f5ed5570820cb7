//! Promise: segments stay outside of colliders, not only points: a strand draped over a box's edge does not cut the corner, and one that falls on a
//! ball or a rod smaller than its segments rests on it; and hair that lies so comes to rest.
//!
//! Segments of 2 cm may be inside by 2 % of their length, as those on a large round body always are: at rest under 3 %, 0.6 mm, and 6 % where
//! they land. With the force or the projection alone they land deeper.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{Obstacle, Rigid},
    groom::Groom,
    material::{Material, Model},
    scene::{Contact, Solver},
    simulation::{Air, Drive, Measure, MovingObstacle, Simulation},
};
use std::sync::Arc;

const FRAME: f32 = 1.0 / 60.0;
const SEGMENT: f32 = 0.02;

/// What came of strands that fell on a shape.
struct Fallen {
    /// The worst of all frames.
    worst: Measure,
    /// In the last second.
    settled: Measure,
    /// Farthest that a point went in the last second [m].
    crept: f32,
    points: Vec<Vec3>,
}

/// Strands that stand out along X, 1 mm above the origin's height, begin at each tenth of a segment and fall for `seconds`.
fn fall(shape: Obstacle, model: Model, contact: Contact, seconds: u32) -> Fallen {
    let strands = (0..10).map(|s| {
        let root = Vec3::new(-0.09 - 0.1 * SEGMENT * s as f32, 1e-3, 0.01 * (s as f32 - 4.5));
        (0..16).map(move |i| root + Vec3::X * (SEGMENT * i as f32)).collect::<Vec<_>>()
    });
    let groom = Arc::new(Groom::from_strands(strands, 40e-6));
    let all: Vec<u32> = (0..10).collect();
    let roots: Vec<Rigid> =
        all.iter().map(|s| Rigid { translation: groom.strand(*s as usize)[0], ..Rigid::default() }).collect();
    let mut simulation = Simulation::new(
        groom,
        &all,
        &[Material { model, ..Material::default() }],
        Solver { sag_free: false, contact, ..Solver::default() },
        Vec3::NEG_Y * 9.81,
        Rigid::default(),
        &[],
    );
    let obstacles = [MovingObstacle { shape, start: Rigid::default(), end: Rigid::default() }];
    let mut points = vec![Vec3::ZERO; simulation.point_count()];
    let mut before = points.clone();
    let (mut worst, mut settled) = (Measure::default(), Measure::default());
    for frame in 0..60 * seconds {
        simulation.step(&Drive {
            dt: FRAME,
            anchor: Rigid::default(),
            roots: &roots,
            obstacles: &obstacles,
            air: Air::default(),
        });
        let measure = simulation.measure(&obstacles);
        assert_eq!(measure.non_finite, 0);
        let late = frame + 60 >= 60 * seconds;
        for worst in [&mut worst, &mut settled].into_iter().take(1 + usize::from(late)) {
            worst.segment_depth = worst.segment_depth.max(measure.segment_depth);
            worst.max_depth = worst.max_depth.max(measure.max_depth);
            worst.stretch_max = worst.stretch_max.max(measure.stretch_max);
            worst.speed_max = worst.speed_max.max(measure.speed_max);
        }
        if frame + 60 == 60 * seconds {
            simulation.write_points(&mut before);
        }
    }
    simulation.write_points(&mut points);
    let crept = points.iter().zip(&before).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    Fallen { worst, settled, crept, points }
}

fn shapes() -> [(&'static str, Obstacle); 3] {
    [
        (
            "box",
            Obstacle::Cuboid {
                center: Vec3::new(-0.2, -0.1, 0.0),
                half: Vec3::new(0.2, 0.1, 0.2),
                axes: Mat3::IDENTITY,
            },
        ),
        (
            "rod of 1 cm",
            Obstacle::Capsule {
                a: Vec3::new(0.05, -0.03, -0.2),
                b: Vec3::new(0.05, -0.03, 0.2),
                radius: 0.005,
            },
        ),
        ("ball of 16 mm", Obstacle::Sphere { center: Vec3::new(0.05, -0.03, 0.005), radius: 0.008 }),
    ]
}

#[test]
fn draped_over_an_edge_a_rod_and_a_ball() {
    for (name, shape) in shapes() {
        for model in Model::ALL {
            let Fallen { worst, settled, crept, points } = fall(shape.clone(), model, Contact::Both, 8);
            let lowest = points.iter().map(|p| p.y).fold(0.0, f32::min);
            println!(
                "{name}, {model:?}: segments {:.3} mm deep, {:.3} in the last second, points {:.3} mm; {:.4} longer; {:.3} mm crept, {:.4} m/s; hangs to {lowest}",
                worst.segment_depth * 1e3,
                settled.segment_depth * 1e3,
                worst.max_depth * 1e3,
                worst.stretch_max,
                crept * 1e3,
                settled.speed_max,
            );
            assert!(
                worst.segment_depth < 0.06 * f64::from(SEGMENT),
                "{name}, {model:?}: {} m deep",
                worst.segment_depth
            );
            assert!(
                settled.segment_depth < 0.03 * f64::from(SEGMENT),
                "{name}, {model:?}: {} m deep",
                settled.segment_depth
            );
            assert!(worst.max_depth < 1e-4, "{name}, {model:?}: a point {} m deep", worst.max_depth);
            assert!(worst.stretch_max < 0.011, "{name}, {model:?}: {} longer", worst.stretch_max);
            assert!(lowest < -0.1, "{name}, {model:?}: nothing hangs over");
            assert!(crept < 5e-4, "{name}, {model:?}: {crept} m in a second at rest");
        }
    }
}

#[test]
fn whatever_the_response() {
    for (name, shape) in shapes() {
        for contact in Contact::ALL {
            let Fallen { worst, settled, crept, .. } = fall(shape.clone(), Model::Auto, contact, 8);
            println!(
                "{name}, {contact:?}: segments {:.3} mm deep, {:.3} in the last second, points {:.3}, {:.3} mm; {:.3} mm crept, {:.4} m/s",
                worst.segment_depth * 1e3,
                settled.segment_depth * 1e3,
                worst.max_depth * 1e3,
                settled.max_depth * 1e3,
                crept * 1e3,
                settled.speed_max,
            );
            assert!(settled.segment_depth < 1e-3, "{name}, {contact:?}: {} m deep", settled.segment_depth);
            // One of the two alone gives way where hair lands: a force by what hair falls in a substep or two, a projection where it is for the inner end.
            let landing = if contact == Contact::Both { 0.06 * f64::from(SEGMENT) } else { 1e-2 };
            assert!(worst.segment_depth < landing, "{name}, {contact:?}: {} m deep", worst.segment_depth);
        }
    }
}
