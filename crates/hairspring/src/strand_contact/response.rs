//! The response of a strand to an impulse on one of its segments within a substep, from masses and bending.
//!
//! ```text
//! (M + h² K) δ = f,    K = Σ B c cᵀ at the joints,    c = (1/L₀, −1/L₀ − 1/L₁, 1/L₁)
//! ```
//!
//! A single point of fine hair is light, but stiff bending moves the hair around it too. With the point's own
//! mass alone, the impulse would be far too small. The system is solved in a window around the segment, with
//! the bending of the strand's solve (Bergou et al. 2008, eq. 2) treated as isotropic.

use super::hair::Hair;

/// Points in the window. Bending moves about a centimeter of hair in a substep of 1/240 s, and segments are
/// rarely shorter than 2 mm.
pub const WINDOW_POINTS: usize = 8;

/// Velocity changes of the points from `first` on, for a unit of impulse on a segment.
#[derive(Clone, Copy)]
pub struct Response {
    first: u32,
    count: u32,
    /// Velocity change over impulse [1/kg].
    change: [f32; WINDOW_POINTS],
}

impl Response {
    /// Computes the response of the segment from point `i` to an impulse at the fraction `s` of its length,
    /// in a substep of `h` [s].
    pub fn of(i: u32, s: f32, hair: &Hair, h: f32) -> Self {
        let i = i as usize;
        let strand = hair.strand(hair.of[i] as usize);
        let first = i.saturating_sub(WINDOW_POINTS / 2 - 1).max(strand.start);
        let count = (strand.end - first).min(WINDOW_POINTS);
        // Rows of the upper band: the diagonal, and the next two.
        let mut a = [[0.0_f32; 3]; WINDOW_POINTS];
        let mut change = [0.0; WINDOW_POINTS];
        (change[i - first], change[i + 1 - first]) = (1.0 - s, s);
        for k in 0..count {
            let mass = hair.inverse_mass[first + k];
            a[k][0] += if mass > 0.0 { mass.recip() } else { 0.0 };
            if k + 2 < count {
                let [l0, l1] = [first + k, first + k + 1].map(|p| hair.inverse_length[p]);
                let c = [l0, -l0 - l1, l1];
                let bend = h * h * hair.bend[first + k + 1];
                for p in 0..3 {
                    for q in p..3 {
                        a[k + p][q - p] += bend * c[p] * c[q];
                    }
                }
            }
        }
        // LDLᵀ without the driven points.
        let mut inverse = [0.0_f32; WINDOW_POINTS];
        for k in 0..count {
            if hair.inverse_mass[first + k] > 0.0 {
                inverse[k] = a[k][0].recip();
            }
            let [l1, l2] = [a[k][1] * inverse[k], a[k][2] * inverse[k]];
            if k + 1 < count {
                a[k + 1][0] -= l1 * a[k][1];
                a[k + 1][1] -= l1 * a[k][2];
                change[k + 1] -= l1 * change[k];
            }
            if k + 2 < count {
                a[k + 2][0] -= l2 * a[k][2];
                change[k + 2] -= l2 * change[k];
            }
        }
        for k in (0..count).rev() {
            let at = |j: usize| if k + j < count { a[k][j] * change[k + j] } else { 0.0 };
            change[k] = (change[k] - at(1) - at(2)) * inverse[k];
        }
        Self { first: first as u32, count: count as u32, change }
    }

    /// Velocity change over impulse, at the fraction `s` of the segment from point `i` [1/kg].
    pub fn inverse_effective_mass(&self, i: u32, s: f32) -> f32 {
        let k = (i - self.first) as usize;
        (1.0 - s) * self.change[k] + s * self.change[k + 1]
    }

    /// Applies the velocity changes of an impulse [N s].
    pub fn apply_impulse(&self, impulse: glam::Vec3, hair: &mut Hair) {
        let first = self.first as usize;
        let count = self.count as usize;
        for (v, change) in hair.v[first..first + count].iter_mut().zip(self.change) {
            *v += impulse * change;
        }
    }
}
