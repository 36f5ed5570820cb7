//! What holds a strand together: elastic models, each a sweep's worth of elements for the band.
//!
//! | model | unknowns a point | half-bandwidth | |
//! | --- | --: | --: | --- |
//! | [`springs`] | 3 | 3 | stretch, bend, torsion and altitude springs (Selle et al. 2008) |
//! | [`straight`] | 3 | 2 | stretch and the curvature vector of strands that are straight at rest, which needs no frame |
//! | [`curvature`] | 3 | 2 | stretch and the curvature vector, in a frame carried from the root |
//! | [`rod`] | 4 | 2 | curvature in a frame that twists (discrete elastic rod) |
//!
//! Stretch of the segments is the same in all (see `stretch`).

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

/// What is known where the elements that begin at point `i` are added: segments i and i+1 around joint i+1.
#[derive(Clone, Copy)]
pub struct At<S: Simd> {
    /// The window's first point.
    pub i: usize,
    /// Which it is of the points that a point of the strand stands for: `i` modulo the model's stride.
    pub phase: usize,
    /// Segments i and i+1 [m].
    pub e: [V3<S>; 2],
    /// Their unit vectors; zero for padding.
    pub u: [V3<S>; 2],
    /// Their inverse rest lengths [1/m]; zero for padding.
    pub inverse_length: [F<S>; 2],
    /// 1 + τ/h: how much stiffer bending is in the matrix, for its damping τ.
    pub damped: F<S>,
    /// How much of the present errors of length is news to the tensions, see `Linearization::news`.
    pub news: f32,
    /// By how much they change until where the solve begins, as their points' velocities say [m].
    pub drift: [V3<S>; 2],
    /// How long velocities act until there [s].
    pub drifting: F<S>,
    /// Length of the substep [s].
    pub h: f32,
}

/// What is known of a point once its solve is done, root-ward from the tip.
pub struct Solved<S: Simd, const N: usize> {
    /// The point.
    pub i: usize,
    /// Which it is of the points that a point of the strand stands for.
    pub phase: usize,
    /// From it to the next and from there to the one after, before the solve [m].
    pub edges: [V3<S>; 2],
    /// Displacements of the three [m].
    pub moved: [V3<S>; 3],
    /// The unknowns from this point on.
    pub unknowns: [F<S>; N],
    /// Stiffness of the spring along the strand's segment at it [N/m].
    pub along: F<S>,
    /// How much of the errors of length before the solve is news to the tensions, see `Linearization::news`.
    pub news: f32,
}

impl<S: Simd, const N: usize> Solved<S, N> {
    /// The tension that the spring to the point `far` after this one, of rest length L and stiffness `k`, took in the solve:
    /// k (C + e·(δ_far − δ) / L) [N], with C the measure of length that projection has, which needs no root.
    #[inline(always)]
    pub fn taken(&self, far: usize, [length, inverse]: [F<S>; 2], k: F<S>) -> F<S> {
        let [edge, next] = self.edges;
        let u = (if far == 1 { edge } else { edge + next }) * inverse;
        // Bounded, because C grows with the square where a root has jumped.
        let longer = length * u.dot(u).min(4.0).mul_add(0.5, F::splat(k.simd, -0.5));
        k * longer.mul_add(self.news, u.dot(self.moved[far] - self.moved[0]))
    }
}

/// An elastic model: what it adds to the band of `B` unknowns a point in a window of `N`, point after point.
pub trait Model<S: Simd, const B: usize, const N: usize>: Sized {
    /// Simulated points from one point of the strand to the next.
    const STRIDE: usize = 1;

    /// Least share of the drift that turns a tense segment's pull, with backward Euler, see [`stretch::SIDEWAYS`] [1].
    const SIDEWAYS: f32 = stretch::SIDEWAYS;

    /// Which unknowns meet in the matrix.
    const PROFILE: Profile<B, N> = Profile::within(N - 1);

    /// Points at the root that are driven: its first segment.
    const DRIVEN: usize = Self::STRIDE + 1;

    /// Starts at the root of a strand.
    fn begin(simd: S, tile: &Tile, root: &Root<S>) -> Self;

    /// Adds all elements whose first point is `at.i`, which is the band's first.
    fn add(&mut self, simd: S, at: &At<S>, scratch: &Scratch, tile: &mut Tile, band: &mut Band<S, B, N>);

    /// Whether a spring acts across the four points from `i` on. That is asked everywhere, and what it does is left to a function by itself: few points have one.
    #[inline(always)]
    fn acts_across(_: S, _: usize, _: &Tile, _: &Scratch) -> bool {
        false
    }

    /// That spring, in a substep of length h whose velocities act for so long until the solve begins, both in the pair [s]; of no stiffness in a model that knows
    /// none.
    #[inline(always)]
    fn across(simd: S, _: (f32, f32), _: usize, _: &Tile, _: &Scratch) -> BorderedConstraint<S> {
        BorderedConstraint::none(simd)
    }

    /// Takes what the solve found besides displacements.
    fn take(simd: S, solved: &Solved<S, N>, tile: &mut Tile, fixed: &[Precomputed]);
}
