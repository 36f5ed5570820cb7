//! A rehearsal: a few strands of the scene without colliders, simulated through the motion once, to learn how far hair
//! swings from where its roots carry it rigidly.

use super::{Stage, hair::StagedHair, join_grooms};
use crate::Scene;
use glam::Vec3;
use hairspring::{
    air::{Air, Source, WindSource},
    math::RigidTransform,
    settings::{Integrator, Solver},
    simulation::{Simulation, StepInput},
};

/// Frame rate [Hz].
pub(super) const RATE: f64 = 30.0;

/// Longest part of a motion that is rehearsed [s].
pub(super) const LONGEST: f64 = 20.0;

/// Time that is rehearsed if nothing but the air moves [s].
const STILL: f64 = 5.0;

/// Number of strands.
const STRANDS: usize = 96;

/// Maximum number of points of a strand.
const POINTS: usize = 16;

/// A few strands of a scene in simulation.
pub(super) struct Rehearsal<'a> {
    scene: &'a Scene,
    simulation: Simulation,
    /// The groom and the strand in it of each.
    strands: Vec<(usize, usize)>,
    points: Vec<Vec3>,
}

impl<'a> Rehearsal<'a> {
    /// Prepares the strands of `stage` at rest.
    pub(super) fn new(stage: &'a Stage) -> Option<Self> {
        let scene = &stage.scene;
        let each = STRANDS.div_ceil(stage.hair.len().max(1));
        let some = |hair: &StagedHair| {
            let all = hair.simulated_strands();
            all.iter().copied().step_by(all.len().div_ceil(each).max(1)).collect::<Vec<u32>>()
        };
        let groom = join_grooms::join(&stage.hair, some, POINTS);
        let of_groom = |(k, hair): (usize, &StagedHair)| some(hair).into_iter().map(move |s| (k, s as usize));
        let strands: Vec<_> = stage.hair.iter().enumerate().flat_map(of_groom).collect();
        // Other integrators may be unstable on purpose.
        let solver = Solver { integrator: Integrator::BackwardEuler, ..scene.solver };
        let simulation = Simulation::builder(groom)
            .materials(&join_grooms::materials(&stage.hair))
            .solver(solver)
            .gravity(scene.gravity)
            .anchor(stage.body.pose().rest_anchor())
            .build()
            .ok()?;
        let points = vec![Vec3::ZERO; simulation.point_count()];
        Some(Self { scene, simulation, strands, points })
    }

    /// Returns the number of frames that a scene needs; 0 if nothing moves hair.
    pub(super) fn frames(scene: &Scene) -> usize {
        let clip = scene.clip.as_ref().map_or(0.0, |clip| clip.duration());
        let Scene { wind, turbulence, wind_sources, solver, .. } = scene;
        let blown = wind.velocity != Vec3::ZERO || turbulence.is_on() || !wind_sources.is_empty();
        let falls = !solver.sag_free && solver.preroll == 0.0;
        let seconds = if blown || falls { clip.max(STILL) } else { clip };
        (seconds.min(LONGEST) * RATE).ceil() as usize
    }

    /// The groom and the strand in it of each rehearsed strand.
    pub(super) fn strands(&self) -> &[(usize, usize)] {
        &self.strands
    }

    /// Places the strands rigidly, without motion.
    pub(super) fn place(&mut self, anchor: RigidTransform, roots: &[RigidTransform]) {
        self.simulation.place(anchor, roots);
    }

    /// Moves the strands rigidly, as at a cut.
    pub(super) fn teleport(&mut self, by: RigidTransform) {
        self.simulation.teleport(by);
    }

    /// Simulates the frame that begins at `time` [s], to the end with these roots and this anchor, and returns the points.
    pub(super) fn step(&mut self, time: f64, anchor: RigidTransform, roots: &[RigidTransform]) -> &[Vec3] {
        let Scene { wind, turbulence, wind_sources, .. } = self.scene;
        // Where a joint carries a source, it stays at its place at rest.
        let source = |(k, source): (usize, &WindSource)| source.at_time(k, RigidTransform::IDENTITY, time);
        let sources: Vec<Source> = wind_sources.iter().enumerate().map(source).collect();
        self.simulation.step(&StepInput {
            dt: (1.0 / RATE) as f32,
            anchor,
            roots,
            colliders: &[],
            air: Air { wind: *wind, time, sources: &sources, turbulence: *turbulence },
        });
        self.simulation.write_points(&mut self.points);
        &self.points
    }
}
