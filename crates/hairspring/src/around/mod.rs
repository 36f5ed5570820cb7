//! What the world does to points besides gravity, bodies and holds: found once a frame, frozen for its substeps.
//!
//! Everything here adds to a point's own block of the diagonal and to its right-hand side (DESIGN §5): it is implicit, and couples no two strands.
//! The hair volume writes first, then each effect adds its part, strand by strand, one file an effect:
//!
//! | effect | |
//! | --- | --- |
//! | [`ghost`] | a weak pull to the rest shape |
//! | [`grab`] | a hand holds what is in a ball |
//! | [`comb`] | tines take hair along across itself |
//! | [`tie`] | a ring gathers strands |
//! | [`charge`] | charged bodies, and charged hair |
//! | [`wind`] | moving air that is not the same everywhere |

pub(crate) mod bond;
pub mod charge;
pub mod comb;
pub mod ghost;
pub mod grab;
mod hair_field;
mod strand;
pub mod tie;
mod tool;
mod wind;

pub(crate) use charge::Charges;
pub(crate) use hair_field::HairField;
pub(crate) use strand::Surrounded;
pub use tool::Tool;
pub(crate) use tool::Used;
pub(crate) use wind::Blow;

use crate::{
    collide::Rigid,
    simulation::TilePlace,
    strand::{
        lanes::{LANES, Row},
        tile::{RestRows, StateRows, StrandRows, grip, tines},
    },
};

/// What acts on the points of all tiles in a frame; shapes `[points]` of all tiles, or empty where nothing of the kind is on.
#[derive(Default)]
pub(crate) struct Around {
    /// See `Tile::push`.
    pub push: Vec<[Row; 3]>,
    /// See `Tile::grip`.
    pub grip: Vec<[Row; grip::ROWS]>,
    /// See `Tile::tines`.
    pub tines: Vec<[Row; tines::ROWS]>,
    /// See `Tile::air`.
    pub air: Vec<[Row; 3]>,
}

/// What kinds of action there are in a frame.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Kinds {
    /// Accelerations.
    pub push: bool,
    /// Pulls to a place or to a velocity; with them, accelerations.
    pub grip: bool,
    /// What takes points along across their strands.
    pub tines: bool,
    /// Air that moves otherwise than the wind of all points.
    pub air: bool,
}

impl Around {
    /// Room for what acts on `points`, of which nothing does yet.
    pub fn prepare(&mut self, points: usize, kinds: Kinds) {
        let size = |on: bool| if on { points } else { 0 };
        self.push.resize(size(kinds.push || kinds.grip), [Row::default(); 3]);
        self.grip.resize(size(kinds.grip), [Row::default(); grip::ROWS]);
        self.tines.resize(size(kinds.tines), [Row::default(); tines::ROWS]);
        self.air.resize(size(kinds.air), [Row::default(); 3]);
        self.push.fill([Row::default(); 3]);
        self.grip.fill([Row::default(); grip::ROWS]);
        self.tines.fill([Row::default(); tines::ROWS]);
        self.air.fill([Row::default(); 3]);
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.push[..])
            + size_of_val(&self.grip[..])
            + size_of_val(&self.tines[..])
            + size_of_val(&self.air[..])
    }
}

/// Tiles, and what acts on their points.
pub(crate) struct Strands<'a> {
    pub tiles: &'a [TilePlace],
    /// Strand of the groom in each lane; `u32::MAX` in lanes without one.
    pub lanes: &'a [u32],
    pub strand: &'a [StrandRows],
    pub rest: &'a [RestRows],
    pub state: &'a [StateRows],
    pub push: &'a mut [[Row; 3]],
    pub grip: &'a mut [[Row; grip::ROWS]],
    pub tines: &'a mut [[Row; tines::ROWS]],
    pub air: &'a mut [[Row; 3]],
}

/// The frame that acts: pose of the anchor at its start and its end, and its length [s].
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub anchor: [Rigid; 2],
    pub dt: f32,
}

/// Tiles that one task visits.
const TILES_PER_TASK: usize = 32;

impl Strands<'_> {
    /// Shows every strand to `act`, on all threads.
    pub fn each(&mut self, frame: &Frame, act: &(impl Fn(&mut Surrounded) + Sync)) {
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
                let (push, grip, air) = (all(self.push.len()), all(self.grip.len()), all(self.air.len()));
                let tines = all(self.tines.len());
                act(&mut Surrounded {
                    strand: strand as usize,
                    frame,
                    lane,
                    stride: place.model.stride(),
                    rows: &self.strand[k],
                    rest: &self.rest[points.clone()],
                    state: &self.state[points.clone()],
                    push: &mut self.push[push],
                    grip: &mut self.grip[grip],
                    tines: &mut self.tines[tines],
                    air: &mut self.air[air],
                });
            }
        }
    }

    /// The first `count` tiles, and the others.
    fn split(&mut self, count: usize) -> (Strands<'_>, Strands<'_>) {
        let points = (self.tiles[count].first - self.tiles[0].first) as usize;
        let (tiles, more_tiles) = self.tiles.split_at(count);
        let (lanes, more_lanes) = self.lanes.split_at(count * LANES);
        let (strand, more_strand) = self.strand.split_at(count);
        let (rest, more_rest) = self.rest.split_at(points);
        let (state, more_state) = self.state.split_at(points);
        let (push, more_push) = self.push.split_at_mut(points.min(self.push.len()));
        let (grip, more_grip) = self.grip.split_at_mut(points.min(self.grip.len()));
        let (tines, more_tines) = self.tines.split_at_mut(points.min(self.tines.len()));
        let (air, more_air) = self.air.split_at_mut(points.min(self.air.len()));
        (
            Strands { tiles, lanes, strand, rest, state, push, grip, tines, air },
            Strands {
                tiles: more_tiles,
                lanes: more_lanes,
                strand: more_strand,
                rest: more_rest,
                state: more_state,
                push: more_push,
                grip: more_grip,
                tines: more_tines,
                air: more_air,
            },
        )
    }
}
