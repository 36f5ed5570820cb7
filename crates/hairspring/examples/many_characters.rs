//! 1,000 characters that share one model: rest shapes and materials are in memory once.

use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    groom::Groom,
    math::RigidTransform,
    simulation::{Simulation, StepInput},
};

/// Runs the example.
pub fn main() {
    let strand = |s: usize| {
        let root = Quat::from_rotation_y(0.39 * s as f32) * Vec3::X * 0.05;
        (0..12).map(move |i| root - Vec3::Y * (0.02 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..16).map(strand), 40e-6);
    let at_rest: Vec<Vec3> = (0..16).map(|s| groom.strand(s)[0]).collect();
    let first = Simulation::builder(groom).build().expect("the groom is valid");
    let mut crowd: Vec<Simulation> = (0..1000).map(|_| first.instance()).collect();

    let roots_of = |pose: &RigidTransform| -> Vec<RigidTransform> {
        let root = |p: &Vec3| RigidTransform { translation: pose.point(*p), rotation: pose.rotation };
        at_rest.iter().map(root).collect()
    };
    // Each stands in a place of its own.
    let place = |k: usize| Vec3::new((k % 32) as f32, 0.0, (k / 32) as f32);
    for (k, character) in crowd.iter_mut().enumerate() {
        let pose = RigidTransform { translation: place(k), rotation: Quat::IDENTITY };
        character.place(pose, &roots_of(&pose));
    }
    for frame in 1..=5 {
        for (k, character) in crowd.iter_mut().enumerate() {
            let anchor = RigidTransform {
                translation: place(k),
                rotation: Quat::from_rotation_y(0.02 * (frame * (k % 7)) as f32),
            };
            let roots = roots_of(&anchor);
            character.step(&StepInput {
                dt: 1.0 / 60.0,
                anchor,
                roots: &roots,
                colliders: &[],
                air: Air::default(),
            });
        }
    }
    let points: usize = crowd.iter().map(Simulation::point_count).sum();
    println!("{} characters, {points} points", crowd.len());
    assert_eq!(points, 192_000);
}
