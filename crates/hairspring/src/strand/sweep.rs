//! Bodies that are fast and thin: what one sweeps over in a substep is carried along, not passed.
//!
//! ```text
//!   for each of n parts of the substep, none in which the body moves farther than it is thin:
//!       P ← P + what the solve moves it by / n;   tip → root: who is ahead draws the one before along;
//!       root → tip: lengths, and the body where it is by then pushes points and segments out
//! ```
//!
//! A rod of 1 cm at 20 m/s moves 83 mm in a substep of 1/240 s: at its end nothing tells on which side of it a strand was. Pushes go from
//! the body along the strand in both directions, as in FABRIK (Aristidou & Lasenby 2011, §3), so that what is above a rod follows it as well as what
//! hangs from it. Positions only: [`super::limit()`] has the last word after it, and makes velocities of the way.
//!
//! Only strands that such a body may have met take part; of all others no bit changes.
//!
//! # Missing
//! Thin bodies still let some strands pass: of a curtain that is hit head on, a plate of 3 cm at 5 m/s a fourth, a rod of 1 cm at 20 m/s a third,
//! a ball of 8 cm at 20 m/s all that it meets in its middle (`tests/fast_bodies_take_hair_along.rs`). Distance fields, which count as thick. Friction within the substep. Which side a
//! strand was on is remembered where one body is fast, not where several are. Hair that is itself fast, against a thin body that is not.

use super::{
    assemble::Step,
    lanes::{F, Row, V3, load},
    limit::{LIMIT, Tether},
    press::scratch::{NORMAL, SPAN_NORMAL},
    scratch::Scratch,
    segment::clear_of_segment,
    tile::{Tile, rest, state},
};
use crate::collide::{ObstaclePose, contact_at, deepest, may_cut};
use fearless_simd::{mask32x8, prelude::*};

/// Times that pushes and lengths are reconciled once the body is where it ends: the sweep after this one has lengths right at the cost of depth.
const SETTLING: u32 = 4;

/// Changes `scratch.edges` of strands that a fast body met.
#[inline(always)]
pub fn sweep<S: Simd>(simd: S, stride: usize, step: &Step<S>, tile: &Tile, scratch: &mut Scratch) {
    let laps = step.obstacles.iter().map(ObstaclePose::laps).max().unwrap_or(1);
    if laps == 1 {
        return;
    }
    let met = met(simd, stride, step, tile, scratch);
    if !met.any_true() {
        return;
    }
    // Places from the root, where the substep found them.
    let mut x = V3::zero(simd);
    for (at, rows) in scratch.change.iter_mut().zip(&*tile.state) {
        x += V3::load(simd, &rows[state::EDGE..]);
        x.store(at);
    }
    for work in scratch.contacts.iter_mut() {
        work.fill(Row::default());
    }
    let share = F::splat(simd, 1.0 / laps as f32);
    for lap in 1..=laps + SETTLING {
        let fraction = (lap as f32 / laps as f32).min(1.0);
        let root = step.root.position - step.moved * F::splat(simd, 1.0 - fraction);
        let mut way = V3::zero(simd);
        for i in 1..if lap > laps { 0 } else { tile.rest.len() } {
            way += V3::load(simd, &scratch.edges[i]) - V3::load(simd, &tile.state[i][state::EDGE..]);
            (V3::load(simd, &scratch.change[i]) + way * share).store(&mut scratch.change[i]);
        }
        for i in (3 * stride..tile.rest.len()).step_by(stride).rev() {
            draw(simd, stride, tile, scratch, i);
        }
        for i in (2 * stride..tile.rest.len()).step_by(stride) {
            push(simd, stride, step, (fraction, root), tile, scratch, i);
        }
    }
    let mut before = V3::load(simd, &scratch.change[stride]);
    for i in (2 * stride..tile.rest.len()).step_by(stride) {
        let at = V3::load(simd, &scratch.change[i]);
        let mut edge = at - before;
        before = at;
        if stride == 2 {
            edge -= V3::load(simd, &scratch.edges[i - 1]);
        }
        V3::select(met, edge, V3::load(simd, &scratch.edges[i])).store(&mut scratch.edges[i]);
    }
}

