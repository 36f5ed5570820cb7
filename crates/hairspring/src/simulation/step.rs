//! One step: a frame of root motion, cut into substeps, every tile through all of them.

use super::{Simulation, TilePlace, reset};
use crate::{
    collide::{Obstacle, ObstaclePose, Rigid},
    scene::Wind,
    strand::{
        interval::{Interval, Substep},
        lanes::LANES,
        substep::{Scratch, run_tile},
        tile::{RestRows, StateRows, StrandRows, Tile, strand},
    },
};
use fearless_simd::{Level, dispatch};
use glam::Vec3;
use std::cell::RefCell;

/// A frame's input, all at the end of it; the start is where the last step ended.
pub struct Drive<'a> {
    /// Length of the frame [s], above 0.
    pub dt: f32,
    /// Pose of the frame that roots move with (the head): between frames roots travel on its arc.
    pub anchor: Rigid,
    /// World pose of each simulated root, in the order given to [`Simulation::new`]: position [m] and rotation since rest.
    pub roots: &'a [Rigid],
    /// Colliders.
    pub obstacles: &'a [MovingObstacle],
    /// Moving air.
    pub air: Air,
}

/// A collider and its pose at the start and the end of a frame.
#[derive(Clone)]
pub struct MovingObstacle {
    /// The shape in its own space.
    pub shape: Obstacle,
    /// Pose at the start.
    pub start: Rigid,
    /// Pose at the end.
    pub end: Rigid,
}

/// Wind at a time.
#[derive(Clone, Copy, Default)]
pub struct Air {
    /// Settings.
    pub wind: Wind,
    /// Time at the start of the frame [s].
    pub time: f32,
}

impl Air {
    /// Velocity of the air `after` the start of the frame [m/s]: two incommensurate sines make the gusts.
    fn velocity(&self, after: f32) -> Vec3 {
        let phase = std::f32::consts::TAU * self.wind.gust_rate * (self.time + after);
        let gust = 0.6 * phase.sin() + 0.4 * (phase * 2.618 + 1.0).sin();
        self.wind.velocity * (1.0 + self.wind.gust * gust)
    }
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Substeps taken.
    pub substeps: u32,
    /// Strands that had turned non-finite and were put back to their rest shape at the root.
    pub reset_strands: usize,
}

/// Reference frame of `Solver::substeps` [s].
const FRAME: f32 = 1.0 / 60.0;

/// Most substeps of one step, so that a stalled caller's long `dt` cannot stall it for good.
const MAX_SUBSTEPS: u32 = 4096;

