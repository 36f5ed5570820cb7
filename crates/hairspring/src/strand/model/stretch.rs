//! Stretch: a spring of moderate stiffness along each segment inside the implicit solve. Projection removes
//! the remaining error.
//!
//! ```text
//!   x_i ~~~~/\/\/\~~~~ x_{i+1}     f = [k (ℓ − L) + T] û,   K = k ûûᵀ + max(0, f, T)/ℓ (I − ûûᵀ)
//! ```
//!
//! The matrix stays positive semi-definite under compression (Choi & Ko 2002). The stiffness is [`STRETCH`]
//! m/h² instead of the fiber's EA/L, which is a hundred times higher. A single linearized solve is unstable
//! at EA/L, and the projection that follows makes the segment inextensible in either case.

use crate::{
    simd::lanes::{F, Mask, Simd, Sym3, V3, load},
    strand::tile::{Tile, rest, strand},
};

/// Stiffness of the segments' springs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stretching {
    /// The highest stiffness at which one linearized solve is stable; projection does the rest.
    Moderate,
    /// The fiber's own stiffness, EA/L.
    Fiber,
}

impl Stretching {
    /// Stiffness of the spring along the segment that begins at `point`, in a substep of `h` [s]; 0 for
    /// padding [N/m].
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn stiffness<S: Simd>(self, simd: S, h: f32, tile: &Tile, point: usize) -> F<S> {
        let rest = &tile.rest[point];
        let length = load(simd, &rest[rest::LENGTH]);
        let k = match self {
            Self::Moderate => {
                let stiffening = load(simd, &tile.strand[strand::STIFFENING]);
                load(simd, &rest[rest::MASS]) * stiffening * (STRETCH / (h * h))
            }
            Self::Fiber => {
                load(simd, &tile.strand[strand::AXIAL]) * (F::splat(simd, 1.0) / length.max(1e-12))
            }
        };
        length.simd_gt(0.0).select(k, F::splat(simd, 0.0))
    }
}

/// Segment stiffness of a strand with this number of `points`, relative to [`STRETCH`]; 1 for up to 32 points
/// [1].
///
/// A spring of k m/h² carries a change of load along √k points in a substep. With [`STRETCH`] that is 20
/// points, which is enough for strands of 32. The rest is left to projection, which makes a long strand
/// vibrate: 64 points over 2 m at 3 mm/s at rest, and a coil of 1,024 points drives itself at 0.5 m/s for
/// seconds after a shake. The higher stiffness prevents both.
pub fn stiffening(points: usize) -> f32 {
    (points as f32 / 32.0).powi(2).max(1.0)
}

/// Stretch stiffness of strands of up to 32 points, in units of m/h² [1]. Stable in every test from 10² to
/// 10³.
pub const STRETCH: f32 = 400.0;

/// Share β of the force that a segment's spring exerts in a substep that is carried to the next one as tension, for
/// strands at rest in contact with a collider that is no hull [1]. It grows with their speed, and others carry all of it.
///
/// Carried forces are the integral part of a controller that keeps the length. For a vibration with the stiffness k
/// and the mass m, with κ = k h²/m, a substep multiplies the amplitude by 1/(1 − u), where
///
/// ```text
/// u³ + (1 − β) κ u + β κ = 0
/// ```
///
/// At β = 1 it grows if κ < 1. Projection stops that on a free strand, because it moves the points as the whole strand
/// moves. It does not take friction into account, which holds a point. A span between the root and an edge that the strand lies on
/// gained 0.8 % in each substep, and trembled at 6 mm/s. The proportional part, 1 − β, damps it. Found by trial: with 8
/// substeps, strands over some edges tremble at 0.5, and not at 0.4 or 0.3.
pub const CARRIED: f32 = 0.3;

/// Minimum share γ of a substep's predicted displacement δ₀ = h v at which lateral tension forces are
/// linearized, with backward Euler [1].
///
/// A swing of angular frequency ω, M a = −K (x + γ h v + h² a), keeps its amplitude for γ = 0. To first order
/// it loses the share ½ γ h ω² of it per second. γ = 1 is backward Euler, with which a pendulum of 64 points
/// loses a quarter of a 90° swing in a period. The step is stable for any stiffness and any γ ≥ 0, because
/// the matrix adds h² K to the mass.
///
/// The value was found by trial. The pendulum of `validate` passes up to 0.148. At 0.1, 0.15 and 0.2, curls
/// came to rest and thin rods kept their hair. A swing of 26 cm at 240 substeps a second loses 1.4 % of its
/// width in each period. Known limitation: in a wind of 5 m/s, strands of 256 points need 0.3 to come to
/// rest.
pub const SIDEWAYS: f32 = 0.143;

