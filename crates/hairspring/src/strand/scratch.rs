//! Working memory of one thread, reused by every tile that it runs.

use super::{
    band::{factor_rows, reach},
    fixed::Fixed,
    lanes::Row,
    press,
    tile::StateRows,
    tile::state,
};

/// Working memory of one thread.
#[derive(Default)]
pub struct Scratch {
    /// Factors of the band, point after point, after zeros for those that the first would meet; other sweeps' rows lie over them.
    pub factors: Vec<Row>,
    /// From each particle's predecessor to it, anew, shape `[points + BEYOND]` [m]; see `state::EDGE`.
    pub edges: Vec<[Row; 3]>,
    /// What is added to the velocities of `(new − old) / h`, shape `[points]` [m/s]; forces before that. Of integrators other than the
    /// implicit ones.
    pub kick: Vec<[Row; 3]>,
    /// Changes of the positions in one iteration, shape `[points]` [m].
    pub change: Vec<[Row; 3]>,
    /// What the solve knows of contact, shape `[points]`; see `press::scratch`.
    pub contacts: Vec<[Row; press::scratch::ROWS]>,
    /// What stays as it is for an interval, shape `[points]`.
    pub fixed: Vec<Fixed>,
}

/// Most rows of factors a point, those of the rod.
const MOST_FACTORS: usize = factor_rows(4, 11, 10);

/// Most points that meet a point from before it, those of the springs.
const MOST_REACH: usize = reach(3, 12);

/// Edges after the last, so that three that follow each other can be read at any: they are finite and nothing depends on them.
const BEYOND: usize = 3;

impl Scratch {
    /// Fills `edges` from those in `state`, shape `[points]`.
    pub fn begin(&mut self, state: &[StateRows]) {
        for (edge, at) in self.edges.iter_mut().zip(state) {
            edge.copy_from_slice(&at[state::EDGE..state::EDGE + 3]);
        }
        self.edges[state.len()..state.len() + BEYOND].fill([Row::default(); 3]);
    }

    /// Room for a tile of `points`.
    pub fn reserve(&mut self, points: usize) {
        if self.fixed.len() < points {
            self.factors.resize((points + MOST_REACH) * MOST_FACTORS, Row::default());
            self.kick.resize(points, [Row::default(); 3]);
            self.change.resize(points, [Row::default(); 3]);
            self.edges.resize(points + BEYOND, [Row::default(); 3]);
            self.contacts.resize(points, [Row::default(); press::scratch::ROWS]);
            self.fixed.resize(points, Fixed::default());
        }
    }
}
