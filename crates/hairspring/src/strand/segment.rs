//! Contact of segments between their ends. Where a segment cuts a corner that its end points stay out of,
//! `post_solve` rotates its outer end until the segment is out. From then on, the solve applies a contact
//! force at the place of the cut (`segment_contact`).
//!
//! ```text
//!        a ●━━━╲━━━━┓           gap −d at the place s of the segment: the outer end rotates about a by d/s,
//!      ────────┐╲   ┃ b         and a force N n at s is (1−s) N n on a and s N n on b
//!      collider│ ╲━━●
//! ```
//!
//! Between walls that face each other, corrections alternate although there may be room to the side. A
//! segment that they do not free restarts from a sequence of directions, each farther aside, until it is out
//! or much less deep than before.
//!
//! # Limitations
//! A cut near the inner end is left to the next solve. A strand that is caught, or that lands at 30 m/s, is
//! inside for a moment. A segment that pierces a thin box stays there until the box or the strand has left.

use super::{
    assemble::SubstepContext,
    colliders::{contact, find_deepest_point, segment_may_penetrate, surface_displacement},
    friction::Friction,
    post_solve::{CORRECTIONS, LIMIT, Particle, PostSolveParams, SegmentLimit, out_of},
    segment_contact::moved_place,
    tile::{Tile, rest, segment_contact, state},
};
use crate::collide::{ColliderPose, DeepestPoint, Edges, Side};
use crate::simd::lanes::{F, Mask, Simd, V3, load, store};
use glam::Vec3;

/// Permitted depth of a segment between its ends, over its length [1]. On a smooth body with radius R, a
/// segment of length L is always inside by L/8R of its length. That is not treated as a contact, because the
/// points hold the segment, and a head with segments of a centimeter is a smooth body.
const SEGMENT_TOLERANCE: f32 = 0.015;

/// Permitted depth in a thin rod, over its radius [1]. It does not apply to thin boxes: with the same limit, a plate of 1 mm
/// that is dragged through segments of 27 mm throws hair.
const SHARE_OF_ROD: f32 = 0.5;

/// Place closest to the inner end whose depth the outer end corrects in full, as a fraction of the segment
/// [1]. Closer places are left to the inner end, in the next solve: such a short lever would throw the outer
/// end.
const NEAREST: f32 = 0.125;

/// The same for a thin box, whose edge passes over all places of a segment [1]. Found by trial: with
/// [`NEAREST`], boxes of 1 mm lost 1 to 3 % of the hair that they were dragged through. In refined substeps it is 0,
/// because [`relax`](super::relax) limits the speed of the outer end.
const NEAREST_OF_BOX: f32 = 0.25;

/// Length from which on a segment may pierce a box, over the thickness of the box [1].
const LONG_FOR_BOX: f32 = 2.0;

/// Shortest lever for corrections of the outer end at a thin box, or at a rod thinner than
/// [`THIN_FOR_LEVER`], as a fraction of the segment [1]. The rest is left to the next substep.
const SHORTEST: f32 = 0.25;

/// Radius of such a rod, over the segment's length [1].
const THIN_FOR_LEVER: f32 = 1.0 / 6.0;

/// Radius from which on a rod may be left near the inner end of a segment, over the permitted depth of the
/// segment [1]. Found by trial: at 5, a rod of 1 mm radius, dragged slowly, lost 1 of 200 hairs with segments of 8 mm.
const THIN_ROD: f32 = 10.0;

/// Depth up to which a segment is not corrected again, over the permitted depth [1].
const ENOUGH: f32 = 1.02;

/// Excess depth up to which a segment with alternating corrections is left, over its length [1]. A smaller
/// depth does not justify a restart.
const LEFT: f32 = 0.5 * SEGMENT_TOLERANCE;

/// Number of directions from which such a segment restarts.
const STARTS: usize = 48;

