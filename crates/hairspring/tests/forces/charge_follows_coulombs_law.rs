//! Promise: charged bodies move charged hair by Coulomb's law, charged strands repel each other, and no
//! position gives NaN.
//!
//! A limp charged strand near a distant charge hangs like a pendulum in gravity and a uniform field. The
//! tangent of its angle is λE divided by its weight per length. Hair with the same sign of charge as its
//! head stands on end. Without the head's charge, its own charge spreads it.

use glam::Vec3;
use hairspring::{
    forces::charge::{Charged, ChargedBall, Waypoint},
    groom::Groom,
    material::Material,
    settings::Solver,
    simulation::Simulation,
};
use hairspring_test::{REST, line, on_threads, points, roots, step};
use std::f32::consts::PI;

const COULOMB: f32 = 8.99e9;
const RADIUS: f32 = 4e-5;

/// A ball at rest.
fn resting(center: Vec3, radius: f32, charge: f32) -> ChargedBall {
    ChargedBall { centers: [center; 2], radius, charge }
}

/// Limp strands with `charge` [C/m], after `frames` near charged balls.
fn charged(strands: &[Vec<Vec3>], charge: f32, balls: &[ChargedBall], frames: u32) -> Vec<Vec3> {
    let groom = Groom::from_strands(strands, RADIUS);
    let roots = roots(&groom, REST);
    let mut simulation = Simulation::builder(groom)
        .materials(&[Material { bend: 0.01, drag: 4.0, charge, ..Material::default() }])
        .solver(Solver { sag_free: false, ..Solver::default() })
        .build()
        .unwrap();
    simulation.set_charged(balls.iter().copied());
    (0..frames).for_each(|_| _ = step(&mut simulation, REST, &roots, &[]));
    points(&simulation)
}

/// A strand of 20 cm from `root` in `direction`.
fn strand(root: Vec3, direction: Vec3) -> Vec<Vec3> {
    line(root, root + direction * 0.2, 32)
}

#[test]
fn a_charged_strand_hangs_like_a_charged_pendulum() {
    let weight = Material::default().density * PI * RADIUS * RADIUS * 9.81;
    // Two meters away, so that over the strand's motion the field is uniform to a few hundredths.
    let distance = 2.0_f32;
    for tangent in [0.3_f32, 1.0] {
        let (charge, field) = (1e-9_f32, tangent * weight / 1e-9);
        // One body attracts and the other repels. This makes the field more uniform and tests both signs.
        let body = 0.5 * field * distance * distance / COULOMB;
        let balls = [resting(Vec3::X * distance, 0.5, -body), resting(Vec3::X * -distance, 0.5, body)];
        let points = charged(&[strand(Vec3::ZERO, Vec3::NEG_Y)], charge, &balls, 900);
        let chord = points[31] - points[12];
        let angle = (chord.x / -chord.y).atan();
        println!("{} degrees, {} by the closed form", angle.to_degrees(), tangent.atan().to_degrees());
        assert!((angle / tangent.atan() - 1.0).abs() < 0.02, "{} instead of {} rad", angle, tangent.atan());
        assert!(chord.z.abs() < 1e-3, "the strand leaves its plane: {chord}");
    }
}

#[test]
fn hair_with_the_charge_of_its_head_stands_on_end() {
    let ways = (0..200).map(|k| {
        // Evenly spread over a sphere (a spiral of golden angles).
        let y = 1.0 - (k as f32 + 0.5) / 100.0;
        let azimuth = 2.399_963 * k as f32;
        Vec3::new(azimuth.cos(), 0.0, azimuth.sin()) * (1.0 - y * y).sqrt() + Vec3::Y * y
    });
    let ways: Vec<Vec3> = ways.filter(|way| way.y > -0.3).collect();
    let strands: Vec<Vec<Vec3>> = ways.iter().map(|way| strand(*way * 0.1, *way)).collect();
    // Mean distance of the tips from the center, and their mean height.
    let tips = |charge: f32, balls: &[ChargedBall]| {
        let points = charged(&strands, charge, balls, 240);
        let tips = || points.chunks(32).map(|s| s[31]);
        (
            tips().map(|p| p.length()).sum::<f32>() / ways.len() as f32,
            tips().map(|p| p.y).sum::<f32>() / ways.len() as f32,
        )
    };
    let head = [resting(Vec3::ZERO, 0.1, 1e-6)];
    let (_, fallen) = tips(0.0, &head);
    // The force is ten times its weight at the root and five times at the tip.
    let (out, height) = tips(3e-9, &head);
    let (apart, _) = tips(3e-9, &[]);
    let (together, _) = tips(0.0, &[]);
    println!(
        "tips at {fallen} m, charged at {height} m and {out} m from the center; with only the hair's charge {apart} m, without {together} m"
    );
    assert!(
        out > 0.29 && height > fallen + 0.2,
        "tips are {out} m from the center, at a height of {height} m"
    );
    assert!(apart > together + 0.03, "charged hair: {apart} m, without charge {together} m");
}

#[test]
fn hair_at_the_center_of_a_strong_charge_stays_finite() {
    for body in [-1e-3, 1e-3] {
        for charge in [1e-9, 1e-6] {
            let through = strand(Vec3::new(0.0, 0.1, 0.0), Vec3::NEG_Y);
            let centers = [through[15], Vec3::ZERO, through[31]];
            let balls = centers.map(|center| resting(center, 0.01, body));
            let points = charged(&[through.clone(), through], charge, &balls, 120);
            assert!(points.iter().all(|p| p.is_finite() && p.length() < 0.35), "{body} C, {charge} C/m");
        }
    }
}

#[test]
fn charged_hair_is_independent_of_threads() {
    let strands: Vec<Vec<Vec3>> = (0..600)
        .map(|k| strand(Vec3::new((k % 20) as f32, 0.0, (k / 20) as f32) * 0.01, Vec3::NEG_Y))
        .collect();
    let balls = [resting(Vec3::Z * 0.5, 0.1, -1e-7)];
    let play = |threads| on_threads(threads, || charged(&strands, 1e-9, &balls, 20));
    let one = play(1);
    assert!(one == play(2), "two threads give other bits than one");
    assert!(one == play(7), "seven threads give other bits than one");
}

#[test]
fn a_path_is_followed_in_its_time() {
    let path = vec![
        Waypoint { time: 1.0, center: Vec3::X },
        Waypoint { time: 3.0, center: Vec3::new(1.0, 2.0, 0.0) },
    ];
    let balloon = Charged { joint: None, center: Vec3::ZERO, radius: 0.1, charge: 1e-7, solid: true, path };
    for (time, center) in [
        (0.0, Vec3::ZERO),
        (0.5, Vec3::X * 0.5),
        (2.0, Vec3::new(1.0, 1.0, 0.0)),
        (9.0, Vec3::new(1.0, 2.0, 0.0)),
    ] {
        assert_eq!(balloon.center(time), center);
    }
}
