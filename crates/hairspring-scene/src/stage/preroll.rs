//! Pre-roll: hair falls before the scene begins, and its resting state becomes the groom.
//!
//! Procedurally grown hair stands off the skin as no real hair does. Starting with it would show it fall;
//! balancing it as it stands would make it defy gravity permanently. In the pre-roll it falls once, onto a
//! body that does not move, in still air, with strands passing through each other. The result replaces the
//! groom: rest shapes, the rest volume, follow hairs and every reset use it.

use super::{body::StagedBody, hair::StagedHair, join_grooms};
use crate::Scene;
use hairspring::{
    air::Air,
    math::RigidTransform,
    settings::{Integrator, Neighbours, Solver, Volume},
    simulation::StepInput,
};

/// Frame rate of the fall [Hz]; the number of substeps is the scene's.
const RATE: f32 = 60.0;

/// Lets all of `hair` fall for `scene.solver.preroll` seconds from its groom, starting at rest. `body` must
/// be in its initial pose.
pub(super) fn settle(hair: &mut [StagedHair], scene: &Scene, body: &StagedBody) {
    // Other integrators may be unstable on purpose.
    let solver = Solver { sag_free: false, integrator: Integrator::BackwardEuler, ..scene.solver };
    let poses = body.poses();
    let mut simulation = join_grooms::simulation(hair, scene, solver, body.pose().anchor(), &poses);
    // Volume and strand contact would preserve the volume of hair that stands out.
    simulation.set_volume(&Volume::default());
    simulation.set_neighbours(&Neighbours::default());
    let roots: Vec<RigidTransform> = hair.iter().flat_map(|hair| hair.roots()).copied().collect();
    let drive = StepInput {
        dt: 1.0 / RATE,
        anchor: body.pose().anchor(),
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
