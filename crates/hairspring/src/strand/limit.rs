//! The last word on a substep: no segment longer or shorter than ±1 %, no point inside a collider, and then the velocities.
//!
//! One sweep from root to tip. Each segment is clamped to its rest length ± [`LIMIT`] by moving the outer point (follow the
//! leader, Müller 2012, but only past the limit); a point inside a collider moves to the nearest free position with
//! the inward motion removed (Liu 2013) and is held back along the surface by Coulomb friction, up to μ times the push. In the
//! implicit integrators that is for what the solve could not know: points that land, and what projection pushed in (see `press`).

use super::{
    interval::Substep,
    lanes::{F, Row, V3, load, store},
    root::Root,
    tile::{Tile, history, rest, state},
    truss::beside,
};
use crate::collide::{contact, surface_displacement};
use fearless_simd::prelude::*;

/// What a substep leaves behind besides positions.
pub struct Finish<'a> {
    /// Length of the substep [s].
    pub h: f32,
    /// Largest relative change of a segment's length: [`LIMIT`], or infinite for integrators that are shown as they are.
    pub limit: f32,
    /// Force over mass that a push into the next solve is worth, over its length [1/s²]; 0 where contact is not in the solve.
    pub press: f32,
    /// Whether velocities are by BDF2 (see `assemble`).
    pub second_order: bool,
    /// What is added to the velocities, shape `[points]` [m/s].
    pub kick: Option<&'a [[Row; 3]]>,
}

/// Largest relative change of a segment's length that leaves a substep [1].
pub const LIMIT: f32 = 0.01;

/// Times that a point in contact swings out of the collider: what is left is of this order in the segment's length over the
/// collider's radius.
const CORRECTIONS: usize = 2;

/// Applies strain limit and contact to the new positions `x` of shape `[points]`, of which every `STRIDE`th is the strand's, and
/// writes state.
#[inline(always)]
pub fn limit<S: Simd, const STRIDE: usize>(
    simd: S,
    finish: &Finish,
    substep: &Substep,
    root: &Root<S>,
    moved: V3<S>,
    tile: &mut Tile,
    (x, inverse_mass): (&[[Row; 3]], &[Row]),
) {
    let inv_h = F::<S>::splat(simd, 1.0 / finish.h);
    let tolerance = finish.limit;
    let friction = Root::<S>::fibre(simd, tile.strand).2;
    // The root itself, and what it drives.
    for (at, driven) in tile.state.iter_mut().zip(x).take(STRIDE + 1) {
        V3::load(simd, driven).store(&mut at[state::X..state::X + 3]);
        (moved * inv_h).store(&mut at[state::V..state::V + 3]);
    }
    let mut before = V3::load(simd, &x[STRIDE]);
    for i in (2 * STRIDE..tile.rest.len()).step_by(STRIDE) {
        let length = load(simd, &tile.rest[i - STRIDE][rest::LENGTH]);
        let clearance = load(simd, &tile.rest[i][rest::CLEARANCE]);
        let old = V3::load(simd, &tile.state[i][state::X..]);
        let target = V3::load(simd, &x[i]);
        let mut press = load(simd, &tile.state[i][state::PRESS]);
        let mut p = clamp(target, before, length, tolerance);
        for pose in &substep.obstacles {
            let world = p + root.position;
            let (distance, normal) = contact(simd, pose, world);
            let depth = (clearance - distance).max(0.0);
            if depth.simd_gt(0.0).any_true() {
                // Out along the normal; then back along the surface, at most μ times as far.
                let pushed = p + normal * depth;
                let carried = surface_displacement(simd, pose, world);
                let slide = pushed - old + moved - carried;
                let tangent = slide - normal * normal.dot(slide);
                let hold = friction * depth / tangent.dot(tangent).max(1e-30).sqrt();
                let held = pushed - tangent * hold.min(1.0);
                // What of the push did not stop an approach presses on in the next solve (see `press`).
                let v = V3::load(simd, &tile.state[i][state::V..]);
                let approach = normal.dot(carried - v * F::splat(simd, finish.h)).max(0.0);
                let mass = load(simd, &tile.rest[i][rest::MASS]);
                press += mass * finish.press * (depth - approach).max(0.0);
                // The limit again, then out: both hold where they can, and where a strand is caught (behind an
                // ear) its length goes before its depth, so that it slips free in time.
                let mut q = clamp(held, before, length, tolerance);
                for _ in 0..CORRECTIONS {
                    let (distance, normal) = contact(simd, pose, q + root.position);
                    q = swing_out(q, before, normal, (clearance - distance).max(0.0));
                    q = clamp(q, before, length, tolerance);
                }
                p = V3::select(depth.simd_gt(0.0), q, p);
            }
        }
        let free = load(simd, &inverse_mass[i]).simd_gt(0.0);
        p = V3::select(free, p, target);
        store(free.select(press, F::splat(simd, 0.0)), &mut tile.state[i][state::PRESS]);
        if STRIDE == 2 {
            // An extra particle meets nothing and weighs next to nothing: it goes where its triangle puts it.
            let mut extra = V3::load(simd, &x[i - 1]);
            if tolerance.is_finite() {
                let free = load(simd, &inverse_mass[i - 1]).simd_gt(0.0);
                extra = V3::select(free, beside(simd, extra, [before, p], length), extra);
            }
            write(simd, finish, i - 1, extra, moved, tile);
        }
        write(simd, finish, i, p, moved, tile);
        before = p;
    }
}

/// Writes the new position `p` of point `i` and its velocity.
#[inline(always)]
fn write<S: Simd>(simd: S, finish: &Finish, i: usize, p: V3<S>, moved: V3<S>, tile: &mut Tile) {
    let inv_h = F::<S>::splat(simd, 1.0 / finish.h);
    let way = p - V3::load(simd, &tile.state[i][state::X..]) + moved;
    let mut v = way * inv_h;
    if let Some(kick) = finish.kick {
        v += V3::load(simd, &kick[i]);
    }
    if let Some(history) = tile.history.get_mut(i) {
        if finish.second_order {
            let before = V3::load(simd, &history[history::WAY..]);
            v += (way - before) * (inv_h * 0.5);
        }
        V3::load(simd, &tile.state[i][state::V..]).store(&mut history[history::V..]);
        way.store(&mut history[history::WAY..]);
    }
    let at = &mut tile.state[i];
    v.store(&mut at[state::V..state::V + 3]);
    p.store(&mut at[state::X..state::X + 3]);
}

/// `p` swung about `before` until it is `depth` farther out along `normal`: for a flat surface both its length and the surface hold
/// at once. (Out and back in turn hardly moves a tip that meets the surface head on.) Where `before` is deeper than the segment is
/// long, it points straight out.
#[inline(always)]
fn swing_out<S: Simd>(p: V3<S>, before: V3<S>, normal: V3<S>, depth: F<S>) -> V3<S> {
    let e = p - before;
    let (l, _) = e.length_and_unit();
    let along = e.dot(normal);
    let (_, side) = (e - normal * along).length_and_unit();
    let out = (along + depth).min(l);
    let aside = (l * l - out * out).max(0.0).sqrt();
    V3::select(depth.simd_gt(0.0), before + normal * out + side * aside, p)
}

/// `p` moved along the segment from `before` until its length is `length`, more or less by the fraction `limit`.
#[inline(always)]
fn clamp<S: Simd>(p: V3<S>, before: V3<S>, length: F<S>, limit: f32) -> V3<S> {
    let (l, u) = (p - before).length_and_unit();
    before + u * l.min(length * (1.0 + limit)).max(length * (1.0 - limit))
}
