//! One step: a frame of root motion, divided into substeps. Each tile runs all of them.

use super::{Simulation, reset};
use crate::parallel::prelude::*;
use crate::{
    air::Air,
    collide::{ColliderPose, FrameColliders, MovingCollider},
    math::RigidTransform,
    settings::{Integrator, Quality, Solver},
    simd::lanes::{LANES, Row},
    strand::{
        frame_context::{FrameContext, Substep},
        model::{curvature, rod, springs, straight},
        scratch::Memory,
        segment::segment_contact_unneeded,
        tile::{
            Elastic, HistoryRows, HoldRows, RestRows, SegmentContactRows, StateRows, StrandRows, Tile,
            TilePlace, anisotropic_drag, position_spring, segment_contact, strand,
        },
    },
};
use fearless_simd::Level;
use std::{cell::RefCell, time::Duration};

/// Input of a step. All poses are at the end of the frame; the start is the end of the last step.
///
/// For an example, see [`simulation`](crate::simulation).
pub struct StepInput<'a> {
    /// Length of the frame [s], above 0.
    pub dt: f32,
    /// Pose of the frame that roots move with (the head). Within the frame, roots follow the arc of its
    /// motion.
    pub anchor: RigidTransform,
    /// World pose of each simulated root, in the order given to [`Simulation::builder`]: position [m] and
    /// rotation since rest.
    pub roots: &'a [RigidTransform],
    /// Colliders.
    pub obstacles: &'a [MovingCollider],
    /// Moving air.
    pub air: Air<'a>,
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

/// Durations of the stages of a step. The little work between them (substep poses, tools) is not included.
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
pub(super) const LONGER: f64 = 1.0015;

/// Largest number of substeps in a step, so that a very large `dt` after a stall does not stall the caller
/// for good.
const MAX_SUBSTEPS: u32 = 4096;

/// Local–global iterations in a substep at normal quality (Liu 2013, §6: ten).
const LOCAL_GLOBAL: u32 = 10;

/// Largest number of Newton iterations in a substep at high quality.
const NEWTON: u32 = 12;

/// Number of tiles in a task.
const TILES_PER_TASK: usize = 8;

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

/// Largest length of a substep [s].
pub(super) fn substep_length(solver: &Solver) -> f64 {
    f64::from(FRAME) / f64::from(solver.substeps.max(1))
}

impl Simulation {
    /// Advances all strands to the end of a frame.
    ///
    /// The frame is divided into equal substeps. Each is at most 1/60 s over `solver.substeps` long, with a
    /// tolerance of 0.15 %. The substep length therefore does not depend on frame rates that it divides, and
    /// roots match the skin at every frame, which an accumulator with a remainder would not ensure. More
    /// substeps are used where a body that is fast relative to its thickness passes through the hair.
    ///
    /// State that is not finite, from input that is not, is reset and counted in the report.
    ///
    /// # Panics
    /// If `drive.roots` is not as long as [`Simulation::strand_count`], or `dt` is not above 0.
    /// [`Simulation::try_step`] returns an error instead.
    pub fn step(&mut self, drive: &StepInput) -> StepReport {
        assert_eq!(drive.roots.len(), self.model.places.len(), "one root pose for each simulated strand");
        assert!(drive.dt > 0.0, "`dt` must be positive");
        let solver = self.model.solver;
        let carried = self.carry_along(drive);
        // For bodies with several time slices, each slice has the same number of substeps.
        let parts = drive.obstacles.iter().map(|o| o.shape.time_slices() as u32).max().unwrap_or(1);
        let substeps = ((f64::from(drive.dt) / (substep_length(&solver) * LONGER)).ceil() as u32)
            .max(self.substeps_past(drive, carried.as_ref()))
            .clamp(1, MAX_SUBSTEPS)
            .next_multiple_of(parts);
        let mut interval = std::mem::take(&mut self.interval);
        let looked_at = interval.segments;
        self.fill_interval(drive, carried.as_ref(), substeps, &mut interval);
        if looked_at && !interval.segments {
            // Discard the segment contacts: nothing would update them until segments are tested again.
            self.state.segment_contacts.fill([Row::default(); segment_contact::ROWS]);
        }
        self.begin_tools(&FrameColliders::new((drive.obstacles, carried.as_ref())));
        let (reset_strands, times) = self.run_in_parts(drive, carried.as_ref(), &mut interval);
        self.rest_holds();
        self.rest_tools(drive.dt);
        self.state.last_h = interval.h;
        // Release the colliders' shapes to the caller.
        interval.substeps.iter_mut().for_each(|s| s.obstacles.clear());
        self.interval = interval;
        StepReport { substeps, reset_strands, times }
    }

