//! Promise: positions and velocities can be read and set as plain arrays, with every elastic model, and the
//! simulation continues from them.

use crate::support::{shake, simulation, velocities};
use hairspring::{
    material::{Material, Model},
    settings::Solver,
    simulation::PointsError,
};
use hairspring_test::{farthest, points, translation};

#[test]
fn set_states_are_read_back() {
    for model in Model::ALL {
        let material = Material { model, ..Material::default() };
        let mut source = simulation(10, material.clone(), Solver::default());
        (0..25).for_each(|frame| shake(&mut source, frame, &[]));
        let (positions, moving) = (points(&source), velocities(&source));
        let mut hair = simulation(10, material, Solver::default());
        // Roots are driven, so the strands must have the same place as those of the source.
        hair.teleport(translation(positions[0] - points(&hair)[0]));
        hair.set_points(&positions, &moving).unwrap();
        let difference = farthest(&points(&hair), &positions);
        assert!(difference < 1e-6, "{model:?}: the difference is {difference} m");
        assert_eq!(velocities(&hair), moving, "{model:?}: velocities differ");
    }
}

#[test]
fn the_simulation_continues_from_a_set_state() {
    let mut source = simulation(10, Material::default(), Solver::default());
    (0..25).for_each(|frame| shake(&mut source, frame, &[]));
    let mut hair = source.instance();
    hair.set_points(&points(&source), &velocities(&source)).unwrap();
    (25..35).for_each(|frame| {
        shake(&mut source, frame, &[]);
        shake(&mut hair, frame, &[]);
    });
    let difference = farthest(&points(&hair), &points(&source));
    assert!(difference < 1e-4, "{difference} m apart after ten frames");
}

#[test]
fn invalid_arrays_are_refused_and_change_nothing() {
    let mut hair = simulation(3, Material::default(), Solver::default());
    let before = points(&hair);
    let error = hair.set_points(&[], &[]).unwrap_err();
    assert_eq!(error, PointsError::Count { points: 0, velocities: 0, expected: 48 });
    let mut broken = velocities(&hair);
    broken[20].y = f32::NAN;
    assert_eq!(hair.set_points(&before, &broken), Err(PointsError::NotFinite(20)));
    assert_eq!(points(&hair), before);
}
