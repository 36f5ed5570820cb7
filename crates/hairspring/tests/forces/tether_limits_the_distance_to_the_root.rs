//! Promise: a tether limits the distance of every point from its root, whatever the load. With a tether of
//! t, the limit is t times the largest rest distance of the point and those before it. At rest, and where
//! the limit is not reached, a tether changes nothing. Hair that hangs on it comes to rest.
//!
//! Without a tether, coils under twenty times their weight fall to nearly the length of their hair. (The
//! points before are included because a coil may turn back toward its root, and then reaches its length
//! first.)

use glam::Vec3;
use hairspring::{
    groom::{Groom, StrandScale},
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
    let material = Material { model, tether, ..Material::default() };
    fall_of(&coils(), &material, g, seconds)
}

fn fall_of(groom: &Arc<Groom>, material: &Material, g: f32, seconds: usize) -> Fall {
    let model = material.model;
    let roots = roots(groom, REST);
    let mut simulation = Simulation::builder(groom.clone())
        .materials(std::slice::from_ref(material))
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

/// Limits of each point, relative to the largest rest distance of it and those before it.
#[test]
fn the_limit_follows_its_profile_and_the_map() {
    let base = Material { tether: 1.2, ..Material::default() };
    let plain = fall_of(&coils(), &base, 20.0, 2);
    // A profile and a multiplier of the strand that give 1.2, and one below the least, which is 1.
    let mut half = Arc::unwrap_or_clone(coils());
    half.scales = vec![StrandScale { tether: 0.5, ..StrandScale::default() }; 9];
    let half = Arc::new(half);
    let doubled = Material { tether_profile: vec![2.0], ..base.clone() };
    assert_eq!(fall_of(&half, &doubled, 20.0, 2).points, plain.points);
    let least = Material { tether: 1.0, ..base.clone() };
    assert_eq!(fall_of(&half, &base, 20.0, 2).points, fall_of(&coils(), &least, 20.0, 2).points);
    // The tip may go farther than the middle.
    let groom = coils();
    let loose_tip = Material { tether_profile: vec![1.0, 1.0, 1.5], ..base.clone() };
    let fell = fall_of(&groom, &loose_tip, 20.0, 2);
    let reach = |i: usize| {
        let farthest = (1..=i).map(|k| groom.points[k].distance(groom.points[0])).fold(0.0, f32::max);
        fell.points[i].distance(fell.points[0]) / farthest
    };
    let [middle, tip] = [POINTS / 2, POINTS - 1].map(reach);
    println!("{middle} in the middle and {tip} at the tip, where 1.2 and 1.8 are permitted");
    assert!(middle < 1.2 * 1.0011 && tip < 1.8 * 1.0011 && tip > 1.25, "{middle}, {tip}");
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
