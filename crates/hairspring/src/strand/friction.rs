//! Coulomb friction on bodies: a static coefficient for what holds, a kinetic one for what slides.
//!
//! ```text
//!  |f| ▲
//!  μ N │╱‾╲                      f = μ N [κ + (1 − κ) / (1 + v²/v_s²)]        holds at up to μ N, and to start takes more than to go on
//! κμ N │    ‾‾‾───────
//!      └──────────────► v        v the speed along the surface, κ the kinetic over the static coefficient
//! ```
//!
//! The way from one to the other is Stribeck's (1902, *Die wesentlichen Eigenschaften der Gleit- und Rollenlager*), with a fraction in place of the exponential
//! of Canudas de Wit et al. 1995, *A New Model for Control of Systems with Friction*, and their v_s. A step at the speed that [`super::contact`] tells from
//! rest, 5 µm/s, would let go whatever trembles.

use super::tile::{StrandRows, strand};
use crate::simd::lanes::{F, Simd, load};

/// v_s of the formula: the speed at which friction is halfway from static to kinetic [m/s].
const SLIDES: f32 = 1e-3;

/// Of eight strands.
pub struct Friction<S: Simd> {
    /// μ, of what holds [1].
    holds: F<S>,
    /// κ [1].
    kinetic: F<S>,
    /// Slide in a substep that is halfway from static to kinetic, inverse [1/m].
    halfway: f32,
}

impl<S: Simd> Friction<S> {
    /// Of the strands of a tile, in substeps of `h` [s].
    #[inline(always)]
    pub fn of(simd: S, h: f32, rows: &StrandRows) -> Self {
        Self {
            holds: load(simd, &rows[strand::FRICTION]),
            kinetic: load(simd, &rows[strand::FRICTION_KINETIC]),
            halfway: 1.0 / (h * SLIDES),
        }
    }

    /// Friction of what slides by `slide` in a substep [m], over that of what holds [1].
    #[inline(always)]
    fn over_static(&self, slide: F<S>) -> F<S> {
        let (x, one) = (slide * self.halfway, F::splat(slide.simd, 1.0));
        self.kinetic + (one - self.kinetic) / x.mul_add(x, one)
    }

    /// The force over the slide, where `normal` presses [N] and the point `slid` by so much in the substep before [m], more than 0; at most `stiffest` [N/m].
    #[inline(always)]
    pub fn secant(&self, normal: F<S>, slid: F<S>, stiffest: F<S>) -> F<S> {
        (self.holds * normal / slid * self.over_static(slid)).min(stiffest)
    }

    /// The share of a slide of square `slide2` [m²] that does not happen to a point which was pushed out by `depth` [m].
    #[inline(always)]
    pub fn share(&self, depth: F<S>, slide2: F<S>) -> F<S> {
        let slide = slide2.max(1e-30).sqrt();
        let holds = self.holds * depth;
        (holds / slide * self.over_static((slide - holds).max(0.0))).min(1.0)
    }
}
