//! Pre-roll: hair falls before the scene begins, and its resting state becomes the groom.
//!
//! Procedurally grown hair stands off the skin as no real hair does. Starting with it would show it fall;
//! balancing it as it stands would make it defy gravity permanently. In the pre-roll it falls once, onto a
//! body that does not move, in still air, with strands passing through each other. The result replaces the
//! groom: rest shapes, the rest volume, follow hairs and every reset use it.
//!
//! Colliders that are put on hair push it out in the pre-roll (`initial_push.rs`). Without `solver.preroll`, hair
//! keeps its balance meanwhile.

use super::{
    body::StagedBody,
    hair::StagedHair,
    initial_push::{self, Motion},
    join_grooms,
};
use crate::Scene;
use hairspring::{
    air::Air,
    math::RigidTransform,
    settings::{Integrator, Neighbours, Solver, Volume},
    simulation::StepInput,
};

/// Frame rate of the pre-roll [Hz]; the number of substeps is the scene's.
const RATE: f32 = 60.0;

/// Shortest pre-roll in which colliders push hair out [s].
const PUSH: f32 = 2.0;

/// Fraction of the pre-roll after which the pushing colliders have their own size. In the rest, hair comes to rest.
const MOVING: f32 = 0.6;

/// Lets all of `hair` fall for `scene.solver.preroll` seconds from its groom, starting at rest, and pushes it out of
/// the colliders that push. `body` must be in its initial pose. Without a pre-roll, hair is not changed. `progress` is
/// called before the first frame and after each, with the number of finished frames and of all.
pub(super) fn settle(
    hair: &mut [StagedHair],
    scene: &Scene,
    body: &StagedBody,
    progress: &mut dyn FnMut(usize, usize),
) {
    let pushes = body.initial_pushes();
    let falls = scene.solver.preroll > 0.0;
    if !falls && pushes.is_empty() {
        return;
    }
    // Other integrators may be unstable on purpose.
    let sag_free = scene.solver.sag_free && !falls;
    let solver = Solver { sag_free, integrator: Integrator::BackwardEuler, ..scene.solver };
    let anchor = body.pose().anchor();
    let length = if pushes.is_empty() { scene.solver.preroll } else { scene.solver.preroll.max(PUSH) };
    let frames = (length * RATE).ceil();
    progress(0, frames as usize);
    let mut simulation = join_grooms::simulation(hair, scene, solver, anchor, &body.keeping_poses());
    // Volume and strand contact would preserve the volume of hair that stands out.
    simulation.set_volume(&Volume::default()).expect("settings of a scene are in range");
    simulation.set_neighbours(&Neighbours::default()).expect("settings of a scene are in range");
    let roots: Vec<RigidTransform> = hair.iter().flat_map(|hair| hair.roots()).copied().collect();
    let mut colliders = body.colliders().to_vec();
    let motions: Vec<Motion> = initial_push::motions(hair, body);
    for frame in 0..frames as usize {
        let moved = |frame: usize| (frame as f32 / (MOVING * frames)).min(1.0);
        for (push, motion) in pushes.iter().zip(&motions) {
            motion.set(&mut colliders[push.collider].shape, (moved(frame), moved(frame + 1)));
        }
        simulation.step(&StepInput {
            dt: 1.0 / RATE,
            anchor,
            roots: &roots,
            colliders: &colliders,
            air: Air::default(),
        });
        progress(frame + 1, frames as usize);
    }
    for hair in hair {
        hair.rest_as(&simulation, body, &body.poses());
    }
}