/// Corrections from each direction. Where there is room, they suffice.
const OF_EACH: usize = 3;

/// Largest offset of a restart along each axis, over the segment's length [1].
const FARTHEST: f32 = 1.0;

/// Returns whether segments of up to `length` [m] need no test against a round shape with this `radius` [m]:
/// their depth is within the tolerance at any length that the strain limit permits.
pub fn segment_contact_unneeded(length: f32, radius: f32) -> bool {
    length * (1.0 + LIMIT).powi(2) <= 8.0 * SEGMENT_TOLERANCE * radius
}

/// Returns the largest depth that [`segment_tolerance`] permits in this collider [m]. In a rod thinner than the tolerance
/// for smooth bodies, hair would pass through its axis.
#[inline(always)]
pub fn max_tolerance(pose: &ColliderPose) -> f32 {
    let rod = pose.edges.as_ref().filter(|edges| !edges.is_box());
    rod.map_or(f32::INFINITY, |edges| SHARE_OF_ROD * edges.half_thickness())
}

/// Permitted depth of the segment that ends at point `i`, between its ends [m]: the authored depth plus the
/// tolerance for smooth bodies, which is at most `max`; see [`max_tolerance`].
#[inline(always)]
pub fn segment_tolerance<S: Simd>(simd: S, tile: &Tile, i: usize, max: F<S>) -> F<S> {
    let inner = i - tile.layout.model.stride();
    let tolerance = (load(simd, &tile.rest[inner][rest::LENGTH]) * SEGMENT_TOLERANCE).min(max);
    tile.rest_penetration.get(i).map_or(tolerance, |authored| tolerance - load(simd, authored))
}

