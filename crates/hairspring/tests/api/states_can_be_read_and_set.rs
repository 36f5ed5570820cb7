//! Promise: positions and velocities can be read and set as plain arrays, with every elastic model, and the
//! simulation continues from them.

use crate::support::{shake, simulation, velocities};
use hairspring::{
    material::{Material, Model},
    settings::Solver,
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
        hair.set_points(&positions, &moving);
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
    hair.set_points(&points(&source), &velocities(&source));
    (25..35).for_each(|frame| {
        shake(&mut source, frame, &[]);
        shake(&mut hair, frame, &[]);
    });
    let difference = farthest(&points(&hair), &points(&source));
    assert!(difference < 1e-4, "{difference} m apart after ten frames");
}

#[test]
#[should_panic(expected = "one entry for each simulated point")]
fn arrays_of_another_length_are_refused() {
    simulation(3, Material::default(), Solver::default()).set_points(&[], &[]);
}
