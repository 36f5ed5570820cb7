//! Strands in motion: the state of all simulated strands, and one step of it.

mod authored;
mod build;
mod contacts;
mod energy;
mod exposure;
mod external_forces;
mod hold;
mod layout;
mod manipulators;
mod measure;
mod place;
mod reset;
mod step;
mod strand_contacts;
mod strand_parts;
mod substeps;
mod take_over;
mod teleport;
mod values;
mod volume;

pub use crate::strand::rest_shape::Start;
pub use crate::strand_contact::NeighboursReport;
pub use crate::volume::VolumeReport;
pub use contacts::Contacts;
pub use energy::Energy;
pub use hold::Hold;
pub use manipulators::ManipulatorId;
pub use measure::Measure;
pub use step::{StepInput, StepReport, StepTimes};
pub use substeps::MAX_TRAVEL;

use crate::{
    air::{Noise, OcclusionSampler, WindOcclusion},
    forces::{ForceBuffers, HairField, charge::ChargedBall},
    groom::Groom,
    material::GlobalShape,
    simd::lanes::{LANES, Row},
    strand::{
        frame_context::FrameContext,
        tile::{
            HistoryRows, HoldRows, RestRows, SegmentContactRows, StateRows, StrandRows, TilePlace, state,
            strand,
        },
    },
    strand_contact::Neighbours,
    volume::Volume,
};
use fearless_simd::Level;
use glam::Vec3;
use rayon::prelude::*;
use std::{ops::Range, sync::Arc};

/// Simulated strands: mass-spring chains stepped by backward Euler with a direct banded solver.
///
/// Settings come in by [`Simulation::new`] and never change; state is positions, velocities and tensions. A step gives the
/// same bits for any number of threads. Strands meet the body, the air, and each other, as a volume (see [`Simulation::set_volume`]) or one by one (see
/// [`Simulation::set_neighbours`]).
///
/// # Missing
/// Cutting and wetting: each is an issue of its own.
pub struct Simulation {
    groom: Arc<Groom>,
    /// Strand of the groom in each lane, tile after tile; `u32::MAX` in lanes without one.
    lanes: Vec<u32>,
    /// Which of the strands that the caller named is in each lane; `u32::MAX` in lanes without one.
    asked: Vec<u32>,
    tiles: Vec<TilePlace>,
    strand: Vec<StrandRows>,
    rest: Vec<RestRows>,
    state: Vec<StateRows>,
    /// How deep some place of the segment to each point was authored inside a collider, 0 or less [m]; as long as `state`, or empty where
    /// none was.
    rest_penetration: Vec<Row>,
    /// For how much longer each strand counts as one that touches something [s]; one for each tile.
    contact_age: Vec<Row>,
    /// What presses the segment to each point between its ends; empty where segments are no contacts.
    segment_contacts: Vec<SegmentContactRows>,
    /// How far each point may be from its root [m]; empty where no material has a tether.
    tethers: Vec<Row>,
    /// Length of the longest strand [m].
    longest: f32,
    /// Length of the longest segment [m].
    longest_segment: f32,
    /// How many hairs each strand of the groom stands for; shape `[strands of the groom]`.
    multiplicity: Vec<f32>,
    /// As long as `state` for the integrator of second order, else empty.
    history: Vec<HistoryRows>,
    /// What holds points from outside, for each tile; empty where nothing does.
    holds: Vec<Vec<HoldRows>>,
    /// What acts on points from outside in the last frame.
    forces: ForceBuffers,
    /// Pull of each material to the rest shape; a group past the end uses the last.
    global_shapes: Vec<GlobalShape>,
    /// What hands hold to the hair.
    tools: manipulators::Tools,
    /// Charge of each material's hair [C/m]; a group past the end uses the last.
    charges: Vec<f32>,
    charged: Vec<ChargedBall>,
    hair_field: HairField,
    /// Where hair is, and hair on hair; `None`: strands pass through each other, and nothing asks where they are.
    volume: Option<Box<Volume>>,
    /// Strands that meet each other one by one; `None`: they do not.
    neighbours: Option<Box<Neighbours>>,
    /// Tensions of the rest shape, of segments and, in the springs model, of triangles' sides; shapes as `state`, the second empty without springs.
    tensions: [Vec<Row>; 2],
    /// How the anchor moved in the last frame.
    motion: teleport::Motion,
    /// The air's eddies in the last frame.
    noise: Noise,
    /// How bodies and hair shelter from the wind, and what they left of it in the last frame.
    wind_occlusion: WindOcclusion,
    shade: OcclusionSampler,
    /// Length of the last substep [s].
    last_h: f32,
    settings: build::Settings,
    /// The last step's interval, kept for its memory.
    interval: FrameContext,
    level: Level,
    /// Lane of each simulated strand, in the order that the caller named them.
    places: Vec<u32>,
    start: Start,
}

impl Simulation {
    /// Number of simulated strands.
    pub fn strand_count(&self) -> usize {
        self.places.len()
    }

    /// Number of simulated points, padding left out.
    pub fn point_count(&self) -> usize {
        self.strands().map(|s| self.groom.range(s as usize).len()).sum()
    }

    /// Joints that the sag-free start had to make stiffer than the fibre, and those that are softer than they should be.
    pub fn start(&self) -> Start {
        self.start
    }

