//! Contact inside the solve: a segment that a collider holds out is pressed there, and rubs, while the strand moves as a whole.
//!
//! ```text
//!   N ← max(0, N − k (g + n·δ))       g the gap [m], n the normal, k = STRETCH m/h²
//!   δ = (1 − s) δ_a + s δ_b           what the solve moves the place s of the segment by, the one that is deepest: mostly its outer end b
//! ```
//!
//! Both ends share what presses between them: the matrix gets k n nᵀ times the squares of the shares on the diagonal and their product between the
//! two, where stretch is as well.
//!
//! The normal force N is carried from substep to substep like a segment's tension (an augmented Lagrangian, Alart & Curnier 1991, *A
//! Mixed Formulation for Frictional Contact Problems*), so that tension, weight and N are in balance in one solve. Were contact
//! only what [`super::limit`] makes of it, a taut strand over a cylinder would sink in and be pushed out again in every
//! substep, from root to tip: half a millimetre along the surface each time, which ran it off toward its root.
//!
//! Friction is −μN s/|s| of the slide s along the surface, with |s| of the substep before (the lagged secant of Li et al. 2020,
//! *Incremental Potential Contact*, §5, for one step): what slides slower from substep to substep comes to a stop, what is
//! pulled harder than μN gathers speed. The secant is no stiffer than k: a strand at rest creeps by up to μN/k a substep (μ times
//! 0.1 mm/s under its own weight, at four substeps), which is as little as positions in f32 can tell.
//!
//! Only segments with N > 0 take part, each with one N. It begins in `limit` and `segment`, with the push that was needed there.

use super::{
    assemble::{Step, Sweep},
    band::Band,
    lanes::{F, Row, Sym3, V3, load, store},
    model::stretch::STRETCH,
    root::Root,
    scratch::Scratch,
    segment::clearance,
    tile::{Tile, rest, state},
};
use crate::collide::{contact, deepest, surface_displacement};
use fearless_simd::prelude::*;

/// Rows of scratch a point, written where any of the eight is in contact.
pub mod scratch {
    /// Outward normal, 3 rows.
    pub const NORMAL: usize = 0;
    /// Gap before the solve, negative inside [m].
    pub const GAP: usize = 3;
    /// Where on the segment to the point: 0 at its beginning, 1 at the point.
    pub const AT: usize = 4;
    /// Rows a point.
    pub const ROWS: usize = 5;
}

/// Adds contact to the segment from point `i`, the second of the band's window, to the strand's next, which is in it too. Point `i` is at `x` from the
/// root, drifts by `drift` and is by then `way` from where the substep began.
#[inline(always)]
pub fn press<S: Simd, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Sweep, &Step<S>),
    tile: &mut Tile,
    (i, x, drift, way): (usize, V3<S>, V3<S>, V3<S>),
    band: &mut Band<S, B, N>,
    memory: &mut Scratch,
) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let stride = tile.model.stride();
    let outer = i + stride;
    let force = load(simd, &tile.state[outer][state::PRESS]);
    if !force.simd_gt(0.0).any_true() {
        return;
    }
    // From this point to the next, now and where the substep began.
    let mut e = V3::load(simd, &memory.edges[outer]);
    let mut old = V3::load(simd, &tile.state[outer][state::EDGE..]);
    if stride == 2 {
        e += V3::load(simd, &memory.edges[i + 1]);
        old += V3::load(simd, &tile.state[i + 1][state::EDGE..]);
    }
    let inner = step.root.position + x;
    let world = step.root.position + (x + e);
    let clear = clearance(simd, tile, outer);
    // What has gone farther than N could close the gap in a substep is let go.
    let m_h2 = load(simd, &tile.rest[outer][rest::MASS]) * (1.0 / (step.h * step.h));
    let reach = force / m_h2;
    // The place that is nearest to a surface, and how far that moves there.
    let (mut gap, mut normal, mut carried) = (F::splat(simd, f32::MAX), V3::zero(simd), V3::zero(simd));
    let mut at = one;
    for pose in step.obstacles {
        let (distance, n) = contact(simd, pose, world);
        let mut place = (distance - load(simd, &tile.rest[outer][rest::CLEARANCE]), n, one);
        // Only what is nearer than the end counts.
        if let Some(between) = deepest(simd, pose, (inner, e), clear + reach.min(place.0)) {
            let gap = between.distance - clear;
            let deeper = between.found & gap.simd_lt(place.0);
            place.0 = deeper.select(gap, place.0);
            place.1 = V3::select(deeper, between.normal, n);
            place.2 = deeper.select(between.at, one);
        }
        let nearest = place.0.simd_lt(gap);
        gap = nearest.select(place.0, gap);
        normal = V3::select(nearest, place.1, normal);
        at = nearest.select(place.2, at);
        let there = surface_displacement(simd, pose, e.mul_add(place.2 - one, world));
        carried = V3::select(nearest, there, carried);
    }

    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    gap = shut.select(gap, zero);
    normal = V3::select(shut, normal, V3::zero(simd));
    store(force, &mut tile.state[outer][state::PRESS]);
    let work = &mut memory.contacts[outer];
    normal.store(&mut work[scratch::NORMAL..]);
    store(gap, &mut work[scratch::GAP]);
    store(at, &mut work[scratch::AT]);

    // What the outer end does besides what the inner one does.
    let v = V3::load(simd, &tile.state[i][state::V..]);
    let faster = V3::load(simd, &tile.state[outer][state::V..]) - v;
    let h = F::splat(simd, step.h);
    let drifts = faster * h;
    let (drift_more, way_more) =
        if sweep == Sweep::First { (drifts, drifts) } else { (V3::zero(simd), e - old) };
    let (drift, way) = (drift_more.mul_add(at, drift), way_more.mul_add(at, way));
    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = faster.mul_add(at, v) * h;
    let (slid, _) = along(before - carried).length_and_unit();
    let rub = (Root::<S>::fibre(simd, tile.strand).2 * force / slid).min(k);
    let block = Sym3::outer(normal, k - rub).add_identity(rub);
    let push = normal * (force - k * (gap + normal.dot(drift))) - along(way + step.moved - carried) * rub;
    band.add_diagonal(1 + stride, block * (at * at));
    band.add_force(1 + stride, push * at);
    let share = one - at;
    if share.simd_gt(0.0).any_true() {
        band.add_diagonal(1, block * (share * share));
        band.add_block(1, 1 + stride, &(block * (share * at)).full());
        band.add_force(1, push * share);
    }
}

/// The force that presses the segment from point `i` once the solve has moved its ends by `moved`.
#[inline(always)]
pub fn relieve<S: Simd>(
    simd: S,
    step: &Step<S>,
    tile: &mut Tile,
    (i, moved): (usize, [V3<S>; 2]),
    contacts: &[[Row; scratch::ROWS]],
) {
    let outer = i + tile.model.stride();
    let force = load(simd, &tile.state[outer][state::PRESS]);
    let shut = force.simd_gt(0.0);
    if !shut.any_true() {
        return;
    }
    let work = &contacts[outer];
    let delta = (moved[1] - moved[0]).mul_add(load(simd, &work[scratch::AT]), moved[0]);
    let k = load(simd, &tile.rest[outer][rest::MASS]) * (STRETCH / (step.h * step.h));
    let gap = load(simd, &work[scratch::GAP]) + V3::load(simd, &work[scratch::NORMAL..]).dot(delta);
    store(shut.select((force - k * gap).max(0.0), force), &mut tile.state[outer][state::PRESS]);
}
