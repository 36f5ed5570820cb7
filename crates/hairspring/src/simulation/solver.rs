//! The interface between a simulation and its solver.

use super::{strand_model::StrandModel, strand_state::StrandState};
use crate::{forces::ForceBuffers, strand::frame_context::FrameContext};

/// What a solver reads in the substeps that are due.
pub(super) struct SolverInput<'a> {
    /// Rest shapes, masses, stiffness.
    pub model: &'a StrandModel,
    /// External forces on points, constant over the substeps.
    pub forces: &'a ForceBuffers,
    /// Length and number of the substeps; colliders, wind and anchor at the end of each.
    pub frame: &'a FrameContext,
}

/// Advances strands through substeps. It owns nothing but working memory: model and state are the simulation's.
///
/// A solver may access the arrays of the state itself, or strand by strand by
/// [`StrandRef`](super::strand_ref::StrandRef) and [`StrandMut`](super::strand_ref::StrandMut).
pub(super) trait StrandSolver: Send + Sync {
    /// Runs the substeps `input.frame.now`. Returns true if any number of the state became NaN or infinite; the
    /// simulation then resets those strands.
    fn run(&mut self, input: &SolverInput, state: &mut StrandState) -> bool;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        air::Air,
        groom::Groom,
        math::RigidTransform,
        simulation::{Simulation, StepInput, strand_ref::StrandMut},
    };
    use glam::{Quat, Vec3};

    /// Hair that is rigid: strands move with their roots.
    struct Rigid;

    impl StrandSolver for Rigid {
        fn run(&mut self, input: &SolverInput, state: &mut StrandState) -> bool {
            for lane in input.model.lane_of_strand.iter().map(|lane| *lane as usize) {
                let mut strand = StrandMut::new(input.model, state, lane);
                let rotation = strand.get().root_rotation();
                let points = input.model.groom.strand(strand.get().index());
                for (i, w) in points.windows(2).enumerate() {
                    strand.set_edge(i + 1, rotation * (w[1] - w[0]));
                }
            }
            false
        }
    }

    #[test]
    fn a_simulation_runs_with_another_solver() {
        let strand = (0..8).map(|i| Vec3::new(0.0, -0.02 * i as f32, 0.001 * (i * i) as f32));
        let groom = Groom::from_strands([strand.collect::<Vec<_>>()], 40e-6);
        let mut simulation = Simulation::builder(groom.clone()).build().unwrap();
        simulation.solver = Box::new(Rigid);
        let root = RigidTransform { translation: Vec3::X, rotation: Quat::from_rotation_x(0.5) };
        let roots = [RigidTransform { translation: root.transform_point(groom.points[0]), ..root }];
        simulation.step(&StepInput {
            dt: 0.1,
            anchor: root,
            roots: &roots,
            colliders: &[],
            air: Air::default(),
        });
        let mut points = [Vec3::ZERO; 8];
        simulation.write_points(&mut points);
        for (point, rest) in points.iter().zip(&groom.points) {
            assert!(point.distance(root.transform_point(*rest)) < 1e-6, "{point}");
        }
    }
}