    /// Runs the substeps of `interval` that are due now. Returns the number of strands that were reset
    /// because of non-finite state.
    pub(super) fn run(&mut self, interval: &FrameContext) -> usize {
        let reset = run(
            self.level,
            interval,
            TileRange {
                tiles: &self.model.tiles,
                strand: &self.state.strand,
                rest: &self.model.rest,
                state: &mut self.state.points,
                history: &mut self.state.history,
                external_acceleration: &self.forces.external_acceleration,
                position_spring: &self.forces.position_spring,
                anisotropic_drag: &self.forces.anisotropic_drag,
                wind_delta: &self.forces.wind_delta,
                rest_penetration: &self.model.rest_penetration,
                contact_age: &mut self.state.contact_age,
                segment_contacts: if interval.segments { &mut self.state.segment_contacts } else { &mut [] },
                tether_lengths: &self.model.tethers,
                holds: &self.state.holds,
            },
        );
        if reset { self.reset_non_finite() } else { 0 }
    }

    /// Fills `interval` for a frame, reusing its memory.
    fn fill_interval(
        &self,
        drive: &StepInput,
        carried: Option<&RigidTransform>,
        count: u32,
        interval: &mut FrameContext,
    ) {
        let from = self.state.anchor;
        interval.h = drive.dt / count as f32;
        let solver = self.model.solver;
        interval.integrator = solver.integrator;
        interval.iterations = match (solver.integrator, solver.quality) {
            (Integrator::LocalGlobal, Quality::Normal) => LOCAL_GLOBAL,
            (Integrator::LocalGlobal, Quality::High) => 4 * LOCAL_GLOBAL,
            (_, Quality::Normal) => 1,
            (_, Quality::High) => NEWTON,
        };
        interval.continues = (interval.h / self.state.last_h - 1.0).abs() < 1e-3;
        interval.response = solver.contact;
        // For the largest length that a segment can have. Without a strain limit, segments are always tested.
        let may_cut = |o: &MovingCollider| {
            !(solver.integrator.limits_strain()
                && segment_contact_unneeded(self.model.longest_segment, o.shape.roundness()))
        };
        interval.segments = solver.segment_contacts && drive.obstacles.iter().any(may_cut);
        interval.projection_iterations = solver.projection_iterations;
        interval.gravity = self.model.gravity;
        interval.anchor = from.matrix();
        interval.substeps.resize_with(count as usize, Substep::default);
        interval.now = 0..count as usize;
        for (k, substep) in interval.substeps.iter_mut().enumerate() {
            let fraction = (k + 1) as f32 / count as f32;
            let before = k as f32 / count as f32;
            substep.fraction = fraction;
            substep.anchor = from.lerp(&drive.anchor, fraction).matrix();
            substep.wind = drive.air.uniform(fraction * drive.dt);
            substep.obstacles.clear();
            substep.obstacles.extend(drive.obstacles.iter().map(|o| {
                let start = o.start(carried);
                let at = |t: f32| start.lerp(&o.end, t).matrix();
                let (parts, count) = (o.shape.time_slices(), count as usize);
                let shape = o.shape.time_slice(k * parts / count);
                ColliderPose::new(shape, at(before), at(fraction), parts as f32 / count as f32)
            }));
        }
    }

