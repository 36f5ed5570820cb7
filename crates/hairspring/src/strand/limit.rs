//! The last word on a substep: no segment longer or shorter than ±1 %, no point inside a collider, and then the velocities.
//!
//! One sweep from root to tip. Each segment is clamped to its rest length ± [`LIMIT`] by moving the outer point (follow the
//! leader, Müller 2012, but only past the limit); a point inside a collider moves to the nearest free position with
//! the inward motion removed (Liu 2013) and is held back along the surface by Coulomb friction, up to μ times the push. In the
//! implicit integrators that is for what the solve could not know: points that land, and what projection pushed in (see `press`).

use super::{
    assemble::Step,
    lanes::{F, Row, V3, load, store},
    root::Root,
    scratch::Scratch,
    tile::{Tile, history, rest, state},
    truss::beside,
};
use crate::collide::{contact, surface_displacement};
use fearless_simd::{mask32x8, prelude::*};

/// What a substep leaves behind besides positions.
pub struct Finish {
    /// Largest relative change of a segment's length: [`LIMIT`], or infinite for integrators that are shown as they are.
    pub limit: f32,
    /// Force over mass that a push into the next solve is worth, over its length [1/s²]; 0 where contact is not in the solve.
    pub press: f32,
    /// Whether `scratch.kick` is added to the velocities.
    pub kicks: bool,
}

/// Largest relative change of a segment's length that leaves a substep [1].
pub const LIMIT: f32 = 0.01;

/// Times that a point in contact swings out of the collider: what is left is of this order in the segment's length over the
/// collider's radius.
const CORRECTIONS: usize = 2;

/// Applies strain limit and contact to the new positions `scratch.x`, of which every `stride`th is the strand's, and writes state.
#[inline(always)]
pub fn limit<S: Simd>(
    simd: S,
    stride: usize,
    finish: &Finish,
    step: &Step<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let inv_h = F::<S>::splat(simd, 1.0 / step.h);
    // The root itself, and what it drives.
    for (at, driven) in tile.state.iter_mut().zip(&scratch.x).take(stride + 1) {
        V3::load(simd, driven).store(&mut at[state::X..]);
        (step.moved * inv_h).store(&mut at[state::V..]);
    }
    let mut before = V3::load(simd, &scratch.x[stride]);
    for i in (2 * stride..tile.rest.len()).step_by(stride) {
        let length = load(simd, &tile.rest[i - stride][rest::LENGTH]);
        let tether = Tether { before, length, limit: finish.limit };
        let mut p = V3::load(simd, &scratch.x[i]);
        // A branch, so that a segment waits for the one before it only where something is to be done.
        let world = p + step.root.position;
        let near = step.obstacles.iter().any(|pose| pose.near(simd, world).any_true());
        if near || tether.wrong(p).any_true() {
            p = place(simd, finish, step, tile, (i, p), &tether);
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            p = V3::select(free, p, V3::load(simd, &scratch.x[i]));
            p.store(&mut scratch.x[i]);
            let press = &mut tile.state[i][state::PRESS];
            store(free.select(load(simd, press), F::splat(simd, 0.0)), press);
        }
        if stride == 2 {
            // An extra particle meets nothing and weighs next to nothing: it goes where its triangle puts it.
            let mut extra = V3::load(simd, &scratch.x[i - 1]);
            if finish.limit.is_finite() {
                let free = load(simd, &scratch.fixed[i - 1].inverse_mass).simd_gt(0.0);
                extra = V3::select(free, beside(simd, extra, [before, p], length), extra);
                extra.store(&mut scratch.x[i - 1]);
            }
            write(simd, finish, step, (i - 1, extra), tile, &scratch.kick);
        }
        write(simd, finish, step, (i, p), tile, &scratch.kick);
        before = p;
    }
}

