//! The simulation: the state of all simulated strands, and its time step.
//!
//! # Example
//! ```
//! use hairspring::prelude::*;
//!
//! let strand: Vec<Vec3> = (0..16).map(|i| Vec3::X * (0.01 * i as f32)).collect();
//! let solver = Solver { sag_free: false, ..Default::default() };
//! let mut simulation = Simulation::builder(Groom::from_strands([strand], 35e-6)).solver(solver).build()?;
//! let (anchor, roots) = (RigidTransform::default(), [RigidTransform::default()]);
//! let input = StepInput { dt: 1.0 / 60.0, anchor, roots: &roots, obstacles: &[], air: Air::default() };
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
mod contact_points;
mod contacts;
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
mod place;
mod points;
mod reset;
mod step;
mod strand_contacts;
mod strand_model;
mod strand_parts;
mod strand_state;
mod substeps;
mod take_over;
mod teleport;
mod try_step;
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
    simd::lanes::LANES,
    strand::{
        frame_context::FrameContext,
        tile::{TilePlace, state, strand},
    },
    strand_contact::Neighbours,
    volume::Volume,
};
use fearless_simd::Level;
use glam::Vec3;
use std::{ops::Range, sync::Arc};
use strand_model::StrandModel;
use strand_state::StrandState;

/// Simulated strands, integrated by default with backward Euler and a direct banded solver.
///
/// Settings are given to [`Simulation::builder`] and never change; the state is positions, velocities and
/// tensions. A step gives bitwise the same result for any number of threads. Strands interact with bodies,
/// with the air, and with each other: either as a volume (see [`Simulation::set_volume`]) or strand by strand
/// (see [`Simulation::set_neighbours`]).
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
    /// External forces on points in the last frame.
    forces: ForceBuffers,
    hair_field: HairField,
    /// The hair volume: density, and forces between hair; `None` if strands pass through each other and
    /// nothing needs the density.
    volume: Option<Box<Volume>>,
    /// Strand contact; `None` if disabled.
    neighbours: Option<Box<Neighbours>>,
    /// Turbulence of the air in the last frame.
    noise: Noise,
    /// Wind occlusion by bodies and hair, and its result in the last frame.
    wind_occlusion: WindOcclusion,
    shade: OcclusionSampler,
    /// Context of the last frame, kept to reuse its memory.
    interval: FrameContext,
    level: Level,
    /// See [`Simulation::group_user_data`].
    group_user_data: Vec<u128>,
}

impl Simulation {
    /// Number of simulated strands.
    pub fn strand_count(&self) -> usize {
        self.model.places.len()
    }

    /// Number of simulated points, without padding.
    pub fn point_count(&self) -> usize {
        self.strands().map(|s| self.model.groom.range(s as usize).len()).sum()
    }

    /// Returns the number of joints that the sag-free start had to stiffen, and of those that are softer than
    /// they should be.
    pub fn start(&self) -> Start {
        self.model.start
    }