    /// Makes the root poses of the last frame the start and those of `drive` the end, both relative to the
    /// anchor.
    pub(super) fn move_roots(&mut self, drive: &StepInput) {
        let turn = drive.anchor.rotation.inverse();
        let tiles = self.state.strand.par_iter_mut().zip(self.model.asked.par_chunks(LANES));
        tiles.with_min_len(8 * TILES_PER_TASK).for_each(|(rows, asked)| {
            for k in 0..strand::ROOT_END {
                rows[strand::ROOT_START + k] = rows[strand::ROOT_END + k];
            }
            let start = strand::TURN_START;
            for (lane, k) in asked.iter().enumerate() {
                let Some(root) = drive.roots.get(*k as usize) else { continue };
                let before = glam::Quat::from_array([0, 1, 2, 3].map(|k| rows[start + k].0[lane]));
                let p = drive.anchor.inverse_point(root.translation);
                let q = turn * root.rotation;
                // Of the two quaternions of the rotation, the one in the same hemisphere, as `nlerp`
                // requires.
                let q = if q.dot(before) < 0.0 { -q } else { q };
                for (k, v) in p.to_array().into_iter().chain(q.to_array()).enumerate() {
                    rows[strand::ROOT_END + k].0[lane] = v;
                }
            }
        });
    }
}

/// The arrays of a range of tiles.
struct TileRange<'a> {
    tiles: &'a [TilePlace],
    strand: &'a [StrandRows],
    rest: &'a [RestRows],
    state: &'a mut [StateRows],
    history: &'a mut [HistoryRows],
    external_acceleration: &'a [[Row; 3]],
    position_spring: &'a [[Row; position_spring::ROWS]],
    anisotropic_drag: &'a [[Row; anisotropic_drag::ROWS]],
    wind_delta: &'a [[Row; 3]],
    rest_penetration: &'a [Row],
    contact_age: &'a mut [Row],
    segment_contacts: &'a mut [SegmentContactRows],
    tether_lengths: &'a [Row],
    holds: &'a [Vec<HoldRows>],
}

impl<'a> TileRange<'a> {
    /// Splits off the first `count` tiles.
    fn split(self, count: usize) -> (Self, Self) {
        let points = (self.tiles[count].first - self.tiles[0].first) as usize;
        let (tiles, more_tiles) = self.tiles.split_at(count);
        let (strand, more_strand) = self.strand.split_at(count);
        let (rest, more_rest) = self.rest.split_at(points);
        let (state, more_state) = self.state.split_at_mut(points);
        let (history, more_history) = self.history.split_at_mut(points.min(self.history.len()));
        let (external_acceleration, more_external_acceleration) =
            self.external_acceleration.split_at(points.min(self.external_acceleration.len()));
        let (position_spring, more_position_spring) =
            self.position_spring.split_at(points.min(self.position_spring.len()));
        let (anisotropic_drag, more_anisotropic_drag) =
            self.anisotropic_drag.split_at(points.min(self.anisotropic_drag.len()));
        let (wind_delta, more_wind_delta) = self.wind_delta.split_at(points.min(self.wind_delta.len()));
        let (rest_penetration, more_rest_penetration) =
            self.rest_penetration.split_at(points.min(self.rest_penetration.len()));
        let (contact_age, more_contact_age) = self.contact_age.split_at_mut(count);
        let (segment_contacts, more_segment_contacts) =
            self.segment_contacts.split_at_mut(points.min(self.segment_contacts.len()));
        let (tether_lengths, more_tether_lengths) =
            self.tether_lengths.split_at(points.min(self.tether_lengths.len()));
        let (holds, more_holds) = self.holds.split_at(count.min(self.holds.len()));
        (
            TileRange {
                tiles,
                strand,
                rest,
                state,
                history,
                external_acceleration,
                position_spring,
                anisotropic_drag,
                wind_delta,
                rest_penetration,
                contact_age,
                segment_contacts,
                tether_lengths,
                holds,
            },
            TileRange {
                tiles: more_tiles,
                strand: more_strand,
                rest: more_rest,
                state: more_state,
                history: more_history,
                external_acceleration: more_external_acceleration,
                position_spring: more_position_spring,
                anisotropic_drag: more_anisotropic_drag,
                wind_delta: more_wind_delta,
                rest_penetration: more_rest_penetration,
                contact_age: more_contact_age,
                segment_contacts: more_segment_contacts,
                tether_lengths: more_tether_lengths,
                holds: more_holds,
            },
        )
    }

