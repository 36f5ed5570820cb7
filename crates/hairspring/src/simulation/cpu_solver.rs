//! The solver on the CPU: tiles of eight strands in SIMD lanes, distributed to all threads.

use super::{
    reset,
    solver::{SolverInput, StrandSolver},
    strand_state::StrandState,
};
use crate::{
    settings::Integrator,
    strand::{
        frame_context::FrameContext,
        integrate::{explicit, ftl, local_global},
        model::{curvature, rod, springs, straight},
        scratch::Memory,
        tile::{Elastic, Tile, TileRange},
    },
};
use fearless_simd::Level;
use std::cell::RefCell;

/// The solver on the CPU.
pub(super) struct CpuSolver {
    /// The instruction set in use.
    pub level: Level,
}

impl StrandSolver for CpuSolver {
    fn run(&mut self, input: &SolverInput, state: &mut StrandState) -> bool {
        let SolverInput { model, forces, frame } = *input;
        let tiles = TileRange {
            tiles: &model.tiles,
            roots: &state.roots,
            strand: &model.strand,
            contact_age: &mut state.contact_age,
            holds: &state.holds,
            rest: &model.rest,
            state: &mut state.points,
            multipliers: &model.multipliers,
            history: &mut state.history,
            external_acceleration: &forces.external_acceleration,
            position_spring: &forces.position_spring,
            anisotropic_drag: &forces.anisotropic_drag,
            wind_delta: &forces.wind_delta,
            rest_penetration: &model.rest_penetration,
            passes: &model.passes,
            segment_contacts: if frame.segments { &mut state.segment_contacts[..] } else { &mut [] },
            tether_lengths: &model.tethers,
        };
        run(self.level, frame, tiles)
    }
}

/// Number of tiles in a task.
const TILES_PER_TASK: usize = 8;

thread_local! {
    static MEMORY: RefCell<Memory> = RefCell::default();
}

/// Runs the tiles on all threads, by recursive halving down to small tasks. Returns true if any point became
/// non-finite.
fn run(level: Level, frame: &FrameContext, tiles: TileRange) -> bool {
    let count = tiles.tiles.len();
    if count > TILES_PER_TASK {
        let half = (count / 2).next_multiple_of(TILES_PER_TASK).min(count - 1);
        let (a, b) = tiles.split(half);
        let (a, b) = crate::parallel::join(|| run(level, frame, a), || run(level, frame, b));
        return a | b;
    }
    on_large_stack(|| run_task(level, frame, tiles))
}

/// Runs a task's tiles one after the other; see [`run`].
fn run_task(level: Level, frame: &FrameContext, mut tiles: TileRange) -> bool {
    MEMORY.with_borrow_mut(|memory| {
        let mut broken = false;
        for k in 0..tiles.tiles.len() {
            let mut tile = tiles.tile(k);
            kernel(frame.integrator, tile.layout.model)(level, frame, &mut tile, memory);
            broken |= !reset::all_finite(level, tile.state);
        }
        broken
    })
}

/// Returns the function that advances a tile with this integrator and elastic model.
fn kernel(integrator: Integrator, model: Elastic) -> fn(Level, &FrameContext, &mut Tile, &mut Memory) {
    match integrator {
        Integrator::BackwardEuler | Integrator::Bdf2 => match model {
            Elastic::Straight => straight::run,
            Elastic::Curvature => curvature::run,
            Elastic::Rod => rod::run,
            Elastic::Springs => springs::run,
        },
        Integrator::ExplicitEuler | Integrator::Verlet => explicit::run,
        Integrator::LocalGlobal => local_global::run,
        Integrator::Ftl | Integrator::Dftl => ftl::run,
    }
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
