//! A curtain of strands that is shaken, shared by the tests of the interface.

use glam::Vec3;
use hairspring::{
    collide::MovingCollider, groom::Groom, material::Material, settings::Solver, simulation::Simulation,
};
use hairspring_test::{roots, step, translation};

/// Strands of 16 points that bend over, 6 mm apart.
pub fn groom(strands: usize) -> Groom {
    let strand = |s: usize| {
        (0..16).map(move |i| {
            let t = i as f32 / 15.0;
            Vec3::new(0.006 * s as f32, 0.04 * (3.0 * t).sin() - 0.15 * t, 0.05 * t)
        })
    };
    Groom::from_strands((0..strands).map(|s| strand(s).collect::<Vec<_>>()), 40e-6)
}

pub fn simulation(strands: usize, material: Material, solver: Solver) -> Simulation {
    Simulation::builder(groom(strands)).materials(&[material]).solver(solver).build().unwrap()
}

/// Steps by one frame of a shake along Z.
pub fn shake(simulation: &mut Simulation, frame: u32, colliders: &[MovingCollider]) {
    let head = translation(Vec3::Z * (0.04 * (0.2 * frame as f32).sin()));
    let roots = roots(&groom(simulation.strand_count()), head);
    step(simulation, head, &roots, colliders);
}

/// Steps by 60 frames of the shake, and asserts that hair touches the colliders.
pub fn shake_in_contact(simulation: &mut Simulation, colliders: &[MovingCollider]) {
    let mut touched = 0;
    for frame in 0..60 {
        shake(simulation, frame, colliders);
        let contacts = simulation.contacts(colliders);
        touched += contacts.points + contacts.segments;
    }
    assert!(touched > 20, "only {touched} contacts");
}

pub fn velocities(simulation: &Simulation) -> Vec<Vec3> {
    let mut velocities = vec![Vec3::ZERO; simulation.point_count()];
    simulation.write_velocities(&mut velocities);
    velocities
}