/// Minimum share γ with BDF2, which keeps its second order with the whole displacement [1].
pub const SIDEWAYS_BDF2: f32 = 1.0;

/// Lateral stiffness T/ℓ, in units of m/h², above which the whole predicted displacement counts [1]: γ is 1
/// for the excess.
///
/// Strands at rest have up to N g h²/ℓ of it at the root: 11 for 130 points over 26 cm at 240 substeps a
/// second. Higher values come from fast head motion or impacts.
const MAX_SWINGING_STIFFNESS: f32 = 12.0;

/// Lateral stiffness T/ℓ, in units of m/h², above which the whole predicted displacement counts for strands in
/// contact [1]. A contact force comes from the substep before, which amplifies
/// vibrations on the contact, and strands in contact do not swing freely. The value is a quarter of the
/// stiffness at which a chain without any damping is unstable, T/ℓ = m/h² (ω h = 2 of its highest mode).
const MAX_SWINGING_STIFFNESS_IN_CONTACT: f32 = 0.25;

/// How much of a segment's tension is linearized at the predicted displacement: γ T/ℓ, or the excess over a
/// bound.
#[derive(Clone, Copy)]
pub struct Sideways<S: Simd> {
    /// γ [1].
    share: F<S>,
    /// The bound, divided by the mass of the segment's farther point [1/s²].
    bound: F<S>,
}

impl<S: Simd> Sideways<S> {
    /// For strands in substeps of `h` [s]. `touches` selects those in contact, and `share` is the minimum γ.
    #[inline(always)]
    pub fn new(simd: S, share: f32, h: f32, touches: Mask<S>) -> Self {
        let bound = |units: f32| F::splat(simd, units / (h * h));
        Self {
            share: F::splat(simd, share),
            bound: touches.select(bound(MAX_SWINGING_STIFFNESS_IN_CONTACT), bound(MAX_SWINGING_STIFFNESS)),
        }
    }

    /// For a segment with lateral stiffness T/ℓ `stiffness` [N/m], whose farther point has the mass `mass`
    /// [kg].
    #[inline(always)]
    fn of(&self, stiffness: F<S>, mass: F<S>) -> F<S> {
        (stiffness * self.share).max(stiffness - mass * self.bound)
    }
}

/// Returns what `Sideways::of` returns, for single numbers: stiffness [N/m], mass [kg] and length of the substep [s].
#[cfg(test)]
pub fn sideways(share: f64, touches: bool, stiffness: f64, (mass, h): (f64, f64)) -> f64 {
    let units = if touches { MAX_SWINGING_STIFFNESS_IN_CONTACT } else { MAX_SWINGING_STIFFNESS };
    (stiffness * share).max(stiffness - mass * f64::from(units) / (h * h))
}

/// Returns the force of a segment on its nearer point at the starting point of the solve [N], and its
/// stiffness block [N/m]. The farther point receives the opposite force.
///
/// `longer` is the extension beyond the rest length that `tension` does not include yet [m]. `tension` is the
/// force that held the segment at its length in the last substep [N]. Carrying it over, as in an augmented
/// Lagrangian, keeps a strand at rest exactly at rest, whatever the stiffness of the spring. `drift` is the
/// predicted displacement of the farther end relative to the nearer one [m]. `mass` is that of the farther
/// point [kg].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn stretch<S: Simd>(
    (length, u): (F<S>, V3<S>),
    longer: F<S>,
    (k, tension, mass): (F<S>, F<S>, F<S>),
    drift: V3<S>,
    sideways: &Sideways<S>,
) -> (V3<S>, Sym3<S>) {
    let pull = k.mul_add(longer, tension);
    let across = (pull.max(tension) / length).max(0.0).min(k);
    // Based on the tension only. `pull` includes k times the length error that projection left, which is
    // noise, and its positive part would damp a swing.
    let turned = sideways.of((tension / length).max(0.0).min(k), mass);
    let force = u * (k - turned).mul_add(u.dot(drift), pull) + drift * turned;
    (force, Sym3::outer(u, k - across).add_identity(across))
}
