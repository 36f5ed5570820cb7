//! Promise: one groom may contain strands of 3 to 1,024 points and of 1 mm to 2 m, with segments of 0.1 mm
//! next to segments of 5 cm, in every model.
//!
//! The strands stay as authored, are shaken, and keep the lengths of their segments. The root transfers its
//! full motion to the strand: position, direction, and twist about the direction.

use glam::{Quat, Vec3};
use hairspring::{
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{REST, points, translation};
use std::{f32::consts::TAU, sync::Arc};

/// A strand of `points` points that hangs down by `length` [m] in an open coil.
fn coil(points: usize, length: f32) -> Vec<Vec3> {
    (0..points)
        .map(|i| {
            let t = i as f32 / (points - 1) as f32;
            let (sin, cos) = (6.0 * t).sin_cos();
            let radius = 0.05 * length;
            Vec3::new(radius * (cos - 1.0), -length * t, radius * sin)
        })
        .collect()
}

fn mixed() -> Groom {
    // Alternating segments of 0.1 mm and 5 cm, straight down.
    let mut side_by_side = vec![Vec3::ZERO];
    for i in 0..20 {
        let step = if i % 2 == 0 { 1e-4 } else { 0.05 };
        side_by_side.push(side_by_side[i] - Vec3::Y * step);
    }
    let strands = [
        coil(3, 0.001),
        coil(3, 0.3),
        coil(8, 0.001),
        coil(40, 0.004),
        coil(64, 0.25),
        coil(127, 0.4),
        coil(256, 0.6),
        coil(1024, 2.0),
        side_by_side,
    ];
    Groom::from_strands(strands, 40e-6)
}

/// Steps by a frame, at the end of which the common root of all strands has this pose.
fn step(simulation: &mut Simulation, pose: RigidTransform) {
    let roots = vec![pose; simulation.strand_count()];
    hairspring_test::step(simulation, pose, &roots, &[]);
}

/// Shakes the root by 5 cm at 2 Hz.
fn shaken(frame: u32) -> RigidTransform {
    translation(Vec3::X * (0.05 * (TAU * 2.0 * frame as f32 / 60.0).sin()))
}

#[test]
fn mixed_strands_are_stable_in_one_groom() {
    let groom = Arc::new(mixed());
    for model in Model::ALL {
        let material = Material { model, bend: 4.0, ..Material::default() };
        let mut simulation = Simulation::builder(groom.clone()).materials(&[material]).build().unwrap();
        assert_eq!(simulation.point_count(), groom.points.len(), "points are missing");
        (0..120).for_each(|_| step(&mut simulation, REST));
        let points = points(&simulation);
        let moved: f32 =
            points.iter().zip(&groom.points).map(|(a, b)| a.distance(*b)).sum::<f32>() / points.len() as f32;
        assert!(moved < 1e-3, "{model:?}: points move by {moved} m in the mean in two seconds at rest");

        for frame in 0..60 {
            step(&mut simulation, shaken(frame));
            let m = simulation.measure(&[]);
            assert_eq!(m.non_finite, 0, "{model:?}, frame {frame}");
        }
        (0..30).for_each(|_| step(&mut simulation, REST));
        let m = simulation.measure(&[]);
        println!("{model:?}: {moved:e} m at rest, after the shake {m:?}");
        assert!(
            m.stretch_max < 0.011,
            "{model:?}: half a second after the shake the stretch of a segment is {}",
            m.stretch_max
        );
    }
}

/// Fine and long strands, whose segments are stiff relative to their mass, stay at rest and come to rest
/// again, in every model.
#[test]
fn long_strands_come_to_rest() {
    let strands: [(usize, f32); 7] =
        [(64, 2.0), (256, 0.6), (512, 2.0), (1024, 1.0), (1024, 1.5), (1024, 3.0), (1024, 6.0)];
    let groom = Arc::new(Groom::from_strands(strands.map(|(points, length)| coil(points, length)), 40e-6));
    for model in Model::ALL {
        for substeps in [4, 10] {
            let material = Material { model, bend: 4.0, ..Material::default() };
            let solver = Solver { substeps, ..Solver::default() };
            let mut simulation =
                Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap();
            // The mean speed of the fastest strand [m/s].
            let speed = |simulation: &mut Simulation| {
                let before = points(simulation);
                step(simulation, REST);
                let after = points(simulation);
                let mean = |s: usize| {
                    let range = groom.range(s);
                    let count = range.len() as f32;
                    60.0 * range.map(|i| before[i].distance(after[i])).sum::<f32>() / count
                };
                (0..groom.strand_count()).map(mean).fold(0.0, f32::max)
            };
            (0..120).for_each(|_| step(&mut simulation, REST));
            let at_rest = speed(&mut simulation);
            (0..60).for_each(|frame| step(&mut simulation, shaken(frame)));
            // With four substeps, segments of 1 mm are too soft to hold the style, and take longer to come
            // to rest.
            let seconds = if substeps == 4 { 8 } else { 2 };
            (0..60 * seconds).for_each(|_| step(&mut simulation, REST));
            let after_shake = speed(&mut simulation);
            println!(
                "{model:?}, {substeps} substeps: {at_rest} m/s at rest, {after_shake} m/s {seconds} seconds after a shake"
            );
            assert!(at_rest < 0.01, "{model:?}, {substeps} substeps: {at_rest} m/s at rest");
            assert!(
                after_shake < 0.02,
                "{model:?}, {substeps} substeps: {after_shake} m/s {seconds} seconds after a shake"
            );
        }
    }
}

/// A curl extends sideways from its root. When the root twists about the first segment, the curl turns with
/// it.
#[test]
fn the_root_transfers_position_direction_and_twist() {
    let strand: Vec<Vec3> = (0..12)
        .map(|i| {
            let s = i as f32 / 11.0;
            Vec3::new(0.02 * s * s, -0.03 * s, 0.0)
        })
        .collect();
    let groom = Arc::new(Groom::from_strands([strand.clone()], 60e-6));
    let axis = (strand[1] - strand[0]).normalize();
    let twist = RigidTransform { translation: Vec3::ZERO, rotation: Quat::from_axis_angle(axis, 1.5) };
    let tilt =
        RigidTransform { translation: Vec3::new(0.3, -0.2, 0.1), rotation: Quat::from_rotation_z(1.0) };
    for model in [Model::Auto, Model::Rod, Model::Springs, Model::Curvature] {
        for pose in [twist, tilt] {
            let material = Material { model, bend: 20.0, ..Material::default() };
            // Without gravity the strand rests in its own shape, whatever the rotation of its root.
            let mut simulation = Simulation::builder(groom.clone())
                .materials(&[material])
                .gravity(Vec3::ZERO)
                .build()
                .unwrap();
            for frame in 1..=120 {
                let share = (frame as f32 / 60.0).min(1.0);
                let on_the_way = RigidTransform {
                    translation: pose.translation * share,
                    rotation: Quat::IDENTITY.slerp(pose.rotation, share),
                };
                step(&mut simulation, on_the_way);
            }
            for (now, authored) in points(&simulation).iter().zip(&strand) {
                let expected = pose.translation + pose.rotation * *authored;
                assert!(now.distance(expected) < 2e-4, "{model:?}: {now} instead of {expected}");
            }
        }
    }
}
