//! A curtain of strands that is shaken, shared by the tests of the interface.

use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    collide::MovingCollider,
    groom::Groom,
    material::Material,
    math::RigidTransform,
    settings::Solver,
    simulation::{Simulation, StepInput},
};

pub const FRAME: f32 = 1.0 / 60.0;

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
    let anchor = RigidTransform {
        translation: Vec3::Z * (0.04 * (0.2 * frame as f32).sin()),
        rotation: Quat::IDENTITY,
    };
    let groom = groom(simulation.strand_count());
    let roots: Vec<_> = (0..groom.strand_count())
        .map(|s| RigidTransform {
            translation: groom.strand(s)[0] + anchor.translation,
            rotation: Quat::IDENTITY,
        })
        .collect();
    simulation.step(&StepInput {
        dt: FRAME,
        anchor,
        roots: &roots,
        obstacles: colliders,
        air: Air::default(),
    });
}

pub fn points(simulation: &Simulation) -> Vec<Vec3> {
    let mut points = vec![Vec3::ZERO; simulation.point_count()];
    simulation.write_points(&mut points);
    points
}

pub fn velocities(simulation: &Simulation) -> Vec<Vec3> {
    let mut velocities = vec![Vec3::ZERO; simulation.point_count()];
    simulation.write_velocities(&mut velocities);
    velocities
}
