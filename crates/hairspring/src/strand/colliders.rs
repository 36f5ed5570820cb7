//! Queries of colliders from the solve: in single precision, whatever the precision of the solve. A shape is known no better.

use super::lanes::{F, Mask, Simd, V3};
use crate::collide::{self, Deepest, ObstaclePose};

/// Which points, at `p` [m] in the world, may be inside the collider at the end of the substep.
#[inline(always)]
pub fn near<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> Mask<S> {
    Mask::from_single(simd, pose.near(simd.single(), p.single()))
}

/// See [`ObstaclePose::may_cut`].
#[inline(always)]
pub fn may_cut<S: Simd>(simd: S, pose: &ObstaclePose, (p, e): (V3<S>, V3<S>), sag: F<S>) -> Mask<S> {
    Mask::from_single(simd, pose.may_cut(simd.single(), (p.single(), e.single()), sag.single()))
}

/// See [`ObstaclePose::may_lie_deep`].
#[inline(always)]
pub fn may_lie_deep<S: Simd>(simd: S, pose: &ObstaclePose, (p, e): (V3<S>, V3<S>), sag: F<S>) -> Mask<S> {
    Mask::from_single(simd, pose.may_lie_deep(simd.single(), (p.single(), e.single()), sag.single()))
}

/// See [`collide::contact`].
#[inline(always)]
pub fn contact<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> (F<S>, V3<S>) {
    let (distance, normal) = collide::contact(simd.single(), pose, p.single());
    (F::from_single(simd, distance), V3::from_single(simd, normal))
}

/// See [`collide::surface_displacement`].
#[inline(always)]
pub fn surface_displacement<S: Simd>(simd: S, pose: &ObstaclePose, p: V3<S>) -> V3<S> {
    V3::from_single(simd, collide::surface_displacement(simd.single(), pose, p.single()))
}

/// See [`collide::deepest`].
#[inline(always)]
pub fn deepest<S: Simd>(
    simd: S,
    pose: &ObstaclePose,
    (a, e): (V3<S>, V3<S>),
    (from, within): (F<S>, F<S>),
) -> Option<Deepest<S>> {
    let found =
        collide::deepest(simd.single(), pose, (a.single(), e.single()), (from.single(), within.single()))?;
    let Deepest { found, distance, normal, gain, at } = found;
    let [distance, gain, at] = [distance, gain, at].map(|v| F::from_single(simd, v));
    let (found, normal) = (Mask::from_single(simd, found), V3::from_single(simd, normal));
    Some(Deepest { found, distance, normal, gain, at })
}