/// Returns the corrected offset `e` of point `i` from the strand's previous point, so that the segment
/// between them is outside of `pose`. `old` is the offset before the substep. The contact force of the next
/// solve is updated.
///
/// `distance` is the point's distance from the surface before its own correction [m]. Points that are
/// `caught` are still inside. Segments at a point that passes through the collider are `free`. `before` is the distance of
/// the inner end from the surface, where that end may be inside [m].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn resolve_segment_contact<S: Simd>(
    simd: S,
    (finish, step, pose): (&PostSolveParams, &SubstepContext<S>, &ColliderPose),
    tile: &mut Tile,
    (i, old, e): (usize, V3<S>, V3<S>),
    (inner, link): (&Particle<S>, &SegmentLimit<S>),
    (distance, caught, free): (F<S>, Mask<S>, Mask<S>),
    before: F<S>,
) -> V3<S> {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let a = step.root.position + inner.x;
    let tolerated = -segment_tolerance(simd, tile, i, F::splat(simd, max_tolerance(pose)));
    // No motion of the segment takes its inner end out, and a force on it would grow without bound.
    let stuck = before.simd_lt(tolerated);
    let clear = stuck.select(before, tolerated);
    if stuck.any_true() {
        let row = &mut tile.segment_contacts[i][segment_contact::FORCE];
        store(stuck.select(zero, load(simd, row)), row);
    }
    // A segment whose end is farther from the surface than the segment is long has no place inside, because
    // distance is 1-Lipschitz. The exception is a field sampled on the two sides of a thin wall, where a
    // place near the inner end may be missed.
    let far = distance.max(0.0);
    let mut may = (caught | (far * far).simd_lt(e.dot(e))) & !free;
    if may.any_true() {
        may = (caught | segment_may_penetrate(simd, pose, (a + e, e), -clear)) & !free;
    }
    if !may.any_true() {
        return e;
    }
    // A collider thinner than the segment is long may pass through it within a substep.
    let thin = |edges: &&Edges| link.length.simd_gt(2.0 * edges.half_thickness()).any_true();
    let edges = pose.edges.as_ref().filter(thin);
    let side = edges.map(|edges| {
        let mut side = edges.side(simd, (a - inner.displacement, old), -(clear + clear));
        side.known &= link.length.simd_gt(2.0 * edges.half_thickness()) & !stuck;
        (edges, side)
    });
    // A segment that has pierced a thin box gets no correction and no force. Corrections would push it to one side and then
    // to the other.
    if let Some(edges) = edges.filter(|edges| edges.is_box()) {
        let long = link.length.simd_gt(LONG_FOR_BOX * 2.0 * edges.half_thickness());
        let pierced = may & long & edges.pierced_by(simd, (a - inner.displacement, old));
        if pierced.any_true() {
            let row = &mut tile.segment_contacts[i][segment_contact::FORCE];
            store(pierced.select(zero, load(simd, row)), row);
            may &= !pierced;
            if !may.any_true() {
                return e;
            }
        }
    }
    // A place before the fraction `from` of the segment is left to the next solve. A thin rod, or a thin box in a refined
    // substep, could have passed the segment by then, so `from` is 0 for these.
    let nearest = F::<S>::splat(simd, NEAREST);
    let (from, shortest) = match edges {
        Some(edges) if edges.is_box() => {
            let of_box = if finish.relaxation < 1.0 { 0.0 } else { NEAREST_OF_BOX };
            let thin = link.length.simd_gt(2.0 * edges.half_thickness());
            [of_box, SHORTEST].map(|of_thin| thin.select(F::splat(simd, of_thin), nearest)).into()
        }
        Some(edges) => {
            let thin = edges.is_rod_within(link.length * THIN_FOR_LEVER);
            let shortest = thin.select(F::splat(simd, SHORTEST), nearest);
            (edges.is_rod_within(clear * -THIN_ROD).select(zero, nearest), shortest)
        }
        None => (nearest, nearest),
    };
    let allowed = load(simd, &tile.rest[i][rest::CLEARANCE]);
    let (mut q, mut cuts, mut wall) = (e, may, V3::zero(simd));
    let (mut best, mut least) = (e, F::<S>::splat(simd, f32::MAX));
    let last = CORRECTIONS + STARTS * OF_EACH;
    for correction in 0..=last {
        let required = if correction == 0 { clear } else { clear * ENOUGH };
        // A contact near the inner end gets a force in the next solve and does not rotate the outer end.
        let mut place =
            cut(simd, (pose, &side), (a, q), (if correction == 0 { zero } else { from }, required));
        let pressed = place;
        let near = place.found & place.at.simd_lt(from);
        if correction == 0 && near.any_true() {
            place = place.or(near, cut(simd, (pose, &side), (a, q), (from, required)));
        }
        let (distance, normal) = contact(simd, pose, a + q);
        let between = place.found.select(clear - place.distance, zero);
        // The correction may have moved the end itself inside, around an edge.
        let end = allowed - distance;
        let end = end.simd_gt(link.slack()).select(end, zero);
        let end = if correction == 0 { caught.select(end, zero) } else { end };
        let depth = between.max(end);
        cuts &= depth.simd_gt(0.0);
        let pressing = may & pressed.found;
        if !(cuts.any_true() || correction == 0 && pressing.any_true()) {
            break;
        }
        // A restart must improve the depth considerably; otherwise it could pass through a thin wall without
        // benefit.
        let bar = if correction <= CORRECTIONS { 1.0 } else { 0.5 };
        let better = depth.simd_lt(least * bar);
        (best, least) = (V3::select(better, q, best), better.select(depth, least));
        if correction == CORRECTIONS || correction == last {
            // Caught: keep the smallest depth so far, unless that is too deep to be left.
            q = V3::select(cuts, best, q);
            cuts &= least.simd_gt(link.length * LEFT);
            if correction == last || !cuts.any_true() {
                break;
            }
        }
        let anew = correction.checked_sub(CORRECTIONS).filter(|more| more % OF_EACH == 0);
        if let Some(more) = anew {
            q = V3::select(cuts, link.clamp(perturb(simd, e, more / OF_EACH + 1)), q);
            wall = V3::zero(simd);
            continue;
        }
        let first = end.simd_lt(between);
        let normal = V3::select(first, place.normal, normal);
        let (way_out, far) = out_of(simd, normal, wall);
        wall = normal;
        // The full correction is applied only after the first one did not suffice. Applied at once, it makes
        // springs on an edge vibrate, and the remainder of the first becomes a contact force in the next
        // solve.
        let gained = if correction == 0 { place.at } else { place.at * place.gain };
        let lever = first.select(gained.max(shortest), one);
        let mut out = link.clamp(link.swing_out(q, way_out, depth * far / lever));
        if correction == 0 {
            // The part of the depth that did not stop an approach becomes a contact force in the next solve,
            // as for points.
            let v = |i: usize| V3::load(simd, &tile.state[i][state::V..]);
            let (v_a, v_b) = (v(i - tile.layout.model.stride()), v(i));
            let displacement = (v_b - v_a).mul_add(pressed.at, v_a) * F::splat(simd, step.h);
            let carried = surface_displacement(simd, pose, e.mul_add(pressed.at, a));
            let approach = pressed.normal.dot(carried - displacement).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            let rows = &mut tile.segment_contacts[i];
            let force = load(simd, &rows[segment_contact::FORCE]);
            let deep = (clear - pressed.distance).max(0.0);
            let pressing = pressing & deep.simd_gt(end) & !stuck;
            let more = pressing.select(finish.pressed(force, mass, deep, approach), force);
            store(more, &mut rows[segment_contact::FORCE]);
            let at = load(simd, &rows[segment_contact::AT]);
            let moved = force.simd_gt(0.0).select(moved_place(pose, at, pressed.at), pressed.at);
            store(pressing.select(moved, at), &mut rows[segment_contact::AT]);
            if !finish.project {
                break;
            }
            // Back along the surface, by at most μ times the depth.
            let carried = surface_displacement(simd, pose, e.mul_add(place.at, a));
            let slide = (out - old).mul_add(place.at, inner.displacement) - carried;
            let tangent = slide - place.normal * place.normal.dot(slide);
            let hold = Friction::of(simd, step.h, tile, i).share(depth, tangent.dot(tangent));
            out = V3::select(first, link.clamp(out - tangent * hold), out);
        }
        q = V3::select(cuts, out, q);
    }
    q
}

