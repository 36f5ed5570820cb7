//! What the world does to points besides gravity, bodies and holds: found once a frame, frozen for its substeps.
//!
//! Everything here adds to a point's own block of the diagonal and to its right-hand side: it is implicit, and couples no two strands.
//! The hair volume writes first, then each effect adds its part, strand by strand, one file an effect:
//!
//! | effect | |
//! | --- | --- |
//! | [`global_shape`] | a weak pull to the rest shape |
//! | [`grab`] | a hand holds what is in a ball |
//! | [`comb`] | tines take hair along across itself |
//! | [`tie`] | a ring gathers strands |
//! | [`charge`] | charged bodies, and charged hair |
//! | [`wind`] | moving air that is not the same everywhere |

pub(crate) mod bond;
pub mod charge;
pub mod comb;
pub mod global_shape;
pub mod grab;
mod hair_field;
mod manipulator;
mod strand_view;
pub mod tie;
mod wind;

pub(crate) use charge::Charges;
pub(crate) use hair_field::HairField;
pub(crate) use manipulator::ActiveManipulator;
pub use manipulator::Manipulator;
pub(crate) use strand_view::StrandView;
pub(crate) use wind::WindSampler;

use crate::{
    math::RigidTransform,
    simd::lanes::{LANES, Row},
    strand::tile::{RestRows, StateRows, StrandRows, TilePlace, anisotropic_drag, position_spring},
};

/// What acts on the points of all tiles in a frame; shapes `[points]` of all tiles, or empty where nothing of the kind is on.
#[derive(Default)]
pub(crate) struct ForceBuffers {
    /// See `Tile::external_acceleration`.
    pub external_acceleration: Vec<[Row; 3]>,
    /// See `Tile::position_spring`.
    pub position_spring: Vec<[Row; position_spring::ROWS]>,
    /// See `Tile::anisotropic_drag`.
    pub anisotropic_drag: Vec<[Row; anisotropic_drag::ROWS]>,
    /// See `Tile::wind_delta`.
    pub wind_delta: Vec<[Row; 3]>,
}

/// What kinds of action there are in a frame.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct ForceMask {
    /// Accelerations.
    pub external_acceleration: bool,
    /// Pulls to a place or to a velocity; with them, accelerations.
    pub position_spring: bool,
    /// What takes points along across their strands.
    pub anisotropic_drag: bool,
    /// Air that moves otherwise than the wind of all points.
    pub wind_delta: bool,
}

impl ForceBuffers {
    /// Room for what acts on `points`, of which nothing does yet.
    pub fn prepare(&mut self, points: usize, kinds: ForceMask) {
        let size = |on: bool| if on { points } else { 0 };
        self.external_acceleration
            .resize(size(kinds.external_acceleration || kinds.position_spring), [Row::default(); 3]);
        self.position_spring.resize(size(kinds.position_spring), [Row::default(); position_spring::ROWS]);
        self.anisotropic_drag.resize(size(kinds.anisotropic_drag), [Row::default(); anisotropic_drag::ROWS]);
        self.wind_delta.resize(size(kinds.wind_delta), [Row::default(); 3]);
        self.external_acceleration.fill([Row::default(); 3]);
        self.position_spring.fill([Row::default(); position_spring::ROWS]);
        self.anisotropic_drag.fill([Row::default(); anisotropic_drag::ROWS]);
        self.wind_delta.fill([Row::default(); 3]);
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.external_acceleration[..])
            + size_of_val(&self.position_spring[..])
            + size_of_val(&self.anisotropic_drag[..])
            + size_of_val(&self.wind_delta[..])
    }
}

