//! Stretch: a moderate spring along each segment inside the implicit solve; what it leaves, projection removes.
//!
//! ```text
//!   x_i ~~~~/\/\/\~~~~ x_{i+1}     f = [k (ℓ − L) + T] û,   K = k ûûᵀ + max(0, f/ℓ − ¼ m/h²)(I − ûûᵀ)
//! ```
//!
//! Kept positive semi-definite under compression (Choi & Ko 2002). The stiffness is [`STRETCH`] m/h² and not the fibre's
//! EA/L, which is a hundred times more: one linearised solve is not stable there, and the projection that follows
//! makes the segment inextensible all the same.

use crate::strand::{
    lanes::{F, Sym3, V3, load},
    tile::{Tile, rest, strand},
};
use fearless_simd::prelude::*;

/// Stiffness of the segments' springs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stretching {
    /// As stiff as one linearised solve bears; projection does the rest.
    Moderate,
    /// The fibre's own, EA/L.
    Fibre,
}

impl Stretching {
    /// Stiffness of the spring along the segment from `point` in a substep of `h` [s]; 0 for padding [N/m].
    #[inline(always)]
    pub fn stiffness<S: Simd>(self, simd: S, h: f32, tile: &Tile, point: usize) -> F<S> {
        let rest = &tile.rest[point];
        let length = load(simd, &rest[rest::LENGTH]);
        let k = match self {
            Self::Moderate => {
                let stiffening = load(simd, &tile.strand[strand::STIFFENING]);
                load(simd, &rest[rest::MASS]) * stiffening * (STRETCH / (h * h))
            }
            Self::Fibre => {
                load(simd, &tile.strand[strand::AXIAL]) * (F::splat(simd, 1.0) / length.max(1e-12))
            }
        };
        length.simd_gt(0.0).select(k, F::splat(simd, 0.0))
    }
}

/// How many times stiffer than [`STRETCH`] the segments of a strand of so many `points` are, 1 to 10 [1].
///
/// A spring of k m/h² carries a change of load along √k points in a substep: 20 of them with [`STRETCH`], which is enough for 32. What it
/// does not reach is left to projection, and a long strand trembles with it: 64 points over 2 m by 3 mm/s at rest, which this stops.
pub fn stiffening(points: usize) -> f32 {
    (points as f32 / 32.0).powi(2).clamp(1.0, 10.0)
}

/// Stretch stiffness in units of m/h² [1]. Stable in every test from 10² to 10³; above about 10⁴ it blows up.
pub const STRETCH: f32 = 400.0;

/// Tension below which a taut strand's sideways motion needs no stiffness in the matrix of backward Euler, over L k [1]: a quarter of
/// m/h², where the explicit limit of a chain under tension is 4 T h² / (L m) = 4.
pub const EXPLICIT_TENSION: f32 = 0.25 / STRETCH;

/// The same of BDF2 [1]: more feeds a swing (a tenth of its width a period at 0.25 m/h²), nothing at all damps it (by a quarter).
pub const EXPLICIT_TENSION_BDF2: f32 = 0.025 / STRETCH;

/// A segment: force on the nearer point (the farther gets its opposite) [N], and stiffness block [N/m].
///
/// `longer` is by how much it is longer than at rest [m], as far as its tension does not know yet.
/// `tension` [N] is what the last substep found to hold the segment at its length; carrying it over (as an augmented
/// Lagrangian does) makes a strand at rest stay at rest exactly, whatever the stiffness of the spring. The sideways stiffness
/// f/ℓ is left out of the matrix while explicit treatment is stable, because there it keeps the swing alive: with all of
/// it, a pendulum of 90° loses a quarter of its swing in a period. `explicit` is how much of it is left out, over `k` [1].
#[inline(always)]
pub fn stretch<S: Simd>(
    (length, u): (F<S>, V3<S>),
    longer: F<S>,
    k: F<S>,
    tension: F<S>,
    explicit: F<S>,
) -> (V3<S>, Sym3<S>) {
    let pull = k.mul_add(longer, tension);
    let across = (pull / length - k * explicit).max(0.0).min(k);
    (u * pull, Sym3::outer(u, k - across).add_identity(across))
}
