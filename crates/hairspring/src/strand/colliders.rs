//! Collider queries of the solver. They run in single precision whatever the precision of the solve, because
//! the shapes are not known more precisely.

use crate::collide::{self, ColliderPose, DeepestPoint};
use crate::simd::lanes::{F, Mask, Simd, V3};

/// Returns which points, at world position `p` [m], may be inside the collider at the end of the substep.
#[inline(always)]
pub fn broadphase_test<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> Mask<S> {
    Mask::from_single(simd, pose.broadphase_test(simd.single(), p.single()))
}

/// See [`ColliderPose::segment_may_intersect`].
#[inline(always)]
pub fn segment_may_intersect<S: Simd>(
    simd: S,
    pose: &ColliderPose,
    (p, e): (V3<S>, V3<S>),
    tolerance: F<S>,
) -> Mask<S> {
    Mask::from_single(
        simd,
        pose.segment_may_intersect(simd.single(), (p.single(), e.single()), tolerance.single()),
    )
}

/// See [`ColliderPose::segment_may_penetrate`].
#[inline(always)]
pub fn segment_may_penetrate<S: Simd>(
    simd: S,
    pose: &ColliderPose,
    (p, e): (V3<S>, V3<S>),
    tolerance: F<S>,
) -> Mask<S> {
    Mask::from_single(
        simd,
        pose.segment_may_penetrate(simd.single(), (p.single(), e.single()), tolerance.single()),
    )
}

/// See [`collide::contact`].
#[inline(always)]
pub fn contact<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> (F<S>, V3<S>) {
    let (distance, normal) = collide::contact(simd.single(), pose, p.single());
    (F::from_single(simd, distance), V3::from_single(simd, normal))
}

/// See [`collide::surface_displacement`].
#[inline(always)]
pub fn surface_displacement<S: Simd>(simd: S, pose: &ColliderPose, p: V3<S>) -> V3<S> {
    V3::from_single(simd, collide::surface_displacement(simd.single(), pose, p.single()))
}

/// See [`collide::find_deepest_point`].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn find_deepest_point<S: Simd>(
    simd: S,
    pose: &ColliderPose,
    (a, e): (V3<S>, V3<S>),
    (from, within): (F<S>, F<S>),
) -> Option<DeepestPoint<S>> {
    let found = collide::find_deepest_point(
        simd.single(),
        pose,
        (a.single(), e.single()),
        (from.single(), within.single()),
    )?;
    let DeepestPoint { found, distance, normal, gain, at } = found;
    let [distance, gain, at] = [distance, gain, at].map(|v| F::from_single(simd, v));
    let (found, normal) = (Mask::from_single(simd, found), V3::from_single(simd, normal));
    Some(DeepestPoint { found, distance, normal, gain, at })
}
