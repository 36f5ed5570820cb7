//! Promise: hair whose root is covered by a collider comes to rest. A box or a ball that moves over the root, up to 1 mm
//! deep, and 10 mm for hair that is wavy or curly, and stays there, leaves no hair moving faster than 1 mm/s.
//!
//! The first segment cannot leave the collider then. Its contact force used to grow without bound.
//!
//! # Limitations
//! Straight hair whose root is 10 mm deep may tremble by up to 0.3 m/s: it would have to bend sharply at its root to
//! leave.

use glam::{Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::preset,
    simulation::Simulation,
};
use hairspring_test::{REST, line, roots, step, translation};
use std::sync::Arc;

/// Frames in which the collider moves.
const MOVING: usize = 30;

/// The greatest speed [mm/s] of hair in the fifth second after `shape` has moved by `way` [m].
fn speed_at_rest(style: &str, shape: &ColliderShape, way: Vec3) -> f64 {
    let groom = Arc::new(Groom::from_strands([line(Vec3::ZERO, Vec3::NEG_Y * 0.15, 32)], 35e-6));
    let roots = roots(&groom, REST);
    let mut simulation = Simulation::builder(groom).materials(&[preset(style).unwrap()]).build().unwrap();
    let mut fastest = 0.0f64;
    for frame in 0..MOVING + 300 {
        let at = |frame: usize| translation(way * (frame.min(MOVING) as f32 / MOVING as f32));
        let colliders = [MovingCollider::new(shape.clone(), at(frame), at(frame + 1))];
        step(&mut simulation, REST, &roots, &colliders);
        if frame >= MOVING + 240 {
            fastest = fastest.max(simulation.measure(&colliders).speed_max);
        }
    }
    1e3 * fastest
}

#[test]
fn a_box_or_a_ball_over_the_root_leaves_hair_at_rest() {
    let cuboid =
        ColliderShape::Cuboid { center: Vec3::Z * -0.1, half: Vec3::splat(0.05), axes: Mat3::IDENTITY };
    let ball = ColliderShape::Sphere { center: Vec3::Z * -0.1, radius: 0.05 };
    let mut failures = Vec::new();
    for style in ["straight", "wavy", "curly", "coily", "short-fur"] {
        for (name, shape) in [("box", &cuboid), ("ball", &ball)] {
            let bends = !matches!(style, "straight" | "short-fur");
            for depth in [0.0005, 0.001, 0.01].into_iter().filter(|depth| bends || *depth < 0.005) {
                let speed = speed_at_rest(style, shape, Vec3::Z * (0.05 + depth));
                println!("{style}, {name}, {depth} m deep: {speed:.4} mm/s");
                if speed >= 1.0 {
                    failures.push(format!("{style}, {name}, {depth} m deep: {speed} mm/s"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