/// Tiles that one task runs.
const TILES_PER_TASK: usize = 8;

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Simulation {
    /// Steps all strands to the end of a frame.
    ///
    /// The frame is cut into equal substeps none of which is longer than 1/60 s over `solver.substeps` (so the step does not
    /// depend on the frame rate where that divides it, and roots are on the skin at every frame, which an accumulator that
    /// carries a remainder would not give).
    ///
    /// # Panics
    /// If `drive.roots` is not as long as [`Simulation::strand_count`], or `dt` is not above 0.
    pub fn step(&mut self, drive: &Drive) -> StepReport {
        assert_eq!(drive.roots.len(), self.places.len(), "one root pose for each simulated strand");
        assert!(drive.dt > 0.0, "a step takes time");
        let solver = self.settings.solver;
        let h = FRAME / solver.substeps.max(1) as f32;
        let substeps = ((drive.dt / h - 1e-3).ceil() as u32).clamp(1, MAX_SUBSTEPS);
        let mut interval = std::mem::take(&mut self.interval);
        self.fill_interval(drive, substeps, &mut interval);
        self.move_roots(drive);
        let reset = run(
            self.level,
            &interval,
            &self.tiles,
            &self.strand,
            &self.rest,
            &mut self.state,
            self.tiles.first().map_or(0, |t| t.first),
        );
        // The colliders' shapes are the caller's again.
        interval.substeps.iter_mut().for_each(|s| s.obstacles.clear());
        self.interval = interval;
        self.settings.anchor = drive.anchor;
        let reset_strands = if reset { self.reset_non_finite() } else { 0 };
        StepReport { substeps, reset_strands }
    }

    /// Fills `interval` for a frame; its memory is used again.
    fn fill_interval(&self, drive: &Drive, count: u32, interval: &mut Interval) {
        let from = self.settings.anchor;
        interval.h = drive.dt / count as f32;
        interval.projections = self.settings.solver.projections;
        interval.gravity = self.settings.gravity;
        interval.anchor = from.matrix();
        interval.substeps.resize_with(count as usize, Substep::default);
        for (k, substep) in interval.substeps.iter_mut().enumerate() {
            let fraction = (k + 1) as f32 / count as f32;
            let before = k as f32 / count as f32;
            substep.fraction = fraction;
            substep.anchor = from.lerp(&drive.anchor, fraction).matrix();
            substep.wind = drive.air.velocity(fraction * drive.dt);
            substep.obstacles.clear();
            substep.obstacles.extend(drive.obstacles.iter().map(|o| ObstaclePose {
                shape: o.shape.clone(),
                start: o.start.lerp(&o.end, before).matrix(),
                end: o.start.lerp(&o.end, fraction).matrix(),
                share: 1.0 / count as f32,
            }));
        }
    }

    /// Last frame's root poses become the start, the drive's the end, both relative to the anchor.
    fn move_roots(&mut self, drive: &Drive) {
        let turn = drive.anchor.rotation.inverse();
        for (&place, root) in self.places.iter().zip(drive.roots) {
            let (tile, lane) = (place as usize / LANES, place as usize % LANES);
            let rows = &mut self.strand[tile];
            for k in 0..strand::ROOT_END {
                rows[strand::ROOT_START + k].0[lane] = rows[strand::ROOT_END + k].0[lane];
            }
            let start = strand::TURN_START;
            let before = glam::Quat::from_array([0, 1, 2, 3].map(|k| rows[start + k].0[lane]));
            let p = drive.anchor.inverse_point(root.translation);
            let q = turn * root.rotation;
            // The near one of the two quaternions of a rotation, for `nlerp`.
            let q = if q.dot(before) < 0.0 { -q } else { q };
            for (k, v) in p.to_array().into_iter().chain(q.to_array()).enumerate() {
                rows[strand::ROOT_END + k].0[lane] = v;
            }
        }
    }
}

/// Runs tiles on all threads, halving the arrays until a task is small; true if any point turned non-finite.
fn run(
    level: Level,
    interval: &Interval,
    tiles: &[TilePlace],
    strand: &[StrandRows],
    rest: &[RestRows],
    state: &mut [StateRows],
    first: u32,
) -> bool {
    if tiles.len() > TILES_PER_TASK {
        let half = (tiles.len() / 2).next_multiple_of(TILES_PER_TASK).min(tiles.len() - 1);
        let points = (tiles[half].first - first) as usize;
        let (strand_a, strand_b) = strand.split_at(half);
        let (state_a, state_b) = state.split_at_mut(points);
        let (rest_a, rest_b) = rest.split_at(points);
        let (a, b) = rayon::join(
            || run(level, interval, &tiles[..half], strand_a, rest_a, state_a, first),
            || run(level, interval, &tiles[half..], strand_b, rest_b, state_b, tiles[half].first),
        );
        return a | b;
    }
    SCRATCH.with_borrow_mut(|scratch| {
        let mut broken = false;
        for (k, place) in tiles.iter().enumerate() {
            let (at, points) = ((place.first - first) as usize, place.points as usize);
            let mut tile =
                Tile { strand: &strand[k], rest: &rest[at..at + points], state: &mut state[at..at + points] };
            dispatch!(level, simd => run_tile(simd, interval, &mut tile, scratch));
            broken |= !reset::all_finite(tile.state);
        }
        broken
    })
}
