//! Propagation of contact impulses along a strand: segments keep their lengths, so an impulse on one point
//! also moves others.
//!
//! ```text
//! v_i ← v_i + (T_i u_i − T_{i−1} u_{i−1}) / m_i        u_i · (v_{i+1} − v_i) = 0
//! ```
//!
//! A tridiagonal system for the impulses T along the segments (Goldenthal et al. 2007, *Efficient Simulation
//! of Inextensible Cloth*, applied to velocities). It replaces the velocity change of external impulses by
//! the nearest one, in the mass metric, that stretches no segment.

use super::hair::Hair;
use glam::Vec3;

/// Working memory for one strand, and the velocities of all points before any impulse.
#[derive(Default)]
pub struct Propagation {
    /// Velocities before any impulse, shape `[points]` [m/s].
    before: Vec<Vec3>,
    /// Unit vectors of a strand's segments.
    units: Vec<Vec3>,
    /// Eliminated rows of the strand's system: the entry above the diagonal, and the right-hand side.
    rows: Vec<[f32; 2]>,
}

impl Propagation {
    /// Allocates memory for the strands of `hair`.
    pub fn new(hair: &Hair) -> Self {
        let longest = hair.strands().map(|s| s.len()).max().unwrap_or(0);
        Self {
            before: vec![Vec3::ZERO; hair.x.len()],
            units: Vec::with_capacity(longest),
            rows: Vec::with_capacity(longest),
        }
    }

    /// Stores the current velocities as those before any impulse.
    pub fn begin(&mut self, hair: &Hair) {
        self.before.copy_from_slice(&hair.v);
    }

    /// Change of the velocity of point `i` since [`Propagation::begin`] [m/s].
    pub fn change(&self, i: usize, hair: &Hair) -> Vec3 {
        hair.v[i] - self.before[i]
    }

    /// Projects all velocity changes so that no segment is stretched.
    pub fn keep_lengths(&mut self, hair: &mut Hair) {
        for s in 0..hair.strand_count() {
            let range = hair.strand(s);
            if hair.v[range.clone()] != self.before[range.clone()] {
                self.keep_lengths_of(range, hair);
            }
        }
    }

    fn keep_lengths_of(&mut self, range: std::ops::Range<usize>, hair: &mut Hair) {
        let (x, w) = (&hair.x[range.clone()], &hair.inverse_mass[range.clone()]);
        let (v, before) = (&mut hair.v[range.clone()], &self.before[range]);
        let (units, rows) = (&mut self.units, &mut self.rows);
        units.clear();
        units.extend(x.windows(2).map(|x| (x[1] - x[0]).normalize_or_zero()));
        rows.clear();
        let mut last = [0.0; 2];
        for (i, u) in units.iter().enumerate() {
            let stretching = u.dot((v[i + 1] - before[i + 1]) - (v[i] - before[i]));
            let below = if i > 0 { -w[i] * u.dot(units[i - 1]) } else { 0.0 };
            let above = units.get(i + 1).map_or(0.0, |next| -w[i + 1] * u.dot(*next));
            let diagonal = w[i] + w[i + 1] - below * last[0];
            // Segments with two driven ends, and folded segments that coincide to rounding, get no impulse.
            let inverse = if diagonal > 1e-6 * (w[i] + w[i + 1]) { diagonal.recip() } else { 0.0 };
            last = [above * inverse, (stretching - below * last[1]) * inverse];
            rows.push(last);
        }
        let mut after = 0.0;
        for (i, (row, u)) in rows.iter().zip(units.iter()).enumerate().rev() {
            after = row[1] - row[0] * after;
            v[i] += *u * (after * w[i]);
            v[i + 1] -= *u * (after * w[i + 1]);
        }
    }
}