/// Where point `i` at `p` may be: within the limits of its segment, outside of every collider.
#[inline(always)]
fn place<S: Simd>(
    simd: S,
    finish: &Finish,
    step: &Step<S>,
    tile: &mut Tile,
    (i, p): (usize, V3<S>),
    tether: &Tether<S>,
) -> V3<S> {
    let friction = Root::<S>::fibre(simd, tile.strand).2;
    let clearance = load(simd, &tile.rest[i][rest::CLEARANCE]);
    let old = V3::load(simd, &tile.state[i][state::X..]);
    let mut press = load(simd, &tile.state[i][state::PRESS]);
    let mut p = tether.clamp(p);
    for pose in step.obstacles {
        let world = p + step.root.position;
        let (distance, normal) = contact(simd, pose, world);
        let depth = (clearance - distance).max(0.0);
        if depth.simd_gt(0.0).any_true() {
            // Out along the normal; then back along the surface, at most μ times as far.
            let pushed = p + normal * depth;
            let carried = surface_displacement(simd, pose, world);
            let slide = pushed - old + step.moved - carried;
            let tangent = slide - normal * normal.dot(slide);
            let hold = friction * depth / tangent.dot(tangent).max(1e-30).sqrt();
            let held = pushed - tangent * hold.min(1.0);
            // What of the push did not stop an approach presses on in the next solve (see `press`).
            let v = V3::load(simd, &tile.state[i][state::V..]);
            let approach = normal.dot(carried - v * F::splat(simd, step.h)).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            press += mass * finish.press * (depth - approach).max(0.0);
            // The limit again, then out: both hold where they can, and where a strand is caught (behind an
            // ear) its length goes before its depth, so that it slips free in time.
            let mut q = tether.clamp(held);
            for _ in 0..CORRECTIONS {
                let (distance, normal) = contact(simd, pose, q + step.root.position);
                q = tether.clamp(tether.swing_out(q, normal, (clearance - distance).max(0.0)));
            }
            p = V3::select(depth.simd_gt(0.0), q, p);
        }
    }
    store(press, &mut tile.state[i][state::PRESS]);
    p
}

/// Writes the new position `p` of point `i` and its velocity.
#[inline(always)]
fn write<S: Simd>(
    simd: S,
    finish: &Finish,
    step: &Step<S>,
    (i, p): (usize, V3<S>),
    tile: &mut Tile,
    kick: &[[Row; 3]],
) {
    let inv_h = F::<S>::splat(simd, 1.0 / step.h);
    let way = p - V3::load(simd, &tile.state[i][state::X..]) + step.moved;
    let mut v = way * inv_h;
    if finish.kicks {
        v += V3::load(simd, &kick[i]);
    }
    if let Some(history) = tile.history.get_mut(i) {
        if step.second_order {
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

/// What holds a point to the one before it.
struct Tether<S: Simd> {
    /// The point before.
    before: V3<S>,
    /// Rest length of the segment [m].
    length: F<S>,
    /// Largest relative change of it.
    limit: f32,
}

impl<S: Simd> Tether<S> {
    /// Where the segment to `p` is too long or too short.
    #[inline(always)]
    fn wrong(&self, p: V3<S>) -> mask32x8<S> {
        let e = p - self.before;
        let (size, length) = (e.dot(e), self.length * self.length);
        let (shortest, longest) = ((1.0 - self.limit).max(0.0), 1.0 + self.limit);
        size.simd_gt(length * (longest * longest)) | size.simd_lt(length * (shortest * shortest))
    }

    /// `p` moved along the segment until its length is within the limit.
    #[inline(always)]
    fn clamp(&self, p: V3<S>) -> V3<S> {
        let (l, u) = (p - self.before).length_and_unit();
        let l = l.min(self.length * (1.0 + self.limit)).max(self.length * (1.0 - self.limit));
        V3::select(self.wrong(p), self.before + u * l, p)
    }

    /// `p` swung about the point before until it is `depth` farther out along `normal`: for a flat surface both its length and the surface
    /// hold at once. (Out and back in turn hardly moves a tip that meets the surface head on.) Where the point before is deeper than the
    /// segment is long, it points straight out.
    #[inline(always)]
    fn swing_out(&self, p: V3<S>, normal: V3<S>, depth: F<S>) -> V3<S> {
        let e = p - self.before;
        let (l, _) = e.length_and_unit();
        let along = e.dot(normal);
        let (_, side) = (e - normal * along).length_and_unit();
        let out = (along + depth).min(l);
        let aside = (l * l - out * out).max(0.0).sqrt();
        V3::select(depth.simd_gt(0.0), self.before + normal * out + side * aside, p)
    }
}
