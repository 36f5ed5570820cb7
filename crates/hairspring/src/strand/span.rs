//! Contact of segments inside the solve: one that a collider holds out between its ends is pressed there, and rubs, like points in `press`.
//!
//! ```text
//!   δ = (1 − s) δ_a + s δ_b      the move of the place s that is deepest;   N ← max(0, N − k (g + n·δ)),   k = STRETCH m/h²
//! ```
//!
//! Both ends share it, (1 − s) and s: the matrix gets k n nᵀ times the squares of the shares on the diagonal and their product between the
//! two, where stretch is as well. A strand hangs over an edge at rest so. N begins in `segment`.

use super::{
    assemble::{Step, Sweep},
    band::Band,
    lanes::{F, Row, Sym3, V3, load, store},
    model::stretch::STRETCH,
    press::scratch,
    root::Root,
    scratch::Scratch,
    segment::clear_of_segment,
    tile::{Tile, rest, state},
};
use crate::collide::{contact, deepest, surface_displacement};
use fearless_simd::prelude::*;

/// Adds contact to the segment from point `i`, the second of the band's window, to the strand's next, which is in it too; `x`, `drift` and
/// `way` are those of point `i`, see `press`.
#[inline(always)]
pub fn press_segment<S: Simd, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Sweep, &Step<S>),
    tile: &mut Tile,
    (i, x, drift, way): (usize, V3<S>, V3<S>, V3<S>),
    band: &mut Band<S, B, N>,
    scratch: &mut Scratch,
) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let force = load(simd, &tile.state[i][state::SPAN]);
    if !force.simd_gt(0.0).any_true() {
        return;
    }
    let stride = tile.model.stride();
    let outer = i + stride;
    // From this point to the next, now and where the substep began.
    let mut e = V3::load(simd, &scratch.edges[i + 1]);
    let mut old = V3::load(simd, &tile.state[i + 1][state::EDGE..]);
    if stride == 2 {
        e += V3::load(simd, &scratch.edges[outer]);
        old += V3::load(simd, &tile.state[outer][state::EDGE..]);
    }
    let world = x + step.root.position;
    let clear = clear_of_segment(simd, tile, outer);
    let (mut gap, mut normal, mut carried) = (F::splat(simd, f32::MAX), V3::zero(simd), V3::zero(simd));
    let mut at = zero;
    for pose in step.obstacles {
        let ends = [contact(simd, pose, world), contact(simd, pose, world + e)];
        let place = deepest(simd, pose, &pose.end, (world, e), &ends);
        let nearest = place.distance.simd_lt(gap);
        gap = nearest.select(place.distance, gap);
        normal = V3::select(nearest, place.normal, normal);
        at = nearest.select(place.at, at);
        let there = surface_displacement(simd, pose, e.mul_add(place.at, world));
        carried = V3::select(nearest, there, carried);
    }
    gap -= clear;

    let m_h2 = load(simd, &tile.rest[outer][rest::MASS]) * (1.0 / (step.h * step.h));
    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    gap = shut.select(gap, zero);
    normal = V3::select(shut, normal, V3::zero(simd));
    at = shut.select(at, zero);
    store(force, &mut tile.state[i][state::SPAN]);
    let work = &mut scratch.contacts[i];
    normal.store(&mut work[scratch::SPAN_NORMAL..]);
    store(gap, &mut work[scratch::SPAN_GAP]);
    store(at, &mut work[scratch::SPAN_AT]);

    let v = V3::load(simd, &tile.state[i][state::V..]);
    let faster = V3::load(simd, &tile.state[outer][state::V..]) - v;
    let (drift_more, way_more) = match sweep {
        Sweep::First => (faster * F::splat(simd, step.h), faster * F::splat(simd, step.h)),
        _ => (V3::zero(simd), e - old),
    };
    let (drift, way) = (drift_more.mul_add(at, drift), way_more.mul_add(at, way));
    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = faster.mul_add(at, v) * F::splat(simd, step.h);
    let (slid, _) = along(before - carried).length_and_unit();
    let rub = (Root::<S>::fibre(simd, tile.strand).2 * force / slid).min(k);
    let block = Sym3::outer(normal, k - rub).add_identity(rub);
    let push = normal * (force - k * (gap + normal.dot(drift))) - along(way + step.moved - carried) * rub;
    let share = one - at;
    band.add_diagonal(1, block * (share * share));
    band.add_diagonal(1 + stride, block * (at * at));
    band.add_block(1, 1 + stride, &(block * (share * at)).full());
    band.add_force(1, push * share);
    band.add_force(1 + stride, push * at);
}

/// The force that presses the segment from point `i` once the solve has moved its ends.
#[inline(always)]
pub fn relieve_segment<S: Simd>(
    simd: S,
    step: &Step<S>,
    tile: &mut Tile,
    (i, moved): (usize, [V3<S>; 2]),
    work: &[Row; scratch::ROWS],
) {
    let force = load(simd, &tile.state[i][state::SPAN]);
    let shut = force.simd_gt(0.0);
    if !shut.any_true() {
        return;
    }
    let outer = i + tile.model.stride();
    let k = load(simd, &tile.rest[outer][rest::MASS]) * (STRETCH / (step.h * step.h));
    let delta = (moved[1] - moved[0]).mul_add(load(simd, &work[scratch::SPAN_AT]), moved[0]);
    let gap = load(simd, &work[scratch::SPAN_GAP]) + V3::load(simd, &work[scratch::SPAN_NORMAL..]).dot(delta);
    store(shut.select((force - k * gap).max(0.0), force), &mut tile.state[i][state::SPAN]);
}