/// Strands that a fast body may have met on the way that the solve has them go.
#[inline(always)]
fn met<S: Simd>(simd: S, stride: usize, step: &Step<S>, tile: &Tile, scratch: &Scratch) -> mask32x8<S> {
    let mut met = mask32x8::splat(simd, false);
    let (mut x, mut way) = (V3::zero(simd), step.moved);
    for i in 1..tile.rest.len() {
        let edge = V3::load(simd, &scratch.edges[i]);
        x += edge;
        way += edge - V3::load(simd, &tile.state[i][state::EDGE..]);
        if i >= 2 * stride && i.is_multiple_of(stride) {
            // A place of a segment is no farther from one of its ends than that; twice that at the tip's.
            let length = load(simd, &tile.rest[i - stride][rest::LENGTH]);
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            for pose in step.obstacles.iter().filter(|pose| pose.laps() > 1) {
                met |= free & pose.may_sweep(simd, (step.root.position + x, way), length);
            }
        }
    }
    met
}

/// Point `i` and the segment to it, at its length and out of bodies where those are by now; a segment moves both of its ends.
#[inline(always)]
fn push<S: Simd>(
    simd: S,
    stride: usize,
    step: &Step<S>,
    (fraction, root): (f32, V3<S>),
    tile: &Tile,
    scratch: &mut Scratch,
    i: usize,
) {
    let inner = i - stride;
    let zero = F::<S>::splat(simd, 0.0);
    let tether = Tether { length: load(simd, &tile.rest[inner][rest::LENGTH]), limit: LIMIT };
    let weight = |i: usize| load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
    let (free, inner_free) = (weight(i), weight(inner));
    let mut a = V3::load(simd, &scratch.change[inner]);
    let solved = V3::load(simd, &scratch.change[i]);
    let mut b = a + tether.clamp(solved - a);
    let (clearance, clear) = (load(simd, &tile.rest[i][rest::CLEARANCE]), clear_of_segment(simd, tile, i));
    let alone = step.obstacles.iter().filter(|pose| pose.laps() > 1).count() == 1;
    let work = &mut scratch.contacts[i];
    for pose in step.obstacles.iter().filter(|pose| pose.laps() > 1) {
        let at = &pose.pose_at(fraction);
        let side = Side { thickness: 2.0 * pose.shape.half_thickness(), alone };
        let met = contact_at(simd, pose, at, root + b);
        b += side.out(simd, met, clearance, &mut work[NORMAL..]);
        let e = b - a;
        let ends = [contact_at(simd, pose, at, root + a), contact_at(simd, pose, at, root + b)];
        let cuts = may_cut(pose, e, &ends, clear);
        let before = V3::load(simd, &work[SPAN_NORMAL..]);
        if (cuts | before.dot(before).simd_gt(0.0)).any_true() {
            let one = F::splat(simd, 1.0);
            let place = deepest(simd, pose, at, (root + a, e), &ends);
            let pushed = side.out(simd, (place.distance, place.normal), clear, &mut work[SPAN_NORMAL..]);
            let (outer, inner) = (place.at, inner_free.select(one - place.at, zero));
            let pushed = pushed * (one / outer.mul_add(outer, inner * inner).max(0.1));
            a += pushed * inner;
            b += pushed * outer;
        }
    }
    a.store(&mut scratch.change[inner]);
    V3::select(free, b, solved).store(&mut scratch.change[i]);
}

/// On which side of a body things are, from one part of the substep to the next: what touched it and is suddenly on its other side has been
/// pulled through, and goes back.
struct Side {
    /// Of the body where it is thinnest [m].
    thickness: f32,
    /// Whether there is one fast body only, and so one side to remember.
    alone: bool,
}

impl Side {
    /// How far a place goes that is to be at a distance of `clear`; `memory` holds the normal with which it touched the body in the part
    /// before, or 0.
    #[inline(always)]
    fn out<S: Simd>(
        &self,
        simd: S,
        (distance, normal): (F<S>, V3<S>),
        clear: F<S>,
        memory: &mut [Row],
    ) -> V3<S> {
        let before = V3::load(simd, memory);
        let through = before.dot(normal).simd_lt(0.0);
        let normal = V3::select(through, before, normal);
        let depth = through.select(distance + self.thickness, clear - distance).max(0.0);
        if self.alone {
            V3::select(depth.simd_gt(0.0), normal, V3::zero(simd)).store(memory);
        }
        normal * depth
    }
}

/// Draws the point before point `i` along where their segment is too long.
#[inline(always)]
fn draw<S: Simd>(simd: S, stride: usize, tile: &Tile, scratch: &mut Scratch, i: usize) {
    let inner = i - stride;
    let tether = Tether { length: load(simd, &tile.rest[inner][rest::LENGTH]), limit: LIMIT };
    let (a, b) = (V3::load(simd, &scratch.change[inner]), V3::load(simd, &scratch.change[i]));
    let free = load(simd, &scratch.fixed[inner].inverse_mass).simd_gt(0.0);
    V3::select(free, b - tether.clamp(b - a), a).store(&mut scratch.change[inner]);
}
