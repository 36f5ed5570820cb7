//! Hair falls before the scene begins, and rests where it came to lie.
//!
//! Hair that is grown by a rule stands off the skin as no hair does. To begin with it would be to begin with its fall; to put it in balance as it stands
//! would be hair that defies gravity for good. So it falls once, onto a body that stays as hair is made on it, in still air, strands through each other, and as they lie
//! then they take the place of the groom's: rest shapes, the volume at rest, follow hairs and every reset are of those.

use super::{body::StagedBody, hair::StagedHair, join_grooms};
use crate::Scene;
use hairspring::{
    air::Air,
    math::RigidTransform,
    settings::{Integrator, Neighbours, Solver, Volume},
    simulation::StepInput,
};

/// Frames a second of the fall [Hz]; its substeps are the scene's.
const RATE: f32 = 60.0;

/// Lets all of `hair` fall for `scene.solver.settle` from where its groom has it, at rest there, on `body`, which has just been made.
pub(super) fn settle(hair: &mut [StagedHair], scene: &Scene, body: &StagedBody) {
    // Any other integrator may be there to be seen blowing up.
    let solver = Solver { sag_free: false, integrator: Integrator::BackwardEuler, ..scene.solver };
    let poses = body.poses();
    let mut simulation = join_grooms::simulation(hair, scene, solver, body.anchor(), &poses);
    // The room that they would keep is that of hair which stands out.
    simulation.set_volume(&Volume::default());
    simulation.set_neighbours(&Neighbours::default());
    let roots: Vec<RigidTransform> = hair.iter().flat_map(|hair| hair.roots()).copied().collect();
    let drive = StepInput {
        dt: 1.0 / RATE,
        anchor: body.anchor(),
        roots: &roots,
        obstacles: body.obstacles(),
        air: Air::default(),
    };
    for _ in 0..(scene.solver.preroll * RATE).ceil() as usize {
        simulation.step(&drive);
    }
    for hair in hair {
        hair.rest_as(&simulation, body, &poses);
    }
}
