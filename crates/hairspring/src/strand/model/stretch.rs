//! Stretch: a moderate spring along each segment inside the implicit solve; what it leaves, projection removes.
//!
//! ```text
//!   x_i ~~~~/\/\/\~~~~ x_{i+1}     f = [k (ℓ − L) + T] û,   K = k ûûᵀ + max(0, f, T)/ℓ (I − ûûᵀ)
//! ```
//!
//! Kept positive semi-definite under compression (Choi & Ko 2002). The stiffness is [`STRETCH`] m/h² and not the fibre's
//! EA/L, which is a hundred times more: one linearised solve is not stable there, and the projection that follows
//! makes the segment inextensible all the same.

use crate::{
    simd::lanes::{F, Mask, Simd, Sym3, V3, load},
    strand::tile::{Tile, rest, strand},
};

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

/// How many times stiffer than [`STRETCH`] the segments of a strand of so many `points` are, 1 up to 32 of them [1].
///
/// A spring of k m/h² carries a change of load along √k points in a substep: 20 of them with [`STRETCH`], which is enough for 32. What it
/// does not reach is left to projection, and a long strand trembles with it: 64 points over 2 m by 3 mm/s at rest; a coil of 1,024 points drives itself at
/// 0.5 m/s for seconds after a shake. This stops both.
pub fn stiffening(points: usize) -> f32 {
    (points as f32 / 32.0).powi(2).max(1.0)
}

/// Stretch stiffness of up to 32 points in units of m/h² [1]. Stable in every test from 10² to 10³.
pub const STRETCH: f32 = 400.0;

/// Least share of a substep's drift δ₀ = h v that sideways tension is linearised at, with backward Euler [1].
///
/// A swing of angular frequency ω, M a = −K (x + γ h v + h² a), keeps its amplitude for γ = 0 and loses ½ γ h ω² of it a second in first order; with γ = 1
/// this is backward Euler, and a pendulum of 64 points loses a quarter of a swing of 90° in a period. The step is stable for any stiffness and any γ ≥ 0, because
/// the matrix has h² K added to the mass. The value was chosen by trial: the pendulum of `validate` passes up to 0.148, curls came to rest and thin rods kept
/// their hair at 0.1, 0.15 and 0.2. A swing of 26 cm at 240 substeps a second loses 1.4 % of its width in each period. Open: in a wind of 5 m/s strands of 256 points
/// need 0.3 to come to rest.
pub const SIDEWAYS: f32 = 0.143;

/// The same with BDF2, which is of second order with all of it [1].
pub const SIDEWAYS_BDF2: f32 = 1.0;

/// Sideways stiffness T/ℓ above which all of the drift counts, in units of m/h² [1]: of the excess, γ is 1.
///
/// At rest, strands have up to N g h²/ℓ of it at the root: 11 with 130 points over 26 cm at 240 substeps a second. What is more is a ride or a blow.
const SWINGS: f32 = 12.0;

/// The same of strands that touch something [1]. A contact's force is of the step before, which feeds what trembles on it, and nothing that touches swings freely:
/// a quarter of the stiffness at which a chain without any damping blows up, T/ℓ = m/h² (ω h = 2 of its highest mode).
const TOUCHES: f32 = 0.25;

/// How much of a tense segment's pull turns with the drift: γ T/ℓ, or what is above a bound.
#[derive(Clone, Copy)]
pub struct Sideways<S: Simd> {
    /// γ [1].
    share: F<S>,
    /// The bound over the mass of the segment's farther point [1/s²].
    bound: F<S>,
}

impl<S: Simd> Sideways<S> {
    /// Of strands in substeps of `h` [s], of which some touch something; `share` is the least γ.
    #[inline(always)]
    pub fn new(simd: S, share: f32, h: f32, touches: Mask<S>) -> Self {
        let bound = |units: f32| F::splat(simd, units / (h * h));
        Self { share: F::splat(simd, share), bound: touches.select(bound(TOUCHES), bound(SWINGS)) }
    }

    /// Of a segment with this sideways stiffness T/ℓ [N/m], whose farther point has this `mass` [kg].
    #[inline(always)]
    fn of(&self, stiffness: F<S>, mass: F<S>) -> F<S> {
        (stiffness * self.share).max(stiffness - mass * self.bound)
    }
}

/// The same of a single number: stiffness [N/m], mass [kg] and length of a substep [s].
#[cfg(test)]
pub fn sideways(share: f64, touches: bool, stiffness: f64, (mass, h): (f64, f64)) -> f64 {
    let units = if touches { TOUCHES } else { SWINGS };
    (stiffness * share).max(stiffness - mass * f64::from(units) / (h * h))
}

/// A segment: force on the nearer point (the farther gets its opposite) where the solve begins [N], and stiffness block [N/m].
///
/// `longer` is by how much it is longer than at rest [m], as far as its tension does not know yet.
/// `tension` [N] is what the last substep found to hold the segment at its length; carrying it over (as an augmented
/// Lagrangian does) makes a strand at rest stay at rest exactly, whatever the stiffness of the spring. `drift` is how far its farther end drifts from its
/// nearer one before the solve begins [m]. `mass` is the farther point's [kg].
#[inline(always)]
pub fn stretch<S: Simd>(
    (length, u): (F<S>, V3<S>),
    longer: F<S>,
    (k, tension, mass): (F<S>, F<S>, F<S>),
    drift: V3<S>,
    sideways: &Sideways<S>,
) -> (V3<S>, Sym3<S>) {
    let pull = k.mul_add(longer, tension);
    let across = (pull.max(tension) / length).max(0.0).min(k);
    // By the tension alone: what projection leaves of lengths is noise, of which `pull` knows k times, and the part that pulls would brake a swing.
    let turned = sideways.of((tension / length).max(0.0).min(k), mass);
    let force = u * (k - turned).mul_add(u.dot(drift), pull) + drift * turned;
    (force, Sym3::outer(u, k - across).add_identity(across))
}
