//! The driven end of a strand: position, direction and frame of its root at any fraction of the frame's time.

use super::{
    frame_context::Substep,
    tile::{RootRows, StrandRows, root, strand},
};
use crate::simd::lanes::{F, Q4, Simd, V3, load, transform};
use glam::{Mat3, Vec3};

/// Roots of eight strands at one time.
#[derive(Clone, Copy)]
pub struct Root<S: Simd> {
    /// World position [m].
    pub position: V3<S>,
    /// Vector from the root to the second point [m].
    pub first: V3<S>,
    /// The frame's normal on the first segment, a unit vector across it.
    pub normal: V3<S>,
}

impl<S: Simd> Root<S> {
    /// The root at the end of `substep`.
    #[inline(always)]
    pub fn at(simd: S, rows: (&RootRows, &StrandRows), substep: &Substep) -> Self {
        Self::between(simd, rows, substep.fraction, &substep.anchor)
    }

    /// The root at `fraction` of the frame's time, where `anchor` is the pose of the anchor.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    pub fn between(
        simd: S,
        (rows, strand_rows): (&RootRows, &StrandRows),
        fraction: f32,
        anchor: &(Mat3, Vec3),
    ) -> Self {
        let t = F::<S>::splat(simd, fraction);
        let start = V3::load(simd, &rows[root::START..]);
        let end = V3::load(simd, &rows[root::END..]);
        let turn =
            Q4::load(simd, &rows[root::TURN_START..]).nlerp(Q4::load(simd, &rows[root::TURN_END..]), t);
        let local = (end - start).mul_add(t, start);
        Self {
            position: transform(simd, &anchor.0, local) + V3::splat(simd, anchor.1),
            first: transform(simd, &anchor.0, turn.rotate(V3::load(simd, &strand_rows[strand::FIRST..]))),
            normal: transform(simd, &anchor.0, turn.rotate(V3::load(simd, &strand_rows[strand::NORMAL..]))),
        }
    }

    /// Vector from the root to the third point [m], at the end of `substep`.
    #[inline(always)]
    pub fn third(simd: S, (rows, strand_rows): (&RootRows, &StrandRows), substep: &Substep) -> V3<S> {
        let t = F::<S>::splat(simd, substep.fraction);
        let turn =
            Q4::load(simd, &rows[root::TURN_START..]).nlerp(Q4::load(simd, &rows[root::TURN_END..]), t);
        transform(simd, &substep.anchor.0, turn.rotate(V3::load(simd, &strand_rows[strand::THIRD..])))
    }

    /// Drag and damping coefficients of the strands.
    #[inline(always)]
    pub fn fiber(simd: S, rows: &StrandRows) -> (F<S>, F<S>) {
        (load(simd, &rows[strand::DRAG]), load(simd, &rows[strand::DAMPING]))
    }
}
