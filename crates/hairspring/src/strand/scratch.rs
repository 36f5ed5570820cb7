//! Working memory of one thread, reused for every tile that it solves.

use super::{
    bordered, contact,
    precomputed::Precomputed,
    profile::Profile,
    project,
    tile::{StateRows, state},
};
use crate::simd::lanes::{Simd, V3, Work};

/// Working memory of one thread, as large as the longest tile it has solved.
#[derive(Default)]
pub struct Memory {
    factors: Vec<Work>,
    altitude_springs: Vec<bordered::Eliminated>,
    edges: Vec<[Work; 3]>,
    kick: Vec<[Work; 3]>,
    change: Vec<[Work; 3]>,
    contacts: Vec<[Work; contact::scratch::ROWS]>,
    pulls: Vec<[Work; project::scratch::ROWS]>,
    fixed: Vec<Precomputed>,
}

/// The part of the working memory that one tile uses. Arrays have the tile's length, so that loops along the
/// strand need no bounds checks.
pub struct Scratch<'a> {
    /// Factors of the band, point by point, with padding before the first point and after the last.
    /// `local_global` stores its rows in the same memory.
    pub factors: &'a mut [Work],
    /// Springs with eliminated force, as a stack with capacity for one a point.
    pub altitude_springs: &'a mut Vec<bordered::Eliminated>,
    /// New edges: vectors from each particle's predecessor to it, shape `[points + EDGE_PADDING]` [m]; see
    /// `state::EDGE`.
    pub edges: &'a mut [[Work; 3]],
    /// Velocity changes in addition to `(new − old) / h`, shape `[points]` [m/s]; used for forces before
    /// that. Only for integrators other than the implicit ones.
    pub kick: &'a mut [[Work; 3]],
    /// Position changes in one iteration, shape `[points]` [m].
    pub change: &'a mut [[Work; 3]],
    /// Contact data of the solve, shape `[points]`; see `contact::scratch`.
    pub contacts: &'a mut [[Work; contact::scratch::ROWS]],
    /// Elimination results of projection for each segment, shape `[points]`; see `project::scratch`.
    pub pulls: &'a mut [[Work; project::scratch::ROWS]],
    /// Values that stay constant for a frame, shape `[points]`.
    pub fixed: &'a mut [Precomputed],
}

/// Largest number of rows of factors a point: that of the rod.
const MAX_FACTORS: usize = Profile::<4, 11>::within(10).rows();

/// Largest number of preceding points that a point is coupled to: that of the springs model.
const MAX_REACH: usize = Profile::<3, 12>::REACH;

/// Edges after the last, so that three consecutive edges can be read at any point. They are finite, and no
/// result depends on them.
const EDGE_PADDING: usize = 3;

impl Memory {
    /// Returns the scratch memory for a tile of `points`.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn scratch(&mut self, points: usize) -> Scratch<'_> {
        self.reserve(points);
        Scratch {
            factors: &mut self.factors[..(points + 2 * MAX_REACH) * MAX_FACTORS],
            altitude_springs: &mut self.altitude_springs,
            edges: &mut self.edges[..points + EDGE_PADDING],
            kick: &mut self.kick[..points],
            change: &mut self.change[..points],
            contacts: &mut self.contacts[..points],
            pulls: &mut self.pulls[..points],
            fixed: &mut self.fixed[..points],
        }
    }

    /// Grows the memory for a tile of `points`.
    fn reserve(&mut self, points: usize) {
        if self.fixed.len() < points {
            self.factors.resize((points + 2 * MAX_REACH) * MAX_FACTORS, Work::default());
            self.altitude_springs.reserve(points);
            self.kick.resize(points, [Work::default(); 3]);
            self.change.resize(points, [Work::default(); 3]);
            self.edges.resize(points + EDGE_PADDING, [Work::default(); 3]);
            self.contacts.resize(points, [Work::default(); contact::scratch::ROWS]);
            self.pulls.resize(points, [Work::default(); project::scratch::ROWS]);
            self.fixed.resize(points, Precomputed::default());
        }
    }
}

impl Scratch<'_> {
    /// Borrows the same scratch again, for a function outside of the sweep: see [`Tile::reborrow`].
    ///
    /// [`Tile::reborrow`]: super::tile::Tile::reborrow
    #[inline(always)]
    pub fn reborrow(&mut self) -> Scratch<'_> {
        let Self { factors, altitude_springs, edges, kick, change, contacts, pulls, fixed } = self;
        Scratch { factors, altitude_springs, edges, kick, change, contacts, pulls, fixed }
    }

    /// Fills `edges` from those in `state`, shape `[points]`.
    #[inline(always)]
    pub fn begin<S: Simd>(&mut self, simd: S, state: &[StateRows]) {
        for (edge, at) in self.edges.iter_mut().zip(state) {
            V3::load(simd, &at[state::EDGE..]).store(edge);
        }
        self.edges[state.len()..state.len() + EDGE_PADDING].fill([Work::default(); 3]);
    }
}
