//! One step: a frame of root motion, divided into substeps. Each tile runs all of them.

use super::{Simulation, solver::SolverInput};
use crate::parallel::prelude::*;
use crate::{
    air::Air,
    collide::{ColliderPose, FrameColliders, MovingCollider},
    math::RigidTransform,
    settings::{Integrator, Quality, Solver},
    simd::lanes::{LANES, Row},
    strand::{
        frame_context::{FrameContext, Substep},
        segment::segment_contact_unneeded,
        tile::{root, segment_contact},
    },
};
use std::time::Duration;

/// Input of a step. All poses are at the end of the frame; the start is the end of the last step.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug)]
pub struct StepInput<'a> {
    /// Length of the frame [s], above 0. Frames shorter than about 1e-5 s do not advance the hair, because single
    /// precision rounds the motion of a substep to zero.
    pub dt: f32,
    /// Pose of the frame that roots move with (the head). Within the frame, roots follow the arc of its
    /// motion.
    pub anchor: RigidTransform,
    /// World pose of each simulated root, in the order given to [`Simulation::builder`]: position [m], and rotation
    /// since the groom was authored. For roots that move rigidly with the anchor, see
    /// [`Simulation::rigid_roots`].
    pub roots: &'a [RigidTransform],
    /// Colliders.
    pub colliders: &'a [MovingCollider],
    /// Moving air.
    pub air: Air<'a>,
}

impl<'a> StepInput<'a> {
    /// Creates the input of a frame of `dt` [s] without colliders, in still air.
    pub fn new(dt: f32, anchor: RigidTransform, roots: &'a [RigidTransform]) -> Self {
        Self { dt, anchor, roots, colliders: &[], air: Air::default() }
    }

    /// Sets the colliders.
    pub fn with_colliders(self, colliders: &'a [MovingCollider]) -> Self {
        Self { colliders, ..self }
    }

    /// Sets the air.
    pub fn with_air(self, air: Air<'a>) -> Self {
        Self { air, ..self }
    }
}

/// The result of a step. Counts that need a pass over the points are made on request: contacts and distance
/// queries by [`Simulation::contacts`], each contact by [`Simulation::contact_points`], lengths and depths by
/// [`Simulation::measure`].
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct StepReport {
    /// Number of substeps.
    pub substeps: u32,
    /// Number of strands with non-finite state that were reset to their rest shape at the root.
    pub reset_strands: usize,
    /// Times of the stages.
    pub times: StepTimes,
}

/// Durations of the stages of a step. Substep poses and manipulator updates are not included.
///
/// For an example, see [`simulation`](crate::simulation).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct StepTimes {
    /// The hair volume: density and forces, in each of the volume's intervals.
    pub volume: Duration,
    /// Roots, wind, global shapes, charge and manipulators, once a frame.
    pub forces: Duration,
    /// All substeps of all strands: assembly, solve, projection, contact with colliders, strain limit.
    pub solve: Duration,
    /// Strand contact, after each substep.
    pub neighbours: Duration,
}

/// Reference frame length of `Solver::substeps` [s].
const FRAME: f32 = 1.0 / 60.0;

/// Factor by which a substep may exceed its nominal length [1], so that a frame at 23.976 Hz has as many
/// substeps as one at 24 Hz.
pub(super) const SUBSTEP_TOLERANCE: f64 = 1.0015;

/// Upper limit of the substeps in a step. It bounds the cost of a very large `dt`. The number is then rounded up to
/// a multiple of the time slices of the colliders.
const MAX_SUBSTEPS_PER_STEP: u32 = 4096;

/// Local–global iterations in a substep at normal quality (Liu 2013, §6: ten).
const LOCAL_GLOBAL: u32 = 10;

/// Largest number of Newton iterations in a substep at high quality.
const NEWTON: u32 = 12;

/// Number of tiles whose roots one task moves.
const TILES_PER_TASK: usize = 64;

/// Largest length of a substep [s].
pub(super) fn substep_length(solver: &Solver) -> f64 {
    f64::from(FRAME) / f64::from(solver.substeps.max(1))
}

