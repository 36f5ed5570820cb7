//! Coulomb friction on bodies, with a static coefficient for points that stick and a kinetic one for points
//! that slide.
//!
//! ```text
//!  |f| ▲
//!  μ N │╱‾╲                      f = μ N [κ + (1 − κ) / (1 + v²/v_s²)]    sticks up to μ N; starting takes more force
//! κμ N │    ‾‾‾───────
//!      └──────────────► v        v the speed along the surface, κ the kinetic over the static coefficient
//! ```
//!
//! The transition is that of Stribeck (1902, *Die wesentlichen Eigenschaften der Gleit- und Rollenlager*). It
//! replaces the exponential of Canudas de Wit et al. 1995, *A New Model for Control of Systems with
//! Friction*, by a fraction and keeps their v_s. A discontinuous change would release every point that
//! vibrates.

use super::tile::{Tile, multipliers, strand};
use crate::simd::lanes::{F, Simd, V3, load};

/// v_s of the formula: the speed at which friction is halfway from static to kinetic [m/s].
const TRANSITION_SPEED: f32 = 1e-3;

/// Friction coefficients of eight strands.
pub struct Friction<S: Simd> {
    /// Static coefficient μ [1].
    holds: F<S>,
    /// κ [1].
    kinetic: F<S>,
    /// Inverse of the slide in a substep at which friction is halfway from static to kinetic [1/m].
    halfway: f32,
}

impl<S: Simd> Friction<S> {
    /// Coefficients of the strands of a tile at particle `i`, in substeps of `h` [s].
    #[inline(always)]
    pub fn of(simd: S, h: f32, tile: &Tile, i: usize) -> Self {
        Self {
            holds: tile.at_particle(load(simd, &tile.strand[strand::FRICTION]), i, multipliers::FRICTION),
            kinetic: load(simd, &tile.strand[strand::FRICTION_KINETIC]),
            halfway: 1.0 / (h * TRANSITION_SPEED),
        }
    }

    /// Friction at `slide` in a substep [m], relative to static friction [1].
    #[inline(always)]
    fn over_static(&self, slide: F<S>) -> F<S> {
        let (x, one) = (slide * self.halfway, F::splat(slide.simd, 1.0));
        self.kinetic + (one - self.kinetic) / x.mul_add(x, one)
    }

    /// Largest friction force [N] for the normal force `normal` [N], at a slide of length `slid` in a substep [m].
    #[inline(always)]
    pub fn limit(&self, normal: F<S>, slid: F<S>) -> F<S> {
        self.holds * normal * self.over_static(slid)
    }

    /// Share of a slide of square `slide2` [m²] that friction prevents at a point that was pushed out by
    /// `depth` [m].
    #[inline(always)]
    pub fn share(&self, depth: F<S>, slide2: F<S>) -> F<S> {
        let slide = slide2.max(1e-30).sqrt();
        let holds = self.holds * depth;
        (holds / slide * self.over_static((slide - holds).max(0.0))).min(1.0)
    }
}

/// The spring along the surface between a collider and a point that sticks to it. It yields at the friction limit μN,
/// so that the place where it is relaxed follows a point that slides (Cundall & Strack 1979, *A Discrete Numerical
/// Model for Granular Assemblies*).
///
/// ```text
///   f = −k (z + s)      k = min(K, μN / |z + s⁻|)                   z  stretch at the start of the substep
///   z ← z + s⁻,         shortened to |z| ≤ μN / K                   s  slide in the substep, s⁻ in the one before
/// ```
///
/// The force is linear in the slide, which the solve finds. At the limit, k is a secant from the substep before (as
/// in Li et al. 2020, *Incremental Potential Contact*, §5).
pub struct FrictionSpring<S: Simd> {
    /// z, along the surface [m].
    pub stretch: V3<S>,
    /// k [N/m].
    pub stiffness: F<S>,
}

impl<S: Simd> FrictionSpring<S> {
    /// Shortens the stretch `z` [m] of a spring of stiffness `stiffest` [N/m] to the friction `limit` [N]. `slid` is
    /// the slide of the substep before [m].
    #[inline(always)]
    pub fn new((limit, stiffest): (F<S>, F<S>), z: V3<S>, slid: V3<S>) -> Self {
        let (size, _) = z.length_and_unit();
        let one = F::splat(limit.simd, 1.0);
        let stretch = z * (limit / (size * stiffest).max(1e-30)).min(one);
        let (ahead, _) = (stretch + slid).length_and_unit();
        Self { stretch, stiffness: (limit / ahead).min(stiffest) }
    }
}