    /// Size of state, rest shape and strand data in memory, with padding [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.state.strand[..])
            + size_of_val(&self.model.rest[..])
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
            + (self.model.lanes.len()
                + self.model.asked.len()
                + self.model.places.len()
                + self.model.multiplicity.len())
                * size_of::<u32>()
            + self.model.tiles.len() * size_of::<TilePlace>()
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
        self.level = found.unwrap_or(self.level);
        found.is_some()
    }

    /// Sets how many hairs each strand of the groom represents, including itself: those that follow it. Each
    /// number is more than 0. It applies to the hair volume, from the next [`Simulation::set_volume`] on, and
    /// to charge. By default, the simulated strands represent the whole groom in equal shares.
    ///
    /// # Panics
    /// If there is not one number for each strand of the groom.
    pub fn set_hair_multiplicity(&mut self, hairs: Vec<f32>) {
        assert_eq!(hairs.len(), self.model.groom.strand_count(), "one number for each strand of the groom");
        Arc::make_mut(&mut self.model).multiplicity = hairs;
    }

    /// Sets the charged bodies that act on charged hair in the next frame.
    pub fn set_charged(&mut self, balls: impl IntoIterator<Item = ChargedBall>) {
        self.state.charged.clear();
        self.state.charged.extend(balls);
    }

    /// The simulated strands, as indices of the groom, in the order given to [`Simulation::builder`].
    pub fn strands(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.model.places.iter().map(|p| self.model.lanes[*p as usize])
    }

    /// Writes the points of every simulated strand [m], one after the other, in the order given to
    /// [`Simulation::builder`]. `out` has the shape `[point_count]`.
    ///
    /// # Panics
    /// If `out` is too short.
    pub fn write_points(&self, out: &mut [Vec3]) {
        self.write_points_of(0..self.model.places.len(), out);
    }

    /// The same for some of the strands, by their indices in that order.
    ///
    /// # Panics
    /// If the strands do not exist, or `out` is too short for their points.
    pub fn write_points_of(&self, strands: Range<usize>, out: &mut [Vec3]) {
        let mut rest = out;
        let mut pieces = Vec::with_capacity(strands.len());
        for &place in &self.model.places[strands] {
            let (piece, more) =
                rest.split_at_mut(self.model.groom.range(self.model.lanes[place as usize] as usize).len());
            pieces.push((place as usize, piece));
            rest = more;
        }
        pieces.into_par_iter().with_min_len(256).for_each(|(place, piece)| {
            let root = self.root_position(place);
            let stride = self.model.tiles[place / LANES].model.stride();
            for (p, x) in piece.iter_mut().zip(self.particles(place).step_by(stride)) {
                *p = root + x;
            }
        });
    }

    /// Number of particles of the strand in lane `place`.
    fn simulated_points(&self, place: usize) -> usize {
        (self.model.groom.range(self.model.lanes[place] as usize).len() - 1)
            * self.model.tiles[place / LANES].model.stride()
            + 1
    }

    /// Positions of the particles of the strand in lane `place`, relative to its root [m].
    fn particles(&self, place: usize) -> impl Iterator<Item = Vec3> + '_ {
        (0..self.simulated_points(place)).scan(Vec3::ZERO, move |x, i| {
            *x += self.vector(place, i, state::EDGE);
            Some(*x)
        })
    }

    /// A vector of the state at point `i` of the strand in lane `place`.
    fn vector(&self, place: usize, i: usize, component: usize) -> Vec3 {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &self.state.points[self.model.tiles[tile].first as usize + i][component..];
        Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane])
    }

    /// A value of the rest shape.
    fn rest(&self, place: usize, i: usize, component: usize) -> f32 {
        let (tile, lane) = (place / LANES, place % LANES);
        self.model.rest[self.model.tiles[tile].first as usize + i][component].0[lane]
    }

    /// Authored depth of the segment that ends at point `i`, 0 or less [m].
    fn sunk(&self, place: usize, i: usize) -> f32 {
        let (tile, lane) = (place / LANES, place % LANES);
        self.model
            .rest_penetration
            .get(self.model.tiles[tile].first as usize + i)
            .map_or(0.0, |row| row.0[lane])
    }

    /// World position of a root at the end of the last step [m].
    fn root_position(&self, place: usize) -> Vec3 {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &self.state.strand[tile][strand::ROOT_END..];
        let local = Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]);
        let (m, t) = self.state.anchor.matrix();
        // The same arithmetic as in the kernel, so that a body at rest gives bitwise the same position.
        m.x_axis * local.x + m.y_axis * local.y + m.z_axis * local.z + t
    }
}

/// Instruction sets of this processor, the best first. SSE4.2 is omitted: its kernels gave bitwise the same
/// results as those of SSE2 and were slower.
fn levels() -> impl Iterator<Item = Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let levels = [
        best.as_avx512().map(Level::Avx512),
        best.as_avx2().map(Level::Avx2),
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
