//! 1,000 characters that share one model: rest shapes and materials are in memory once.

use hairspring::prelude::*;

/// Runs the example.
pub fn main() {
    let strand = |s: usize| {
        let root = Quat::from_rotation_y(0.39 * s as f32) * Vec3::X * 0.05;
        (0..12).map(move |i| root - Vec3::Y * (0.02 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..16).map(strand), 40e-6);
    let first = Simulation::builder(groom).build().expect("the groom is valid");
    let mut crowd: Vec<Simulation> = (0..1000).map(|_| first.instance()).collect();

    // Each stands in a place of its own.
    let place = |k: usize| Vec3::new((k % 32) as f32, 0.0, (k / 32) as f32);
    for (k, character) in crowd.iter_mut().enumerate() {
        let pose = RigidTransform::from_translation(place(k));
        character.place(pose, &first.rigid_roots(pose));
    }
    for frame in 1..=5 {
        for (k, character) in crowd.iter_mut().enumerate() {
            let turn = Quat::from_rotation_y(0.02 * (frame * (k % 7)) as f32);
            let anchor = RigidTransform::new(place(k), turn);
            character.step(&StepInput::new(1.0 / 60.0, anchor, &first.rigid_roots(anchor)));
        }
    }
    let points: usize = crowd.iter().map(Simulation::point_count).sum();
    println!("{} characters, {points} points", crowd.len());
    assert_eq!(points, 192_000);
}
