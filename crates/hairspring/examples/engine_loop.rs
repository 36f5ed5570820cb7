//! An engine's loop: arrays in, a step a frame, positions out.

use hairspring::prelude::*;

/// Runs the example.
pub fn main() {
    // A row of strands of 16 points, 25 cm long, that begin on a head of 9 cm radius.
    let head = 0.09;
    let strand = |s: usize| {
        let root = Quat::from_rotation_z(0.02 * s as f32 - 0.5) * Vec3::Y * head;
        (0..16).map(move |i| root * (1.0 + 0.185 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..50).map(strand), 40e-6);
    let mut simulation = Simulation::builder(groom).build().expect("the groom is valid");

    let mut positions = vec![Vec3::ZERO; simulation.point_count()];
    let mut pose = RigidTransform::IDENTITY;
    for frame in 1..=60 {
        // What the engine's animation says: the head nods.
        let next = RigidTransform::from_rotation(Quat::from_rotation_x(0.3 * (0.1 * frame as f32).sin()));
        let roots = simulation.rigid_roots(next);
        let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: head - 0.001 };
        let colliders = [MovingCollider::new(ball, pose, next)];
        let report = simulation.step(&StepInput::new(1.0 / 60.0, next, &roots).with_colliders(&colliders));
        assert_eq!(report.reset_strands, 0);
        pose = next;
        // For the engine's renderer: strand after strand, root to tip [m].
        simulation.write_points(&mut positions);
    }
    println!("{} points, the first tip at {}", positions.len(), positions[15]);
}
