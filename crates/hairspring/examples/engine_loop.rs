//! An engine's loop: arrays in, a step a frame, positions out.

use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    math::RigidTransform,
    simulation::{Simulation, StepInput},
};

/// Runs the example.
pub fn main() {
    // A row of strands of 16 points, 25 cm long, that begin on a head of 9 cm radius.
    let head = 0.09;
    let strand = |s: usize| {
        let root = Quat::from_rotation_z(0.02 * s as f32 - 0.5) * Vec3::Y * head;
        (0..16).map(move |i| root * (1.0 + 0.185 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..50).map(strand), 40e-6);
    let roots_at_rest: Vec<Vec3> = (0..50).map(|s| groom.strand(s)[0]).collect();
    let mut simulation = Simulation::builder(groom).build().expect("the groom is valid");

    let mut positions = vec![Vec3::ZERO; simulation.point_count()];
    let mut pose = RigidTransform::default();
    for frame in 1..=60 {
        // What the engine's animation says: the head nods.
        let next = RigidTransform {
            translation: Vec3::ZERO,
            rotation: Quat::from_rotation_x(0.3 * (0.1 * frame as f32).sin()),
        };
        let roots: Vec<_> = roots_at_rest
            .iter()
            .map(|root| RigidTransform { translation: next.point(*root), rotation: next.rotation })
            .collect();
        let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: head - 0.001 };
        let report = simulation.step(&StepInput {
            dt: 1.0 / 60.0,
            anchor: next,
            roots: &roots,
            colliders: &[MovingCollider::new(ball, pose, next)],
            air: Air::default(),
        });
        assert_eq!(report.reset_strands, 0);
        pose = next;
        // For the engine's renderer: strand after strand, root to tip [m].
        simulation.write_points(&mut positions);
    }
    println!("{} points, the first tip at {}", positions.len(), positions[15]);
}
