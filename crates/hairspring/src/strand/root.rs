//! The driven end of a strand: position, direction and frame of its root at any fraction of the interval.

use super::{
    interval::Substep,
    lanes::{F, Q4, Row, V3, load},
    tile::strand,
};
use fearless_simd::{mask32x8, prelude::*};
use glam::{Mat3, Vec3};

/// Root of eight strands at one time.
#[derive(Clone, Copy)]
pub struct Root<S: Simd> {
    /// World position [m].
    pub position: V3<S>,
    /// From the root to the second point [m].
    pub first: V3<S>,
    /// The frame's normal on the first segment, a unit vector across it.
    pub normal: V3<S>,
}

impl<S: Simd> Root<S> {
    /// The root at the end of `substep`.
    #[inline(always)]
    pub fn at(simd: S, rows: &[Row], substep: &Substep) -> Self {
        Self::between(simd, rows, substep.fraction, &substep.anchor)
    }

    /// The root at `fraction` of the interval, where the anchor is at `anchor`.
    #[inline(always)]
    pub fn between(simd: S, rows: &[Row], fraction: f32, anchor: &(Mat3, Vec3)) -> Self {
        let t = F::<S>::splat(simd, fraction);
        let start = V3::load(simd, &rows[strand::ROOT_START..]);
        let end = V3::load(simd, &rows[strand::ROOT_END..]);
        let turn =
            Q4::load(simd, &rows[strand::TURN_START..]).nlerp(Q4::load(simd, &rows[strand::TURN_END..]), t);
        let local = (end - start).mul_add(t, start);
        Self {
            position: transform(simd, &anchor.0, local) + V3::splat(simd, anchor.1),
            first: transform(simd, &anchor.0, turn.rotate(V3::load(simd, &rows[strand::FIRST..]))),
            normal: transform(simd, &anchor.0, turn.rotate(V3::load(simd, &rows[strand::NORMAL..]))),
        }
    }

    /// Damping, drag and friction of the strands.
    #[inline(always)]
    pub fn fibre(simd: S, rows: &[Row]) -> (F<S>, F<S>, F<S>) {
        (
            load(simd, &rows[strand::DRAG]),
            load(simd, &rows[strand::DAMPING]),
            load(simd, &rows[strand::FRICTION]),
        )
    }
}

/// A root's rotation from one time to another.
#[derive(Clone, Copy)]
pub struct RootTurn<S: Simd> {
    from: [V3<S>; 3],
    to: [V3<S>; 3],
    /// Roots that turned at all; the others' vectors keep their bits.
    turned: mask32x8<S>,
    /// Whether any did.
    any: bool,
}

impl<S: Simd> RootTurn<S> {
    #[inline(always)]
    pub fn between(from: &Root<S>, to: &Root<S>) -> Self {
        let change = (to.first - from.first).dot(to.first - from.first)
            + (to.normal - from.normal).dot(to.normal - from.normal);
        let turned = change.simd_gt(0.0);
        Self { from: from.axes(), to: to.axes(), turned, any: turned.any_true() }
    }

    /// `v` turned with the root.
    #[inline(always)]
    pub fn rotate(&self, v: V3<S>) -> V3<S> {
        if !self.any {
            return v;
        }
        let [a, b, c] = self.from;
        let [p, q, r] = self.to;
        V3::select(self.turned, p * v.dot(a) + q * v.dot(b) + r * v.dot(c), v)
    }
}

impl<S: Simd> Root<S> {
    /// Normal, binormal, tangent.
    #[inline(always)]
    fn axes(&self) -> [V3<S>; 3] {
        let tangent = self.first.length_and_unit().1;
        [self.normal, tangent.cross(self.normal), tangent]
    }
}

/// One matrix, the same for all lanes, times a vector of each.
#[inline(always)]
pub fn transform<S: Simd>(simd: S, m: &Mat3, v: V3<S>) -> V3<S> {
    V3::splat(simd, m.x_axis) * v.x + V3::splat(simd, m.y_axis) * v.y + V3::splat(simd, m.z_axis) * v.z
}
