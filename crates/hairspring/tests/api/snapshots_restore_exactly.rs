//! Promise: after a snapshot is restored, the same inputs give the same bits again. This holds with every
//! elastic model, with either implicit integrator, with contact, with volume and strand contact, and with
//! manipulators. Simulations that share one model give the same bits as simulations with a model each.

use crate::support::{groom, shake, simulation, velocities};
use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    forces::{ForceField, Manipulator, StrandView, grab::Grab},
    groom::Groom,
    material::{Material, Model},
    settings::{Integrator, Neighbours, Solver, Volume, VolumeMethod},
    simulation::{Simulation, SnapshotMismatch},
};
use hairspring_test::{REST, points};
use std::sync::Arc;

fn ball() -> [MovingCollider; 1] {
    let shape = ColliderShape::Sphere { center: Vec3::new(0.03, -0.06, 0.04), radius: 0.03 };
    [MovingCollider::at_rest(shape, REST)]
}

fn assert_repeats(what: &str, mut simulation: Simulation) {
    (0..20).for_each(|frame| shake(&mut simulation, frame, &ball()));
    let snapshot = simulation.snapshot();
    let mut play = || {
        (20..50).for_each(|frame| shake(&mut simulation, frame, &ball()));
        let out = (points(&simulation), velocities(&simulation));
        simulation.restore(&snapshot).unwrap();
        out
    };
    let (first, again) = (play(), play());
    assert_eq!(first, again, "{what}: the repetition differs");
    let mut other = simulation.instance();
    if simulation.volume().is_none() && simulation.neighbours().is_none() {
        (20..50).for_each(|frame| shake(&mut other, frame, &ball()));
        assert_eq!((points(&other), velocities(&other)), first, "{what}: another instance differs");
    }
}

#[test]
fn with_every_model_and_integrator() {
    for model in Model::ALL {
        for integrator in [Integrator::BackwardEuler, Integrator::Bdf2] {
            let material = Material { model, ..Material::default() };
            let solver = Solver { integrator, ..Solver::default() };
            assert_repeats(&format!("{model:?}, {integrator:?}"), simulation(10, material, solver));
        }
    }
}

#[test]
fn with_volume_and_strand_contact() {
    for method in [VolumeMethod::Density, VolumeMethod::Incompressible] {
        let mut hair = simulation(20, Material::default(), Solver::default());
        hair.set_volume(&Volume { method, ..Volume::default() }).unwrap();
        assert_repeats(&format!("{method:?}"), hair);
    }
    let mut hair = simulation(20, Material::default(), Solver::default());
    hair.set_neighbours(&Neighbours { on: true, stiction: 1e-6, ..Neighbours::default() }).unwrap();
    assert_repeats("strand contact", hair);
}

#[test]
fn with_dense_hair_that_carries_air() {
    let mut hair = simulation(20, Material::default(), Solver::default());
    hair.set_hair_multiplicity(vec![500.0; 20]);
    hair.set_self_occlusion(&[]);
    assert_repeats("dense hair", hair);
}

#[test]
fn with_a_manipulator() {
    let mut hair = simulation(10, Material::default(), Solver::default());
    let grab = Grab { center: Vec3::new(0.0, -0.1, 0.03), radius: 0.05, pull: 60.0, damping: 1.0 };
    hair.add_manipulator(Manipulator::Grab(grab), REST);
    assert_repeats("a grab", hair);
}

/// The groom of ten strands, the last of which ends a point early.
fn shorter() -> Groom {
    let mut groom = groom(10);
    groom.points.pop();
    groom.radii.pop();
    groom.offsets[10] -= 1;
    groom
}

/// A force field without force.
struct Calm;

impl ForceField for Calm {
    fn apply(&self, _: &mut StrandView) {}
}

#[test]
fn handles_are_not_used_again() {
    let mut hair = simulation(10, Material::default(), Solver::default());
    let before = hair.snapshot();
    let grab = Grab { center: Vec3::ZERO, radius: 0.05, pull: 60.0, damping: 1.0 };
    let first = hair.add_manipulator(Manipulator::Grab(grab), REST);
    hair.restore(&before).unwrap();
    let second = hair.add_manipulator(Manipulator::Grab(grab), REST);
    assert_ne!(first, second);
    hair.remove_manipulator(first);
    assert!(hair.attached_points(second).next().is_some());
    let first = hair.add_force(Arc::new(Calm));
    hair.remove_force(first);
    let second = hair.add_force(Arc::new(Calm));
    assert!(hair.remove_force(first).is_none() && hair.remove_force(second).is_some());
    let mut next = simulation(10, Material::default(), Solver::default());
    next.take_over(&hair);
    let third = next.add_force(Arc::new(Calm));
    assert!(third != first && third != second);
}

#[test]
#[should_panic(
    expected = "both must have the same strands in the same order, with the same numbers of points"
)]
fn strands_with_other_numbers_of_points_are_not_taken_over() {
    let old = Simulation::builder(shorter()).build().unwrap();
    simulation(10, Material::default(), Solver::default()).take_over(&old);
}

#[test]
fn a_snapshot_of_other_hair_is_refused() {
    let mut hair = simulation(10, Material::default(), Solver::default());
    let before = points(&hair);
    let others = [
        simulation(20, Material::default(), Solver::default()),
        simulation(10, Material { model: Model::Springs, ..Material::default() }, Solver::default()),
        simulation(10, Material::default(), Solver { integrator: Integrator::Bdf2, ..Solver::default() }),
        // Arrays of the same lengths: other strands, other numbers of points, another model, another integrator.
        Simulation::builder(groom(20)).strands(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 19]).build().unwrap(),
        Simulation::builder(shorter()).build().unwrap(),
        simulation(10, Material { model: Model::Curvature, ..Material::default() }, Solver::default()),
        simulation(10, Material::default(), Solver { integrator: Integrator::Verlet, ..Solver::default() }),
        simulation(10, Material::default(), Solver { segment_contacts: false, ..Solver::default() }),
    ];
    for other in others {
        assert_eq!(hair.restore(&other.snapshot()), Err(SnapshotMismatch));
    }
    assert_eq!(points(&hair), before);
    assert_eq!(before.len(), groom(10).point_count());
}
