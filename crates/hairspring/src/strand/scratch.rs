//! Working memory of one thread, reused by every tile that it runs.

use super::{band::factor_rows, lanes::Row, press};

/// Working memory of one thread.
#[derive(Default)]
pub struct Scratch {
    /// Factors of the band, point after point; other sweeps' rows lie over them.
    pub factors: Vec<Row>,
    /// New positions relative to the root, shape `[points]`.
    pub x: Vec<[Row; 3]>,
    /// What is added to the velocities of `(new − old) / h`, shape `[points]` [m/s]; forces before that. Of integrators other than the
    /// implicit ones.
    pub kick: Vec<[Row; 3]>,
    /// Changes of the positions in one iteration, shape `[points]` [m].
    pub change: Vec<[Row; 3]>,
    /// What the solve knows of contact, shape `[points]`; see `press::scratch`.
    pub contacts: Vec<[Row; press::scratch::ROWS]>,
    /// Inverse masses; 0 for driven points, held points and the padding.
    pub inverse_mass: Vec<Row>,
}

impl Scratch {
    /// Room for a tile of `points`.
    pub fn reserve(&mut self, points: usize) {
        if self.inverse_mass.len() < points {
            self.factors.resize(points * factor_rows(4, 12), Row::default());
            self.kick.resize(points, [Row::default(); 3]);
            self.change.resize(points, [Row::default(); 3]);
            self.x.resize(points, [Row::default(); 3]);
            self.contacts.resize(points, [Row::default(); press::scratch::ROWS]);
            self.inverse_mass.resize(points, Row::default());
        }
    }
}
