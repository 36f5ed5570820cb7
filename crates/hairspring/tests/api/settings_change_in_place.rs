//! Promise: settings on which rest shapes do not depend change in place, with the same bits as a simulation that
//! is built with them and takes over the state. Other changes are refused without effect.

use crate::support::{shake, simulation, velocities};
use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    material::{GlobalShape, Material},
    math::RigidTransform,
    settings::{Integrator, Quality, Response, Solver},
    simulation::Simulation,
};
use hairspring_test::points;

const STRANDS: usize = 10;

fn ball() -> [MovingCollider; 1] {
    let shape = ColliderShape::Sphere { center: Vec3::new(0.03, -0.06, 0.04), radius: 0.03 };
    [MovingCollider::at_rest(shape, RigidTransform::default())]
}

fn base() -> Material {
    Material { tether: 1.0, ..Material::default() }
}

/// A simulation that has run for 20 frames.
fn running() -> Simulation {
    let mut simulation = simulation(STRANDS, base(), Solver::default());
    (0..20).for_each(|frame| shake(&mut simulation, frame, &ball()));
    simulation
}

/// Points and velocities 20 frames later.
fn later(simulation: &mut Simulation) -> (Vec<Vec3>, Vec<Vec3>) {
    (20..40).for_each(|frame| shake(simulation, frame, &ball()));
    (points(simulation), velocities(simulation))
}

#[test]
fn with_the_same_bits_as_a_new_simulation() {
    let (material, solver) = (base, Solver::default);
    let global_shape = GlobalShape { pull: 4.0, ..GlobalShape::default() };
    let changes: [(&str, Material, Solver); 13] = [
        ("drag", Material { drag: 4.0, ..material() }, solver()),
        ("friction", Material { friction: 0.9, ..material() }, solver()),
        ("friction_kinetic", Material { friction_kinetic: 0.2, ..material() }, solver()),
        ("global_shape of the material", Material { global_shape, ..material() }, solver()),
        ("tether", Material { tether: 1.05, ..material() }, solver()),
        ("tether_profile", Material { tether_profile: vec![1.1, 1.02], ..material() }, solver()),
        ("no tether", Material { tether: 0.0, ..material() }, solver()),
        ("contact", material(), Solver { contact: Response::Projection, ..solver() }),
        ("segment_contacts", material(), Solver { segment_contacts: false, ..solver() }),
        ("projection_iterations", material(), Solver { projection_iterations: 0, ..solver() }),
        ("quality", material(), Solver { quality: Quality::High, ..solver() }),
        ("inertia", material(), Solver { inertia: 0.3, ..solver() }),
        ("teleport_distance", material(), Solver { teleport_distance: 1e-4, ..solver() }),
    ];
    let unchanged = later(&mut running());
    for (name, material, solver) in changes {
        let mut rebuilt = simulation(STRANDS, material.clone(), solver);
        rebuilt.take_over(&running());
        let expected = later(&mut rebuilt);
        assert_ne!(expected, unchanged, "{name} has an effect");
        let mut in_place = running();
        let gravity = Vec3::new(0.0, -9.81, 0.0);
        assert_eq!(in_place.update_settings(&[material], solver, gravity), Ok(true), "{name}");
        assert_eq!(later(&mut in_place), expected, "{name}");
    }
}

/// The coefficient is at most 1 along the strand: the new friction, not the old one, determines where.
#[test]
fn friction_changes_with_its_profile() {
    let rough = |friction| Material { friction, friction_profile: vec![1.5, 5.0], ..Material::default() };
    for [old, new] in [[0.2, 0.6], [0.9, 0.1]] {
        let run = |material: Material, then: Option<Material>| {
            let mut simulation = simulation(STRANDS, material, Solver::default());
            (0..20).for_each(|frame| shake(&mut simulation, frame, &ball()));
            if let Some(then) = then {
                let gravity = Vec3::new(0.0, -9.81, 0.0);
                assert_eq!(simulation.update_settings(&[then], Solver::default(), gravity), Ok(true));
            }
            simulation
        };
        let mut rebuilt = simulation(STRANDS, rough(new), Solver::default());
        rebuilt.take_over(&run(rough(old), None));
        assert_eq!(later(&mut run(rough(old), Some(rough(new)))), later(&mut rebuilt), "{old} to {new}");
    }
}

#[test]
fn other_changes_are_refused_without_effect() {
    let gravity = Vec3::new(0.0, -9.81, 0.0);
    let unchanged = later(&mut running());
    let changes: [(&str, Material, Solver, Vec3); 5] = [
        ("bend", Material { bend: 3.0, ..base() }, Solver::default(), gravity),
        ("damping", Material { damping: 0.5, ..base() }, Solver::default(), gravity),
        ("substeps", base(), Solver { substeps: 9, ..Solver::default() }, gravity),
        ("integrator", base(), Solver { integrator: Integrator::Bdf2, ..Solver::default() }, gravity),
        ("gravity", base(), Solver::default(), 0.5 * gravity),
    ];
    for (name, material, solver, gravity) in changes {
        let mut simulation = running();
        assert_eq!(simulation.update_settings(&[material], solver, gravity), Ok(false), "{name}");
        assert_eq!(later(&mut simulation), unchanged, "{name}");
    }
    let mut simulation = running();
    let wrong = Material { friction: f32::NAN, ..base() };
    let error = simulation.update_settings(&[wrong], Solver::default(), gravity).unwrap_err();
    assert_eq!(error.key, "friction");
    let falling = Solver { sag_free: false, ..Solver::default() };
    for solver in [Solver::default(), falling] {
        let error = simulation.update_settings(&[base()], solver, Vec3::NAN).unwrap_err();
        assert_eq!(error.to_string(), "`gravity` must be three numbers from -10000 to 10000 [m/s²]");
    }
    assert_eq!(later(&mut simulation), unchanged, "an invalid value");
}
