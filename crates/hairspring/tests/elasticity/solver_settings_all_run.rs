//! Promise: every integrator runs with every model and either quality, and gives valid hair.
//!
//! A small groom, straight and curled, is shaken for half a second. Integrators that exist for comparison
//! (see `compare`) may stretch it, but every point must stay finite. Explicit integrators use 400 substeps,
//! because they are unstable with longer ones.

use glam::Vec3;
use hairspring::{
    air::Air,
    groom::Groom,
    material::{Material, Model},
    settings::{Integrator, Quality, Solver},
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, translation};
use std::sync::Arc;

fn strand(curl: f32) -> Vec<Vec3> {
    (0..24)
        .map(|i| {
            let s = i as f32 / 23.0;
            let (sin, cos) = (12.0 * s).sin_cos();
            Vec3::new(curl * (cos - 1.0), -0.2 * s, curl * sin)
        })
        .collect()
}

#[test]
fn with_every_model_and_quality() {
    let groom = Arc::new(Groom::from_strands([strand(0.0), strand(0.01)], 40e-6));
    for integrator in Integrator::ALL {
        for quality in [Quality::Normal, Quality::High] {
            for model in Model::ALL {
                let explicit = matches!(integrator, Integrator::ExplicitEuler | Integrator::Verlet);
                let substeps = if explicit { 400 } else { 4 };
                let solver = Solver { integrator, quality, substeps, ..Solver::default() };
                let material = Material { model, ..Material::default() };
                let mut simulation =
                    Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap();
                for frame in 0..30 {
                    let x = 0.02 * (std::f32::consts::TAU * 2.0 * frame as f32 * FRAME).sin();
                    let head = translation(Vec3::X * x);
                    let (roots, air) = ([head; 2], Air::default());
                    let input = StepInput { dt: FRAME, anchor: head, roots: &roots, colliders: &[], air };
                    let resets = simulation.step(&input).reset_strands;
                    assert!(
                        explicit || resets == 0,
                        "{integrator:?}, {quality:?}, {model:?}: {resets} resets"
                    );
                }
                let m = simulation.measure(&[]);
                println!("{integrator:?}, {quality:?}, {model:?}: {m:?}");
                assert_eq!(m.non_finite, 0, "{integrator:?}, {quality:?}, {model:?}: points are not finite");
                if matches!(integrator, Integrator::BackwardEuler | Integrator::Bdf2) {
                    assert!(
                        m.stretch_max < 0.011,
                        "{integrator:?}, {quality:?}, {model:?}: stretch {}",
                        m.stretch_max
                    );
                }
            }
        }
    }
}
