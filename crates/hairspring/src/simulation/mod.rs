//! The simulation: the state of all simulated strands, and its time step.
//!
//! # Example
//! ```
//! use hairspring::prelude::*;
//!
//! let strand: Vec<Vec3> = (0..16).map(|i| Vec3::X * (0.01 * i as f32)).collect();
//! let solver = Solver { sag_free: false, ..Default::default() };
//! let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).solver(solver).build()?;
//! let anchor = RigidTransform::IDENTITY;
//! let roots = simulation.rigid_roots(anchor);
//! let input = StepInput::new(1.0 / 60.0, anchor, &roots);
//! let saved = simulation.snapshot();
//! let report = simulation.step(&input);
//! assert_eq!((report.substeps, report.reset_strands), (4, 0));
//! // The strand begins to fall. Time can be turned back.
//! assert!(simulation.energy().kinetic > 0.0 && simulation.measure(&[]).stretch_max < 0.011);
//! simulation.restore(&saved).expect("the same strands");
//! assert_eq!(simulation.energy().kinetic, 0.0);
//! # Ok::<(), hairspring::simulation::BuildError>(())
//! ```

mod authored;
mod build;
mod builder;
mod carried_air;
mod contact_points;
mod contacts;
mod cpu_solver;
mod debug_lines;
mod energy;
mod exposure;
mod external_forces;
mod force_fields;
mod groups;
mod hold;
mod layout;
mod manipulators;
mod measure;
mod multipliers;
mod place;
mod points;
mod reset;
mod roots;
mod solver;
mod step;
mod strand_contacts;
mod strand_model;
mod strand_parts;
mod strand_ref;
mod strand_state;
mod substeps;
mod take_over;
mod teleport;
mod try_step;
mod update_settings;
mod values;
mod volume;

pub use crate::strand::rest_shape::Start;
pub use crate::strand_contact::NeighboursReport;
pub use crate::volume::VolumeReport;
pub use builder::{BuildError, SimulationBuilder};
pub use contact_points::ContactPoint;
pub use contacts::Contacts;
pub use debug_lines::{DebugLine, DebugLineKind, DebugRenderMode};
pub use energy::Energy;
pub use force_fields::ForceId;
pub use groups::GroupId;
pub use hold::Hold;
pub use manipulators::ManipulatorId;
pub use measure::Measure;
pub use points::PointsError;
pub use step::{StepInput, StepReport, StepTimes};
pub use strand_state::{Snapshot, SnapshotMismatch};
pub use substeps::MAX_TRAVEL;
pub use try_step::StepError;

use crate::parallel::prelude::*;
use crate::{
    air::{Noise, OcclusionSampler, WindOcclusion},
    forces::{ForceBuffers, ForceField, HairField, charge::ChargedBall},
    strand::{frame_context::FrameContext, tile::TileLayout},
    strand_contact::Neighbours,
    volume::Volume,
};
use carried_air::AirInHair;
use cpu_solver::CpuSolver;
use fearless_simd::Level;
use glam::Vec3;
use solver::StrandSolver;
use std::{ops::Range, sync::Arc};
use strand_model::StrandModel;
use strand_state::StrandState;

/// Simulated strands, integrated by default with backward Euler and a direct banded solver.
///
/// Groom, materials and settings are given to [`Simulation::builder`]. [`Simulation::update_settings`] changes
/// settings between steps where rest shapes do not depend on them. The state consists of positions, velocities,
/// tensions, contacts, root poses, holds, manipulators and charged bodies; a [`Snapshot`] is a copy of it. A step
/// gives bitwise the same result for any number of threads. Strands interact with bodies, with the air, and with
/// each other: either as a volume (see [`Simulation::set_volume`]) or strand by strand (see
/// [`Simulation::set_neighbours`]).
///
/// # Limitations
/// Cutting and wetting are not supported.
///
/// For an example, see [`simulation`](crate::simulation).
pub struct Simulation {
    model: Arc<StrandModel>,
    state: StrandState,
    /// External forces that the caller added.
    force_fields: Vec<(ForceId, Arc<dyn ForceField>)>,
    /// Number of external forces that were ever added.
    forces_added: u32,
    /// External forces on points in the last frame.
    forces: ForceBuffers,
    hair_field: HairField,
    air_in_hair: AirInHair,
    /// The hair volume: density, and forces between hair; `None` if strands pass through each other and
    /// nothing needs the density.
    volume: Option<Box<Volume>>,
    /// Strand contact; `None` if disabled.
    neighbours: Option<Box<Neighbours>>,
    /// Turbulence of the air in the last frame.
    noise: Noise,
    /// Wind occlusion by bodies and hair, and its result in the last frame.
    wind_occlusion: WindOcclusion,
    occlusion: OcclusionSampler,
    /// Context of the last frame, kept to reuse its memory.
    frame: FrameContext,
    solver: Box<dyn StrandSolver>,
    /// The instruction set of the solver on the CPU.
    level: Level,
    /// See [`Simulation::group_user_data`].
    group_user_data: Vec<u128>,
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation")
            .field("strands", &self.strand_count())
            .field("points", &self.point_count())
            .field("materials", &self.model.materials.len())
            .field("solver", &self.model.solver)
            .field("gravity", &self.model.gravity)
            .finish_non_exhaustive()
    }
}

impl Simulation {
    /// Number of simulated strands.
    pub fn strand_count(&self) -> usize {
        self.model.lane_of_strand.len()
    }

