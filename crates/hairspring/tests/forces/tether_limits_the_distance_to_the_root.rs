//! Promise: a tether limits the distance of every point from its root, whatever the load. With a tether of
//! t, the limit is t times the largest rest distance of the point and those before it. At rest, and where
//! the limit is not reached, a tether changes nothing. Hair that hangs on it comes to rest.
//!
//! Without a tether, coils under twenty times their weight fall to nearly the length of their hair. (The
//! points before are included because a coil may turn back toward its root, and then reaches its length
//! first.)

use glam::Vec3;
use hairspring::{
    groom::Groom,
    material::{Material, Model},
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{REST, roots, step};
use std::sync::Arc;

const POINTS: usize = 49;

/// Coils of radius 1 cm that hang from the height of the origin.
fn coils() -> Arc<Groom> {
    let strands = (0..9).map(|s| {
        let root = Vec3::X * (0.05 * s as f32);
        (0..POINTS)
            .map(move |i| {
                let turn = i as f32 * 0.5;
                root + Vec3::new(0.01 * (turn.cos() - 1.0), -0.0035 * i as f32, 0.01 * turn.sin())
            })
            .collect::<Vec<_>>()
    });
    Arc::new(Groom::from_strands(strands, 40e-6))
}

/// The result of `seconds` under `g` times gravity.
struct Fall {
    /// The largest distance of a point from its root, relative to the largest rest distance of it and those
    /// before it.
    distance: f32,
    /// Speed of the fastest point at the end [m/s].
    speed: f64,
    points: Vec<Vec3>,
}

fn fall(model: Model, tether: f32, g: f32, seconds: usize) -> Fall {
    let groom = coils();
    let roots = roots(&groom, REST);
    let mut simulation = Simulation::builder(groom.clone())
        .materials(&[Material { model, tether, ..Material::default() }])
        .solver(Solver { sag_free: g == 1.0, ..Solver::default() })
        .gravity(Vec3::NEG_Y * 9.81 * g)
        .build()
        .unwrap();
    let mut points = vec![Vec3::ZERO; simulation.point_count()];
    let (mut most, mut speed) = (0.0f32, 0.0);
    for _ in 0..60 * seconds {
        step(&mut simulation, REST, &roots, &[]);
        let measure = simulation.measure(&[]);
        assert_eq!(measure.non_finite, 0, "{model:?}: points are not finite");
        assert!(measure.stretch_max < 0.011, "{model:?}: a segment is too long: {measure:?}");
        speed = measure.speed_max;
        simulation.write_points(&mut points);
        for (now, rest) in points.chunks(POINTS).zip(groom.points.chunks(POINTS)) {
            let mut farthest = 0.0f32;
            for i in 1..POINTS {
                farthest = farthest.max(rest[i].distance(rest[0]));
                most = most.max(now[i].distance(now[0]) / farthest);
            }
        }
    }
    Fall { distance: most, speed, points }
}

#[test]
fn heavy_coils_fall_to_the_limit() {
    for model in Model::ALL {
        let free = fall(model, 0.0, 20.0, 2).distance;
        assert!(free > 1.5, "{model:?}: without a tether {free}");
        for tether in [1.05, 1.3] {
            let held = fall(model, tether, 20.0, 2).distance;
            println!("{model:?}: {free} without a tether, {held} with one of {tether}");
            assert!(held < tether * 1.0011, "{model:?}: {held} with a tether of {tether}");
            assert!(
                held > tether - 0.05,
                "{model:?}: {held} with a tether of {tether}: hair does not reach the limit"
            );
        }
    }
}

#[test]
fn a_tether_changes_nothing_at_rest() {
    for model in Model::ALL {
        assert_eq!(
            fall(model, 1.01, 1.0, 2).points,
            fall(model, 0.0, 1.0, 2).points,
            "{model:?}: the tether moved hair at rest"
        );
    }
}

#[test]
fn hair_that_hangs_on_a_tether_comes_to_rest() {
    for model in Model::ALL {
        for (tether, g) in [(1.05, 2.0), (1.05, 20.0), (1.3, 20.0)] {
            let speed = fall(model, tether, g, 8).speed;
            assert!(speed < 1e-3, "{model:?}, {tether} under {g} g: {speed} m/s after 8 s");
        }
    }
}
