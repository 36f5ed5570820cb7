//! A distance field from an array, as a game engine or a physics library has it.

use hairspring::{glam::UVec3, prelude::*};
use std::sync::Arc;

/// Runs the example.
pub fn main() {
    // Samples of a rounded box, 4 mm apart.
    let (origin, cell, size) = (Vec3::new(-0.1, -0.12, -0.1), 0.004, UVec3::new(51, 31, 51));
    let mut samples = Vec::new();
    for z in 0..size.z {
        for y in 0..size.y {
            for x in 0..size.x {
                let p = origin + UVec3::new(x, y, z).as_vec3() * cell - Vec3::Y * -0.06;
                let q = p.abs() - Vec3::new(0.06, 0.02, 0.06);
                samples.push(q.max(Vec3::ZERO).length() + q.max_element().min(0.0) - 0.01);
            }
        }
    }
    let field = SignedDistanceField::from_samples(origin, cell, size, samples).expect("a sample a node");

    let strand = |s: i32| {
        let root = Vec3::new(-0.08, 0.03, 0.01 * s as f32);
        (0..20).map(|i| root + Vec3::X * (0.01 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((-3..=3).map(strand), 40e-6);
    let solver = Solver { sag_free: false, ..Solver::default() };
    let mut simulation = Simulation::builder(groom).solver(solver).build().expect("the groom is valid");
    let shape = ColliderShape::Field(Arc::new(field));
    let anchor = RigidTransform::IDENTITY;
    let roots = simulation.rigid_roots(anchor);
    let colliders = [MovingCollider::at_rest(shape, anchor)];
    for _ in 0..120 {
        simulation.step(&StepInput::new(1.0 / 60.0, anchor, &roots).with_colliders(&colliders));
    }
    let (found, measure) = (simulation.contacts(&colliders), simulation.measure(&colliders));
    let contacts = found.points + found.segments;
    println!("{contacts} points and segments lie on the box, {:.3} mm deep at most", 1e3 * measure.max_depth);
    assert!(contacts > 0 && measure.max_depth < 1e-4);
}