    fn tile(&mut self, k: usize) -> Tile<'_> {
        let place = self.tiles[k];
        let at = (place.first - self.tiles[0].first) as usize;
        let points = at..at + place.points as usize;
        Tile {
            model: place.model,
            flat: place.flat,
            double: place.double,
            strand: &self.strand[k],
            rest: &self.rest[points.clone()],
            state: &mut self.state[points.clone()],
            history: if self.history.is_empty() { &mut [] } else { &mut self.history[points.clone()] },
            external_acceleration: if self.external_acceleration.is_empty() {
                &[]
            } else {
                &self.external_acceleration[points.clone()]
            },
            position_spring: if self.position_spring.is_empty() {
                &[]
            } else {
                &self.position_spring[points.clone()]
            },
            anisotropic_drag: if self.anisotropic_drag.is_empty() {
                &[]
            } else {
                &self.anisotropic_drag[points.clone()]
            },
            wind_delta: if self.wind_delta.is_empty() { &[] } else { &self.wind_delta[points.clone()] },
            rest_penetration: if self.rest_penetration.is_empty() {
                &[]
            } else {
                &self.rest_penetration[points.clone()]
            },
            contact_age: &mut self.contact_age[k],
            segment_contacts: if self.segment_contacts.is_empty() {
                &mut []
            } else {
                &mut self.segment_contacts[points.clone()]
            },
            tether_lengths: if self.tether_lengths.is_empty() { &[] } else { &self.tether_lengths[points] },
            holds: self.holds.get(k).map_or(&[], |holds| holds),
        }
    }
}

/// Runs the tiles on all threads, by recursive halving down to small tasks. Returns true if any point became
/// non-finite.
fn run(level: Level, interval: &FrameContext, piece: TileRange) -> bool {
    let count = piece.tiles.len();
    if count > TILES_PER_TASK {
        let half = (count / 2).next_multiple_of(TILES_PER_TASK).min(count - 1);
        let (a, b) = piece.split(half);
        let (a, b) = crate::parallel::join(|| run(level, interval, a), || run(level, interval, b));
        return a | b;
    }
    on_large_stack(|| run_task(level, interval, piece))
}

/// Runs a task's tiles one after the other; see [`run`].
fn run_task(level: Level, interval: &FrameContext, mut piece: TileRange) -> bool {
    MEMORY.with_borrow_mut(|memory| {
        let mut broken = false;
        for k in 0..piece.tiles.len() {
            let mut tile = piece.tile(k);
            let run = match tile.model {
                Elastic::Straight => straight::run,
                Elastic::Curvature => curvature::run,
                Elastic::Rod => rod::run,
                Elastic::Springs => springs::run,
            };
            run(level, interval, &mut tile, memory);
            broken |= !reset::all_finite(level, tile.state);
        }
        broken
    })
}

/// Stack of a task in a build without optimization [bytes].
const UNOPTIMIZED_STACK: usize = 64 << 20;

/// Runs `task`. A kernel that is compiled without optimization keeps the whole window of the matrix in memory several
/// times over, which takes more than the 2 MiB of a thread's stack. Such builds run it on a thread of its own.
fn on_large_stack<T: Send>(task: impl FnOnce() -> T + Send) -> T {
    if !cfg!(debug_assertions) {
        return task();
    }
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(UNOPTIMIZED_STACK).spawn_scoped(scope, task);
        match thread.map(|thread| thread.join()) {
            Ok(Ok(done)) => done,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            Err(why) => panic!("no thread with a stack of {UNOPTIMIZED_STACK} bytes: {why}"),
        }
    })
}
