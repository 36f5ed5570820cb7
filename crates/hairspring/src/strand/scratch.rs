//! Working memory of one thread, reused by every tile that it runs.

use super::{
    bordered, contact,
    precomputed::Precomputed,
    profile::Profile,
    project,
    tile::{StateRows, state},
};
use crate::simd::lanes::{Simd, V3, Work};

/// Working memory of one thread, as large as the longest tile that it ran.
#[derive(Default)]
pub struct Memory {
    factors: Vec<Work>,
    across: Vec<bordered::Eliminated>,
    edges: Vec<[Work; 3]>,
    kick: Vec<[Work; 3]>,
    change: Vec<[Work; 3]>,
    contacts: Vec<[Work; contact::scratch::ROWS]>,
    pulls: Vec<[Work; project::scratch::ROWS]>,
    fixed: Vec<Precomputed>,
}

/// What one tile needs of it, cut to the tile's length, so that walks along the strand need no checks.
pub struct Scratch<'a> {
    /// Factors of the band, point after point, between those that the first and the last would meet; `local_global`'s rows lie over them.
    pub factors: &'a mut [Work],
    /// Springs whose force has been eliminated, the last on top; with room for one a point.
    pub across: &'a mut Vec<bordered::Eliminated>,
    /// From each particle's predecessor to it, anew, shape `[points + BEYOND]` [m]; see `state::EDGE`.
    pub edges: &'a mut [[Work; 3]],
    /// What is added to the velocities of `(new − old) / h`, shape `[points]` [m/s]; forces before that. Of integrators other than the
    /// implicit ones.
    pub kick: &'a mut [[Work; 3]],
    /// Changes of the positions in one iteration, shape `[points]` [m].
    pub change: &'a mut [[Work; 3]],
    /// What the solve knows of contact, shape `[points]`; see `contact::scratch`.
    pub contacts: &'a mut [[Work; contact::scratch::ROWS]],
    /// What projection has worked out of each segment, shape `[points]`; see `project::scratch`.
    pub pulls: &'a mut [[Work; project::scratch::ROWS]],
    /// What stays as it is for an interval, shape `[points]`.
    pub fixed: &'a mut [Precomputed],
}

/// Most rows of factors a point, those of the rod.
const MOST_FACTORS: usize = Profile::<4, 11>::within(10).rows();

/// Most points that meet a point from before it, those of the springs.
const MOST_REACH: usize = Profile::<3, 12>::REACH;

/// Edges after the last, so that three that follow each other can be read at any: they are finite and nothing depends on them.
const BEYOND: usize = 3;

impl Memory {
    /// What a tile of `points` needs.
    #[inline(always)]
    pub fn scratch(&mut self, points: usize) -> Scratch<'_> {
        self.reserve(points);
        Scratch {
            factors: &mut self.factors[..(points + 2 * MOST_REACH) * MOST_FACTORS],
            across: &mut self.across,
            edges: &mut self.edges[..points + BEYOND],
            kick: &mut self.kick[..points],
            change: &mut self.change[..points],
            contacts: &mut self.contacts[..points],
            pulls: &mut self.pulls[..points],
            fixed: &mut self.fixed[..points],
        }
    }

    /// Room for a tile of `points`.
    fn reserve(&mut self, points: usize) {
        if self.fixed.len() < points {
            self.factors.resize((points + 2 * MOST_REACH) * MOST_FACTORS, Work::default());
            self.across.reserve(points);
            self.kick.resize(points, [Work::default(); 3]);
            self.change.resize(points, [Work::default(); 3]);
            self.edges.resize(points + BEYOND, [Work::default(); 3]);
            self.contacts.resize(points, [Work::default(); contact::scratch::ROWS]);
            self.pulls.resize(points, [Work::default(); project::scratch::ROWS]);
            self.fixed.resize(points, Precomputed::default());
        }
    }
}

impl Scratch<'_> {
    /// The same, for a function that is no part of the walk: see [`Tile::reborrow`].
    ///
    /// [`Tile::reborrow`]: super::tile::Tile::lent
    #[inline(always)]
    pub fn reborrow(&mut self) -> Scratch<'_> {
        let Self { factors, across, edges, kick, change, contacts, pulls, fixed } = self;
        Scratch { factors, across, edges, kick, change, contacts, pulls, fixed }
    }

    /// Fills `edges` from those in `state`, shape `[points]`.
    #[inline(always)]
    pub fn begin<S: Simd>(&mut self, simd: S, state: &[StateRows]) {
        for (edge, at) in self.edges.iter_mut().zip(state) {
            V3::load(simd, &at[state::EDGE..]).store(edge);
        }
        self.edges[state.len()..state.len() + BEYOND].fill([Work::default(); 3]);
    }
}