/// Returns where the segment from `a` to `a + q` is inside the shape, or past the side that it was on. Places
/// before the fraction `from` of the segment are ignored.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn cut<S: Simd>(
    simd: S,
    (pose, side): (&ColliderPose, &Option<(&Edges, Side<S>)>),
    (a, q): (V3<S>, V3<S>),
    (from, within): (F<S>, F<S>),
) -> DeepestPoint<S> {
    let place =
        find_deepest_point(simd, pose, (a, q), (from, within)).unwrap_or_else(|| DeepestPoint::none(simd));
    match side {
        Some((edges, side)) => {
            let past = edges.past(simd, side, (a, q), (from, within));
            place.or(past.found, past)
        }
        None => place,
    }
}

/// `e` displaced for the `start`th restart, counted from 1. Each restart has another direction, and the
/// offset grows up to [`FARTHEST`].
#[inline(always)]
fn perturb<S: Simd>(simd: S, e: V3<S>, start: usize) -> V3<S> {
    // The additive recurrence R₃, which fills a cube evenly (Roberts 2018, "The Unreasonable Effectiveness of
    // Quasirandom Sequences"): powers of the inverse root of x⁴ = x + 1.
    const STEPS: Vec3 = Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let turn = (STEPS * start as f32 + 0.5).fract() * 2.0 - 1.0;
    let far = FARTHEST * (start as f32 / STARTS as f32).powi(2);
    let (l, _) = e.length_and_unit();
    V3::splat(simd, turn * far) * l + e
}