impl Simulation {
    /// Advances all strands to the end of a frame.
    ///
    /// The frame is divided into equal substeps. Each is at most 1/60 s over `solver.substeps` long, with a
    /// tolerance of 0.15 %. The substep length is the same at 24, 30 and 60 Hz. Roots are exactly on the skin at the
    /// end of each frame. More substeps are used where a body that is fast relative to its thickness passes through
    /// the hair. A step has at most 4096 substeps, rounded up to a multiple of the time slices of deforming
    /// colliders. In longer frames (17 s with 4 substeps in 1/60 s), the substeps are longer.
    ///
    /// State that is not finite, from input that is not, is reset and counted in the report.
    ///
    /// # Panics
    /// If `input.roots` is not as long as [`Simulation::strand_count`], or `dt` is not above 0.
    /// [`Simulation::try_step`] returns an error instead.
    pub fn step(&mut self, input: &StepInput) -> StepReport {
        assert_eq!(
            input.roots.len(),
            self.model.lane_of_strand.len(),
            "one root pose for each simulated strand"
        );
        assert!(input.dt > 0.0, "`dt` must be positive");
        let solver = self.model.solver;
        let carried = self.carry_along(input);
        // For bodies with several time slices, each slice has the same number of substeps.
        let parts = input.colliders.iter().map(|o| o.shape.time_slices() as u32).max().unwrap_or(1);
        let unrefined =
            ((f64::from(input.dt) / (substep_length(&solver) * SUBSTEP_TOLERANCE)).ceil() as u32).max(1);
        let substeps = unrefined
            .max(self.substeps_past(input, carried.as_ref()))
            .min(MAX_SUBSTEPS_PER_STEP)
            .next_multiple_of(parts);
        let mut frame = std::mem::take(&mut self.frame);
        let looked_at = frame.segments;
        self.fill_frame(input, carried.as_ref(), substeps, &mut frame);
        frame.relaxation = (unrefined as f32 / substeps as f32).min(1.0);
        if looked_at && !frame.segments {
            // Discard the segment contacts: nothing would update them until segments are tested again.
            self.state.segment_contacts.fill([Row::default(); segment_contact::ROWS]);
        }
        self.begin_manipulators(&FrameColliders::new((input.colliders, carried.as_ref())));
        let (reset_strands, times) = self.run_substeps(input, carried.as_ref(), &mut frame);
        self.end_holds();
        self.end_manipulators(input.dt);
        self.state.last_h = frame.h;
        // Release the colliders' shapes to the caller.
        frame.substeps.iter_mut().for_each(|s| s.colliders.clear());
        self.frame = frame;
        StepReport { substeps, reset_strands, times }
    }

    /// Runs the substeps of `frame` that are due now. Returns the number of strands that were reset
    /// because of non-finite state.
    pub(super) fn run(&mut self, frame: &FrameContext) -> usize {
        let input = SolverInput { model: &self.model, forces: &self.forces, frame };
        let reset = self.solver.run(&input, &mut self.state);
        if reset { self.reset_non_finite() } else { 0 }
    }

    /// Fills `frame` for a frame, reusing its memory.
    fn fill_frame(
        &self,
        input: &StepInput,
        carried: Option<&RigidTransform>,
        count: u32,
        frame: &mut FrameContext,
    ) {
        let from = self.state.anchor;
        frame.h = input.dt / count as f32;
        let solver = self.model.solver;
        frame.integrator = solver.integrator;
        frame.iterations = match (solver.integrator, solver.quality) {
            (Integrator::LocalGlobal, Quality::Normal) => LOCAL_GLOBAL,
            (Integrator::LocalGlobal, Quality::High) => 4 * LOCAL_GLOBAL,
            (_, Quality::Normal) => 1,
            (_, Quality::High) => NEWTON,
        };
        frame.continues = (frame.h / self.state.last_h - 1.0).abs() < 1e-3;
        frame.response = solver.contact;
        // For the largest length that a segment can have. Without a strain limit, segments are always tested.
        let may_cut = |o: &MovingCollider| {
            !(solver.integrator.limits_strain()
                && segment_contact_unneeded(self.model.longest_segment, o.shape.roundness()))
        };
        frame.segments = solver.segment_contacts && input.colliders.iter().any(may_cut);
        frame.projection_iterations = solver.projection_iterations;
        frame.gravity = self.model.gravity;
        frame.anchor = from.matrix();
        frame.substeps.resize_with(count as usize, Substep::default);
        frame.now = 0..count as usize;
        for (k, substep) in frame.substeps.iter_mut().enumerate() {
            let fraction = (k + 1) as f32 / count as f32;
            let before = k as f32 / count as f32;
            substep.fraction = fraction;
            substep.anchor = from.lerp(&input.anchor, fraction).matrix();
            substep.wind = input.air.uniform(fraction * input.dt);
            substep.colliders.clear();
            substep.colliders.extend(input.colliders.iter().map(|o| {
                let start = o.start(carried);
                let at = |t: f32| start.lerp(&o.end, t).matrix();
                let (parts, count) = (o.shape.time_slices(), count as usize);
                let shape = o.shape.time_slice(k * parts / count);
                ColliderPose::new(shape, at(before), at(fraction), parts as f32 / count as f32)
            }));
        }
    }

    /// Makes the root poses of the last frame the start and those of `input` the end, both relative to the
    /// anchor.
    pub(super) fn move_roots(&mut self, input: &StepInput) {
        let turn = input.anchor.rotation.inverse();
        let tiles = self.state.roots.par_iter_mut().zip(self.model.strand_of_lane.par_chunks(LANES));
        tiles.with_min_len(TILES_PER_TASK).for_each(|(rows, asked)| {
            for k in 0..root::END {
                rows[root::START + k] = rows[root::END + k];
            }
            let start = root::TURN_START;
            for (lane, k) in asked.iter().enumerate() {
                let Some(root) = input.roots.get(*k as usize) else { continue };
                let before = glam::Quat::from_array([0, 1, 2, 3].map(|k| rows[start + k].0[lane]));
                let p = input.anchor.inverse_transform_point(root.translation);
                let q = turn * root.rotation;
                // Of the two quaternions of the rotation, the one in the same hemisphere, as `nlerp`
                // requires.
                let q = if q.dot(before) < 0.0 { -q } else { q };
                for (k, v) in p.to_array().into_iter().chain(q.to_array()).enumerate() {
                    rows[root::END + k].0[lane] = v;
                }
            }
        });
    }
}