    /// Number of simulated points, without padding.
    pub fn point_count(&self) -> usize {
        self.strands().map(|s| self.model.groom.range(s as usize).len()).sum()
    }

    /// Returns the changes that the sag-free start made: stiffened joints, joints limited by precision, and coils
    /// simulated as rods.
    pub fn start(&self) -> Start {
        self.model.start
    }

    /// Size of state, rest shape and strand data in memory, with padding [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.state.roots[..])
            + size_of_val(&self.model.strand[..])
            + size_of_val(&self.model.rest[..])
            + size_of_val(&self.model.multipliers[..])
            + size_of_val(&self.state.points[..])
            + size_of_val(&self.model.rest_penetration[..])
            + size_of_val(&self.state.contact_age[..])
            + size_of_val(&self.state.segment_contacts[..])
            + size_of_val(&self.model.tethers[..])
            + size_of_val(&self.state.history[..])
            + self.forces.bytes()
            + self.model.tensions.iter().map(|rows| size_of_val(&rows[..])).sum::<usize>()
            + self.volume.as_ref().map_or(0, |volume| volume.bytes())
            + self.neighbours.as_ref().map_or(0, |neighbours| neighbours.bytes())
            + (self.model.groom_strands.len()
                + self.model.strand_of_lane.len()
                + self.model.lane_of_strand.len()
                + self.model.multiplicity.len())
                * size_of::<u32>()
            + self.model.tiles.len() * size_of::<TileLayout>()
    }

    /// Name of the instruction set in use.
    pub fn instruction_set(&self) -> String {
        name(self.level)
    }

    /// Names of the instruction sets that this processor supports, the best first.
    pub fn instruction_sets() -> Vec<String> {
        levels().map(name).collect()
    }

    /// Selects another instruction set of this processor, by one of the names of
    /// [`Simulation::instruction_sets`]; for comparisons and for tests. Returns false and changes nothing if
    /// the processor has none with that name.
    pub fn use_instruction_set(&mut self, set: &str) -> bool {
        let found = levels().find(|level| name(*level) == set);
        if let Some(level) = found {
            self.use_level(level);
        }
        found.is_some()
    }

    /// Uses the solver on the CPU, with the instructions of `level`.
    fn use_level(&mut self, level: Level) {
        self.level = level;
        self.solver = Box::new(CpuSolver { level });
    }

    /// Sets how many hairs each strand of the groom represents, including itself: those that follow it. Each
    /// number is more than 0. It applies to the hair volume, from the next [`Simulation::set_volume`] on, and
    /// to charge. By default, the simulated strands represent the whole groom in equal shares.
    ///
    /// # Panics
    /// If there is not one number for each strand of the groom, or one is not finite and above 0.
    pub fn set_hair_multiplicity(&mut self, hairs: Vec<f32>) {
        assert_eq!(hairs.len(), self.model.groom.strand_count(), "one number for each strand of the groom");
        assert!(
            hairs.iter().all(|n| n.is_finite() && *n > 0.0),
            "numbers of hairs must be finite and above 0"
        );
        Arc::make_mut(&mut self.model).multiplicity = hairs;
    }

    /// Sets the charged bodies that act on charged hair in the next frame.
    pub fn set_charged(&mut self, balls: impl IntoIterator<Item = ChargedBall>) {
        self.state.charged.clear();
        self.state.charged.extend(balls);
    }

    /// The simulated strands, as indices of the groom, in the order given to [`Simulation::builder`].
    pub fn strands(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.model.lane_of_strand.iter().map(|p| self.model.groom_strands[*p as usize])
    }

    /// Writes the points of every simulated strand [m], one after the other, in the order given to
    /// [`Simulation::builder`]. `out` has the shape `[point_count]`.
    ///
    /// # Panics
    /// If `out` is too short.
    pub fn write_points(&self, out: &mut [Vec3]) {
        self.write_points_of(0..self.model.lane_of_strand.len(), out);
    }

    /// Writes the points of the strands in `strands`. These are indices in the order given to the builder.
    ///
    /// # Panics
    /// If the strands do not exist, or `out` is too short for their points.
    pub fn write_points_of(&self, strands: Range<usize>, out: &mut [Vec3]) {
        let mut rest = out;
        let mut pieces = Vec::with_capacity(strands.len());
        for &place in &self.model.lane_of_strand[strands] {
            let (piece, more) = rest.split_at_mut(
                self.model.groom.range(self.model.groom_strands[place as usize] as usize).len(),
            );
            pieces.push((place as usize, piece));
            rest = more;
        }
        pieces.into_par_iter().with_min_len(256).for_each(|(place, piece)| {
            for (p, x) in piece.iter_mut().zip(self.strand(place).points()) {
                *p = x;
            }
        });
    }
}

/// Instruction sets of this processor, the best first. SSE4.2 is omitted: its kernels gave bitwise the same
/// results as those of SSE2 and were slower. Builds for one instruction set (`simd::dispatch`) have kernels for SSE2 only.
fn levels() -> impl Iterator<Item = Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let levels = [
        best.as_avx512().map(Level::Avx512).filter(|_| cfg!(not(any(test, unoptimized)))),
        best.as_avx2().map(Level::Avx2).filter(|_| cfg!(not(any(test, unoptimized)))),
        best.as_sse2().map(Level::Sse2),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let levels = [Some(best)];
    levels.into_iter().flatten()
}

/// Name of an instruction set.
fn name(level: Level) -> String {
    let name = format!("{level:?}");
    name.split('(').next().unwrap_or_default().to_lowercase()
}
