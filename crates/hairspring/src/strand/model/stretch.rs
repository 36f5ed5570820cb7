//! Stretch: a moderate spring along each segment inside the implicit solve; what it leaves, projection removes.
//!
//! ```text
//!   x_i ~~~~/\/\/\~~~~ x_{i+1}     f = k (ℓ − L) û,   K = k [ ûûᵀ + max(0, 1 − L/ℓ)(I − ûûᵀ) ]
//! ```
//!
//! Kept positive semi-definite under compression (Choi & Ko 2002). The stiffness is [`STRETCH`] m/h² and not the fibre's
//! EA/L, which is a hundred times more: one linearised solve is not stable there, and the projection that follows
//! makes the segment inextensible all the same.

use crate::strand::lanes::{F, Sym3, V3};
use fearless_simd::prelude::*;

/// Stretch stiffness in units of m/h² [1]. Stable in every test from 10² to 10³; above about 10⁴ it blows up.
pub const STRETCH: f32 = 400.0;

/// Tension below which a taut strand's sideways motion needs no stiffness in the matrix, in units of L m/h² [1]: the
/// explicit limit of a chain under tension is 1, where 4 T h² / (L m) = 4.
const EXPLICIT_TENSION: f32 = 0.25;

/// A segment: force on the nearer point (the farther gets its opposite) [N], and stiffness block [N/m].
///
/// `tension` [N] is what the last substep found to hold the segment at its length; carrying it over (as an augmented
/// Lagrangian does) makes a strand at rest stay at rest exactly, whatever the stiffness of the spring. Its sideways stiffness
/// T/ℓ is left out of the matrix while explicit treatment is stable, because there it keeps the swing alive.
#[inline(always)]
pub fn stretch<S: Simd>((length, u): (F<S>, V3<S>), rest: F<S>, k: F<S>, tension: F<S>) -> (V3<S>, Sym3<S>) {
    let force = u * (k.mul_add(length - rest, tension));
    let slack = k * (F::splat(rest.simd, 1.0) - rest / length);
    let taut = tension / length - k * (EXPLICIT_TENSION / STRETCH);
    let across = slack.max(taut).max(0.0).min(k);
    (force, Sym3::outer(u, k - across).add_identity(across))
}
