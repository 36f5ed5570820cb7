//! Relaxed corrections: in the short substeps that a thin or fast collider requires, only a share of a correction by
//! contact becomes velocity.
//!
//! A correction moves a point out of a collider by the whole depth d within the substep h, and the velocity is the
//! displacement over h. The depth does not get smaller with h where a collider thinner than the segments is long passes
//! along them, or where a strain of 1 % is corrected. d/h is 60 m/s then: hair was thrown off thin rods.
//!
//! ```text
//!                    d/h                          d/h₀ = ρ d/h         h₀ the substep without refinement,
//!        ●──────────────────────────▶            ●───▶                ρ = h/h₀ the relaxation
//!      ━━━ rod
//! ```
//!
//! The position is corrected in full. The velocity counts the correction as if the substep had been h₀ long, in addition
//! to the speed that the point had or that the collider has there. Without refinement, ρ = 1 changes nothing. The share
//! has no unit, so that contact behaves alike at every scale. Related: the soft contacts of Box2D v3 and the maximum
//! depenetration velocity of rigid-body engines, whose limit is an absolute speed.

use super::{
    assemble::SubstepContext,
    colliders::{contact, surface_displacement},
    post_solve::{Particle, SegmentLimit},
    tether::apply_lra,
    tile::{Tile, rest, state},
};
use crate::simd::lanes::{F, Mask, Simd, V3, load};

/// A correction of the point at the outer end of a segment.
pub struct Correction<S: Simd> {
    /// The segment as the solve left it [m].
    pub raw: V3<S>,
    /// From the corrected previous point to where the solve left the point [m].
    pub solved: V3<S>,
    /// The corrected segment [m].
    pub corrected: V3<S>,
    /// Where the correction of the previous point was relaxed. This point follows it.
    pub follows: Mask<S>,
}

/// The relaxed correction.
pub struct Relaxed<S: Simd> {
    /// Where contact moved the point, or the previous one.
    pub relaxed: Mask<S>,
    /// The segment [m]. It keeps the length of the solve, because the next solve corrects a strain within one substep.
    pub edge: V3<S>,
    /// Factor for the velocity of the point [1].
    pub speed: F<S>,
}

/// Relaxes the correction of point `i`, the outer end of the segment from the particle `at`, by the factor ρ
/// `relaxation`.
#[inline(never)]
pub fn relax<S: Simd>(
    simd: S,
    (step, relaxation): (&SubstepContext<S>, f32),
    tile: &Tile,
    (i, stride): (usize, usize),
    correction: &Correction<S>,
    (at, link): (&Particle<S>, &SegmentLimit<S>),
) -> Relaxed<S> {
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || {
            let &Correction { raw, solved, corrected, follows } = correction;
            let size = |v: V3<S>| v.dot(v).sqrt();
            let mut old = V3::load(simd, &tile.state[i][state::EDGE..]);
            if stride == 2 {
                old += V3::load(simd, &tile.state[i - 1][state::EDGE..]);
            }
            // What the limits of length would have done without a collider is no correction by contact.
            let moved = corrected - link.clamp(apply_lra(simd, tile, i, (at, link), solved));
            let relaxed = follows | moved.is_not_zero();
            let (length, along) = corrected.length_and_unit();
            let of_solve = link.within(size(raw));
            let length = length.max(of_solve.min(link.length)).min(of_solve.max(link.length));
            let mut edge = V3::select(relaxed, along * length, corrected);
            let world = |edge: V3<S>| step.root.position + (at.x + edge);
            let clearance = load(simd, &tile.rest[i][rest::CLEARANCE]);
            let mut most = size(at.displacement + (solved - old));
            for pose in step.colliders {
                let (distance, normal) = contact(simd, pose, world(edge));
                let near = distance.simd_lt(link.length);
                let carried = size(surface_displacement(simd, pose, world(edge)));
                most = near.select(most.max(carried), most);
                // With that length, the point may be deeper in the collider than the correction left it. Out of a rod or a
                // box thinner than the segment is long, the nearest way may be through it.
                let mut inside = distance.simd_lt(clearance - link.slack()) & relaxed;
                if let Some(edges) = &pose.edges {
                    inside &= link.length.simd_lt(2.0 * edges.half_thickness());
                }
                if inside.any_true() {
                    let allowed = clearance.min(contact(simd, pose, world(corrected)).0);
                    let depth = inside.select((allowed - distance).max(0.0), F::splat(simd, 0.0));
                    edge = link.swing_out(edge, normal, depth);
                }
            }
            let now = size(at.displacement + (edge - old)).max(f32::MIN_POSITIVE);
            let speed = (size(moved).mul_add(relaxation, most) / now).min(1.0);
            Relaxed { relaxed, edge, speed }
        },
    )
}