    /// Bytes of state, rest shape and strand data that the simulation holds, padding included.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.strand[..])
            + size_of_val(&self.rest[..])
            + size_of_val(&self.state[..])
            + size_of_val(&self.rest_penetration[..])
            + size_of_val(&self.contact_age[..])
            + size_of_val(&self.segment_contacts[..])
            + size_of_val(&self.tethers[..])
            + size_of_val(&self.history[..])
            + self.forces.bytes()
            + self.tensions.iter().map(|rows| size_of_val(&rows[..])).sum::<usize>()
            + self.volume.as_ref().map_or(0, |volume| volume.bytes())
            + self.neighbours.as_ref().map_or(0, |neighbours| neighbours.bytes())
            + (self.lanes.len() + self.asked.len() + self.places.len() + self.multiplicity.len())
                * size_of::<u32>()
            + self.tiles.len() * size_of::<TilePlace>()
    }

    /// Name of the instruction set in use.
    pub fn instruction_set(&self) -> String {
        name(self.level)
    }

    /// Names of the instruction sets that this processor has, the best first.
    pub fn instruction_sets() -> Vec<String> {
        levels().map(name).collect()
    }

    /// Uses another instruction set of this processor than the best one, by one of the names of
    /// [`Simulation::instruction_sets`]: for comparisons and for tests. False, and nothing changes, where the processor has none
    /// of that name.
    pub fn use_instruction_set(&mut self, set: &str) -> bool {
        let found = levels().find(|level| name(*level) == set);
        self.level = found.unwrap_or(self.level);
        found.is_some()
    }

    /// Says how many hairs each strand of the groom stands for, itself among them (more than 0): those that follow it. It counts where hair meets hair as a volume,
    /// from the next [`Simulation::set_volume`] on, and for charge. Where nothing is said, those that are simulated stand for all of the groom, each for as many.
    ///
    /// # Panics
    /// If there is not one number for each strand of the groom.
    pub fn set_hair_multiplicity(&mut self, hairs: Vec<f32>) {
        assert_eq!(hairs.len(), self.groom.strand_count(), "a number for each strand of the groom");
        self.multiplicity = hairs;
    }

    /// What charged bodies act on charged hair in the next frame.
    pub fn set_charged(&mut self, balls: impl IntoIterator<Item = ChargedBall>) {
        self.charged.clear();
        self.charged.extend(balls);
    }

    /// The simulated strands, as indices of the groom, in the order given to [`Simulation::new`].
    pub fn strands(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.places.iter().map(|p| self.lanes[*p as usize])
    }

    /// Writes the points of every simulated strand, in the order given to [`Simulation::new`], one after the other [m];
    /// `out` has the shape `[point_count]`.
    pub fn write_points(&self, out: &mut [Vec3]) {
        self.write_points_of(0..self.places.len(), out);
    }

    /// The same of some of the strands, by their places in that order.
    ///
    /// # Panics
    /// If there are no such strands, or `out` is too short for their points.
    pub fn write_points_of(&self, strands: Range<usize>, out: &mut [Vec3]) {
        let mut rest = out;
        let mut pieces = Vec::with_capacity(strands.len());
        for &place in &self.places[strands] {
            let (piece, more) =
                rest.split_at_mut(self.groom.range(self.lanes[place as usize] as usize).len());
            pieces.push((place as usize, piece));
            rest = more;
        }
        pieces.into_par_iter().with_min_len(256).for_each(|(place, piece)| {
            let root = self.root_position(place);
            let stride = self.tiles[place / LANES].model.stride();
            for (p, x) in piece.iter_mut().zip(self.particles(place).step_by(stride)) {
                *p = root + x;
            }
        });
    }

    /// Points that are simulated for the strand in lane `place`.
    fn simulated_points(&self, place: usize) -> usize {
        (self.groom.range(self.lanes[place] as usize).len() - 1) * self.tiles[place / LANES].model.stride()
            + 1
    }

    /// The simulated points of the strand in lane `place`, from its root [m].
    fn particles(&self, place: usize) -> impl Iterator<Item = Vec3> + '_ {
        (0..self.simulated_points(place)).scan(Vec3::ZERO, move |x, i| {
            *x += self.vector(place, i, state::EDGE);
            Some(*x)
        })
    }

    /// A vector of state of point `i` of the strand in lane `place`.
    fn vector(&self, place: usize, i: usize, component: usize) -> Vec3 {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &self.state[self.tiles[tile].first as usize + i][component..];
        Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane])
    }

    /// A number of the rest shape.
    fn rest(&self, place: usize, i: usize, component: usize) -> f32 {
        let (tile, lane) = (place / LANES, place % LANES);
        self.rest[self.tiles[tile].first as usize + i][component].0[lane]
    }

    /// How deep the segment to point `i` was authored, 0 or less [m].
    fn sunk(&self, place: usize, i: usize) -> f32 {
        let (tile, lane) = (place / LANES, place % LANES);
        self.rest_penetration.get(self.tiles[tile].first as usize + i).map_or(0.0, |row| row.0[lane])
    }

    /// World position of a root at the end of the last step.
    fn root_position(&self, place: usize) -> Vec3 {
        let (tile, lane) = (place / LANES, place % LANES);
        let rows = &self.strand[tile][strand::ROOT_END..];
        let local = Vec3::new(rows[0].0[lane], rows[1].0[lane], rows[2].0[lane]);
        let (m, t) = self.settings.anchor.matrix();
        // The same arithmetic as the kernel's, so that a body at rest has the same bits.
        m.x_axis * local.x + m.y_axis * local.y + m.z_axis * local.z + t
    }
}

/// Instruction sets of this processor, the best first. Not SSE4.2: its kernels had the bits of SSE2's and were slower.
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
