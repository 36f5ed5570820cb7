//! Elastic models. Each adds its elements to the band in one downward sweep.
//!
//! | model | unknowns a point | half-bandwidth | |
//! | --- | --: | --: | --- |
//! | [`springs`] | 3 | 3 | stretch, bend, torsion and altitude springs (Selle et al. 2008) |
//! | [`straight`] | 3 | 2 | stretch and the curvature vector of strands that are straight at rest, which needs no frame |
//! | [`curvature`] | 3 | 2 | stretch and the curvature vector, in a frame carried from the root |
//! | [`rod`] | 4 | 2 | curvature in a frame that twists (discrete elastic rod) |
//!
//! All models share the stretch of segments (see `stretch`).

pub mod altitude;
pub mod bend;
pub mod curvature;
pub mod joint;
pub mod rod;
pub mod springs;
pub mod straight;
pub mod stretch;

pub use stretch::Stretching;

use super::{
    band::Band, bordered::BorderedConstraint, precomputed::Precomputed, profile::Profile, root::Root,
    scratch::Scratch, tile::Tile,
};
use crate::simd::lanes::{F, Simd, V3};

/// Input for the elements that begin at point `i`: segments i and i+1, adjacent to joint i+1.
#[derive(Clone, Copy)]
pub struct At<S: Simd> {
    /// The window's first point.
    pub i: usize,
    /// Index of the particle within its point of the strand: `i` modulo the model's stride.
    pub phase: usize,
    /// Segments i and i+1 [m].
    pub e: [V3<S>; 2],
    /// Unit vectors of the segments; zero for padding.
    pub u: [V3<S>; 2],
    /// Inverse rest lengths of the segments [1/m]; zero for padding.
    pub inverse_length: [F<S>; 2],
    /// 1 + τ/h: the factor by which damping with relaxation time τ stiffens bending in the matrix.
    pub damped: F<S>,
    /// The share of the current length errors that is added to the tensions; see `Linearization::length_error_share`.
    pub length_error_share: f32,
    /// Predicted changes of the segments from their points' velocities, up to the starting point of the solve
    /// [m].
    pub drift: [V3<S>; 2],
    /// The time that velocities act before that starting point [s].
    pub prediction_time: F<S>,
    /// Length of the substep [s].
    pub h: f32,
}

/// The solution at a point, on the way from tip to root.
pub struct Solved<S: Simd, const N: usize> {
    /// Index of the particle.
    pub i: usize,
    /// Index of the particle within its point of the strand.
    pub phase: usize,
    /// Edge from this particle to the next, and from the next to the one after, before the solve [m].
    pub edges: [V3<S>; 2],
    /// Displacements of the three particles [m].
    pub moved: [V3<S>; 3],
    /// The unknowns of this particle and those after it.
    pub unknowns: [F<S>; N],
    /// Stiffness of the spring along the strand's segment at this particle [N/m].
    pub along: F<S>,
    /// The share of the length errors before the solve that is added to the tensions; see
    /// `Linearization::length_error_share`.
    pub length_error_share: f32,
    /// The share of the force of a stretch spring that becomes tension; see [`stretch::CARRIED`].
    pub carried: F<S>,
}

impl<S: Simd, const N: usize> Solved<S, N> {
    /// Returns the tension that the solve adds to the spring to the particle `far` after this one, with rest
    /// length L and stiffness `k`: the carried share of k (C + e·(δ_far − δ) / L) [N]. C is the constraint function of fast
    /// projection, which needs no square root.
    #[inline(always)]
    pub fn taken(&self, far: usize, [length, inverse]: [F<S>; 2], k: F<S>) -> F<S> {
        let [edge, next] = self.edges;
        let u = (if far == 1 { edge } else { edge + next }) * inverse;
        // Clamped, because C grows quadratically where a root has jumped.
        let longer = length * u.dot(u).min(4.0).mul_add(0.5, F::splat(k.simd, -0.5));
        let longer = longer.mul_add(self.length_error_share, u.dot(self.moved[far] - self.moved[0]));
        k * self.carried * longer
    }
}

/// An elastic model: adds elements to the band, point by point, with `B` unknowns a point and a window of
/// `N`.
pub trait Model<S: Simd, const B: usize, const N: usize>: Sized {
    /// Particles for each point of the strand.
    const STRIDE: usize = 1;

    /// Minimum share of the predicted displacement that rotates the tension of a segment, with backward
    /// Euler; see [`stretch::SIDEWAYS`] [1].
    const SIDEWAYS: f32 = stretch::SIDEWAYS;

    /// Whether strands in contact that are coming to rest carry less tension; see [`stretch::CARRIED`].
    const DAMPS_AT_REST: bool = true;

    /// The coupling pattern of the matrix.
    const PROFILE: Profile<B, N> = Profile::within(N - 1);

    /// Driven particles at the root: those of its first segment.
    const DRIVEN: usize = Self::STRIDE + 1;

    /// Starts at the root of a strand.
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self;

    /// Adds all elements whose first particle is `at.i`, which is the band's first.
    fn add(&mut self, simd: S, at: &At<S>, scratch: &Scratch, tile: &mut Tile, band: &mut Band<S, B, N>);

    /// Returns whether a spring spans the four particles from `i` on. This test runs at every particle; the
    /// spring itself is handled by a separate function, because few particles have one.
    #[inline(always)]
    fn has_altitude_spring(_: S, _: usize, _: &Tile, _: &Scratch) -> bool {
        false
    }

    /// Returns that spring; its stiffness is 0 in models that have none. The pair holds the length of the
    /// substep and the time that velocities act before the starting point of the solve [s].
    #[inline(always)]
    fn altitude_spring(simd: S, _: (f32, f32), _: usize, _: &Tile, _: &Scratch) -> BorderedConstraint<S> {
        BorderedConstraint::none(simd)
    }

    /// Stores the model's own results of the solve, such as angles and tensions of its springs.
    fn take(simd: S, solved: &Solved<S, N>, tile: &mut Tile, fixed: &[Precomputed]);
}