/// Tiles, and what acts on their points.
pub(crate) struct StrandBatch<'a> {
    pub tiles: &'a [TilePlace],
    /// Strand of the groom in each lane; `u32::MAX` in lanes without one.
    pub lanes: &'a [u32],
    pub strand: &'a [StrandRows],
    pub rest: &'a [RestRows],
    pub state: &'a [StateRows],
    pub external_acceleration: &'a mut [[Row; 3]],
    pub position_spring: &'a mut [[Row; position_spring::ROWS]],
    pub anisotropic_drag: &'a mut [[Row; anisotropic_drag::ROWS]],
    pub wind_delta: &'a mut [[Row; 3]],
}

/// The frame that acts: pose of the anchor at its start and its end, and its length [s].
#[derive(Clone, Copy)]
pub(crate) struct FrameMotion {
    pub anchor: [RigidTransform; 2],
    pub dt: f32,
}

/// Tiles that one task visits.
const TILES_PER_TASK: usize = 32;

impl StrandBatch<'_> {
    /// Shows every strand to `act`, on all threads.
    pub fn each(&mut self, frame: &FrameMotion, act: &(impl Fn(&mut StrandView) + Sync)) {
        let count = self.tiles.len();
        if count > TILES_PER_TASK {
            let (mut a, mut b) = self.split(count / 2);
            rayon::join(|| a.each(frame, act), || b.each(frame, act));
            return;
        }
        for (k, place) in self.tiles.iter().enumerate() {
            let first = (place.first - self.tiles[0].first) as usize;
            let points = first..first + place.points as usize;
            let all = |len: usize| if len == 0 { 0..0 } else { points.clone() };
            for lane in 0..LANES {
                let strand = self.lanes[k * LANES + lane];
                if strand == u32::MAX {
                    continue;
                }
                let [accelerations, springs, drags, winds] = [
                    self.external_acceleration.len(),
                    self.position_spring.len(),
                    self.anisotropic_drag.len(),
                    self.wind_delta.len(),
                ]
                .map(all);
                act(&mut StrandView {
                    strand: strand as usize,
                    frame,
                    lane,
                    stride: place.model.stride(),
                    rows: &self.strand[k],
                    rest: &self.rest[points.clone()],
                    state: &self.state[points.clone()],
                    external_acceleration: &mut self.external_acceleration[accelerations],
                    position_spring: &mut self.position_spring[springs],
                    anisotropic_drag: &mut self.anisotropic_drag[drags],
                    wind_delta: &mut self.wind_delta[winds],
                });
            }
        }
    }

    /// The first `count` tiles, and the others.
    fn split(&mut self, count: usize) -> (StrandBatch<'_>, StrandBatch<'_>) {
        let points = (self.tiles[count].first - self.tiles[0].first) as usize;
        let (tiles, more_tiles) = self.tiles.split_at(count);
        let (lanes, more_lanes) = self.lanes.split_at(count * LANES);
        let (strand, more_strand) = self.strand.split_at(count);
        let (rest, more_rest) = self.rest.split_at(points);
        let (state, more_state) = self.state.split_at(points);
        let (external_acceleration, more_external_acceleration) =
            self.external_acceleration.split_at_mut(points.min(self.external_acceleration.len()));
        let (position_spring, more_position_spring) =
            self.position_spring.split_at_mut(points.min(self.position_spring.len()));
        let (anisotropic_drag, more_anisotropic_drag) =
            self.anisotropic_drag.split_at_mut(points.min(self.anisotropic_drag.len()));
        let (wind_delta, more_wind_delta) = self.wind_delta.split_at_mut(points.min(self.wind_delta.len()));
        (
            StrandBatch {
                tiles,
                lanes,
                strand,
                rest,
                state,
                external_acceleration,
                position_spring,
                anisotropic_drag,
                wind_delta,
            },
            StrandBatch {
                tiles: more_tiles,
                lanes: more_lanes,
                strand: more_strand,
                rest: more_rest,
                state: more_state,
                external_acceleration: more_external_acceleration,
                position_spring: more_position_spring,
                anisotropic_drag: more_anisotropic_drag,
                wind_delta: more_wind_delta,
            },
        )
    }
}
