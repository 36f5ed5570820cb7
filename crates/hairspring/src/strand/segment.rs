//! Segments stay outside of colliders as points do: where one cuts a corner that its ends stay out of, its outer end swings out until it is
//! clear (in `post_solve`), and from then on the place that cut is pressed in the solve, like a point (`contact`).
//!
//! ```text
//!        a ●━━━╲━━━━┓           gap −d at the place s of the segment: the outer end swings about a by d/s,
//!      ────────┐╲   ┃ b         and a force N n at s is one of (1−s) N n on a and s N n on b
//!      collider│ ╲━━●
//! ```
//!
//! The place is state, like the force: it moves where another is found that cuts, and so a force does not hop about between solves.
//!
//! Between walls that face each other, swings lead to and fro though there may be room beside. What they have not freed begins anew from one direction
//! after another, ever farther aside, until it is out or much less deep than it was.
//!
//! # Missing
//! A place near the inner end is for the next solve: a strand that is caught, or that lands at 30 m/s, cuts in for a moment.

use super::{
    assemble::{Linearization, SubstepContext},
    colliders::{contact, find_deepest_point, segment_may_penetrate, surface_displacement},
    contact::{
        STICK, Surface, nearest,
        scratch::{self, SEGMENT},
    },
    friction::Friction,
    model::stretch::STRETCH,
    post_solve::{CORRECTIONS, LIMIT, Particle, PostSolveParams, SegmentLimit, out_of},
    system::System,
    tile::{Tile, rest, segment_contact, state},
};
use crate::collide::{ColliderPose, DeepestPoint, Edges, STEEP, Side};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, Work, load, store};
use glam::Vec3;

/// How deep a segment may be between its ends, over its length [1]. On a smooth body it is always a little inside: by L/8R of its length over a
/// radius of R. That is no contact: points alone hold it, and a head with segments of a centimetre is a smooth body.
const SAG: f32 = 0.015;

/// Nearest place to the inner end whose depth the outer end answers wholly, as a part of the segment [1]. What is nearer is for the inner
/// end, in the next solve: a lever that short would throw the outer one.
const NEAREST: f32 = 0.125;

/// The same of a thin box [1], whose edge is met by all places of a segment in turn. By trial: with [`NEAREST`], boxes of 1 mm lost 1 to 3 % of the hair that they
/// were dragged through.
const NEAREST_OF_BOX: f32 = 0.25;

/// Shortest lever by which an outer end answers a thin box, or a rod thinner than [`THIN_FOR_LEVER`], as a part of the segment [1]: the rest is for the next substep.
const SHORTEST: f32 = 0.25;

/// Radius of such a rod, over the segment's length [1].
const THIN_FOR_LEVER: f32 = 1.0 / 6.0;

/// Radius of a rod from which on it may be left near the inner end of a segment, over how deep the segment may be [1].
const THIN_ROD: f32 = 5.0;

/// How deep a segment may be that is not corrected again, over how deep it may be at all [1].
const ENOUGH: f32 = 1.02;

/// How much deeper than it may be a segment that swings to and fro is left, over its length [1]: what is no deeper is not worth being turned aside.
const LEFT: f32 = 0.5 * SAG;

/// Directions from which such a segment begins anew.
const STARTS: usize = 48;

/// Corrections from each of them: what has room there is out by then.
const OF_EACH: usize = 3;

/// How far aside the last of them is, over the segment's length, in each direction of space [1].
const FARTHEST: f32 = 1.0;

/// Whether no segment of up to `length` [m] need be looked at beside what is round with this `radius` [m]: it lies within what it may, as long as the limit lets
/// it become.
pub fn segment_contact_unneeded(length: f32, radius: f32) -> bool {
    length * (1.0 + LIMIT).powi(2) <= 8.0 * SAG * radius
}

/// How much deeper than the surface the segment to point `i` may be between its ends [m]: as deep as it was authored, and what a smooth body takes.
#[inline(always)]
pub fn segment_tolerance<S: Simd>(simd: S, tile: &Tile, i: usize) -> F<S> {
    let inner = i - tile.model.stride();
    let tolerance = load(simd, &tile.rest[inner][rest::LENGTH]) * SAG;
    tile.rest_penetration.get(i).map_or(tolerance, |sunk| tolerance - load(simd, sunk))
}

/// Where point `i` may be, which is at `e` from the strand's point before and was at `old`, so that the segment between them is outside of `pose`. What
/// held it out presses on in the next solve. The point came in at that `distance` from the surface [m]; those that are `caught` are inside still.
#[inline(always)]
pub fn resolve_segment_contact<S: Simd>(
    simd: S,
    (finish, step, pose): (&PostSolveParams, &SubstepContext<S>, &ColliderPose),
    tile: &mut Tile,
    (i, old, e): (usize, V3<S>, V3<S>),
    (inner, link): (&Particle<S>, &SegmentLimit<S>),
    (distance, caught): (F<S>, Mask<S>),
) -> V3<S> {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let a = step.root.position + inner.x;
    let clear = -segment_tolerance(simd, tile, i);
    // What ends farther from the surface than it is long has no place inside: a distance changes by no more than the way, but for a field between two
    // nodes on the two sides of a thin wall, where a place near the inner end may be passed over.
    let far = distance.max(0.0);
    let mut may = caught | (far * far).simd_lt(e.dot(e));
    if may.any_true() {
        may = caught | segment_may_penetrate(simd, pose, (a + e, e), -clear);
    }
    if !may.any_true() {
        return e;
    }
    // What is thinner than the segment is long may be pulled through in a substep.
    let thin = |edges: &&Edges| link.length.simd_gt(2.0 * edges.half_thickness()).any_true();
    let edges = pose.edges.as_ref().filter(thin);
    let side = edges.map(|edges| {
        let mut side = edges.side(simd, (a - inner.way, old), -(clear + clear));
        side.known &= link.length.simd_gt(2.0 * edges.half_thickness());
        (edges, side)
    });
    // A rod that is left near the inner end would be past the segment before the next solve.
    let nearest = F::<S>::splat(simd, NEAREST);
    let (from, shortest) = match edges {
        Some(edges) if edges.is_box() => (F::splat(simd, NEAREST_OF_BOX), F::splat(simd, SHORTEST)),
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
        let asked = if correction == 0 { clear } else { clear * ENOUGH };
        // What is near the inner end is pressed there in the next solve and does not swing the outer one.
        let mut place = cut(simd, (pose, &side), (a, q), (if correction == 0 { zero } else { from }, asked));
        let pressed = place;
        let near = place.found & place.at.simd_lt(from);
        if correction == 0 && near.any_true() {
            place = place.or(near, cut(simd, (pose, &side), (a, q), (from, asked)));
        }
        let (distance, normal) = contact(simd, pose, a + q);
        let between = place.found.select(clear - place.distance, zero);
        // A swing may have led the end itself inside, around an edge.
        let end = allowed - distance;
        let end = end.simd_gt(link.slack()).select(end, zero);
        let end = if correction == 0 { caught.select(end, zero) } else { end };
        let depth = between.max(end);
        cuts &= depth.simd_gt(0.0);
        let pressing = may & pressed.found;
        if !(cuts.any_true() || correction == 0 && pressing.any_true()) {
            break;
        }
        // What is turned aside has to be worth it, or it would be thrown through thin walls for nothing.
        let bar = if correction <= CORRECTIONS { 1.0 } else { 0.5 };
        let better = depth.simd_lt(least * bar);
        (best, least) = (V3::select(better, q, best), better.select(depth, least));
        if correction == CORRECTIONS || correction == last {
            // Caught: the least deep that it was, unless that is too deep to be left.
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
        // The whole way only where one correction was not enough: springs on an edge would tremble with it, and the rest of a first is pressed in the next solve.
        let gained = if correction == 0 { place.at } else { place.at * place.gain };
        let lever = first.select(gained.max(shortest), one);
        let mut out = link.clamp(link.swing_out(q, way_out, depth * far / lever));
        if correction == 0 {
            // What of the depth did not stop an approach presses on in the next solve, as of points.
            let v = |i: usize| V3::load(simd, &tile.state[i][state::V..]);
            let (v_a, v_b) = (v(i - tile.model.stride()), v(i));
            let way = (v_b - v_a).mul_add(pressed.at, v_a) * F::splat(simd, step.h);
            let carried = surface_displacement(simd, pose, e.mul_add(pressed.at, a));
            let approach = pressed.normal.dot(carried - way).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            let rows = &mut tile.segment_contacts[i];
            let force = load(simd, &rows[segment_contact::FORCE]);
            let deep = (clear - pressed.distance).max(0.0);
            let pressing = pressing & deep.simd_gt(end);
            let more = pressing.select(finish.pressed(force, mass, deep, approach), force);
            store(more, &mut rows[segment_contact::FORCE]);
            store(
                pressing.select(pressed.at, load(simd, &rows[segment_contact::AT])),
                &mut rows[segment_contact::AT],
            );
            if !finish.project {
                break;
            }
            // Back along the surface, at most μ times as far.
            let carried = surface_displacement(simd, pose, e.mul_add(place.at, a));
            let slide = (out - old).mul_add(place.at, inner.way) - carried;
            let tangent = slide - place.normal * place.normal.dot(slide);
            let hold = Friction::of(simd, step.h, tile.strand).share(depth, tangent.dot(tangent));
            out = V3::select(first, link.clamp(out - tangent * hold), out);
        }
        q = V3::select(cuts, out, q);
    }
    q
}

/// Where the segment from `a` to `a + q` cuts the shape or is past the side of it that it was on, no nearer to its beginning than the part `from` of it.
#[inline(always)]
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

/// `e` turned aside for the `start`th time, from 1 on: each time in another direction, at first a little and at last by [`FARTHEST`].
#[inline(always)]
fn perturb<S: Simd>(simd: S, e: V3<S>, start: usize) -> V3<S> {
    // The additive recurrence R₃, which fills a cube evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"): powers of the root
    // of x⁴ = x + 1.
    const STEPS: Vec3 = Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let turn = (STEPS * start as f32 + 0.5).fract() * 2.0 - 1.0;
    let far = FARTHEST * (start as f32 / STARTS as f32).powi(2);
    let (l, _) = e.length_and_unit();
    V3::splat(simd, turn * far) * l + e
}

/// Adds contact to the segment from point `i`, the first of the window, to the strand's next, which is in it too. Point `i` is at `x` from the
/// root, drifts by `drift` and is by then `way` from where the substep began. `stride` is the model's, told and not looked up: the compiler has to know
/// which entries these are, or all of the band stays in memory.
#[inline(always)]
pub fn assemble_segment_contact<S: Simd, const B: usize>(
    simd: S,
    (sweep, step, stride): (Linearization, &SubstepContext<S>, usize),
    tile: &mut Tile,
    (i, x, drift, way): (usize, V3<S>, V3<S>, V3<S>),
    system: &mut impl System<S, B>,
    (edges, contacts): (&[[Work; 3]], &mut [[Work; scratch::ROWS]]),
) {
    let outer = i + stride;
    let Some(rows) = tile.segment_contacts.get(outer) else { return };
    let force = load(simd, &rows[segment_contact::FORCE]);
    if !force.simd_gt(0.0).any_true() {
        return;
    }
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let at = load(simd, &rows[segment_contact::AT]);
    // From this point to the next, now and where the substep began.
    let mut e = V3::load(simd, &edges[outer]);
    let mut old = V3::load(simd, &tile.state[outer][state::EDGE..]);
    if stride == 2 {
        e += V3::load(simd, &edges[i + 1]);
        old += V3::load(simd, &tile.state[i + 1][state::EDGE..]);
    }
    let (at, Surface { distance, normal, carried }) =
        nearest_edge(simd, step.obstacles, (x + step.root.position, e), at);
    store(at, &mut tile.segment_contacts[outer][segment_contact::AT]);
    let gap = distance + segment_tolerance(simd, tile, outer);

    // Shut while N could close the gap in a substep; what has gone farther is let go.
    let m_h2 = load(simd, &tile.rest[outer][rest::MASS]) * (1.0 / (step.h * step.h));
    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    let gap = shut.select(gap, zero);
    store(force, &mut tile.segment_contacts[outer][segment_contact::FORCE]);
    if !shut.any_true() {
        return;
    }
    // Across the segment: on an edge the surface's own normal jumps between two faces, this one does not.
    let (_, u) = e.length_and_unit();
    let (size, across) = (normal - u * normal.dot(u)).length_and_unit();
    let normal = V3::select(size.simd_lt(STEEP), normal, across);
    let normal = V3::select(shut, normal, V3::zero(simd));
    let work = &mut contacts[outer][SEGMENT..];
    normal.store(&mut work[scratch::NORMAL..]);
    store(gap, &mut work[scratch::GAP]);

    // What the outer end does besides what the inner one does.
    let v = V3::load(simd, &tile.state[i][state::V..]);
    let faster = V3::load(simd, &tile.state[outer][state::V..]) - v;
    let h = F::splat(simd, step.h);
    let drifts = faster * h;
    let (drift_more, way_more) =
        if sweep == Linearization::Initial { (drifts, drifts) } else { (V3::zero(simd), e - old) };
    let (drift, way) = (drift_more.mul_add(at, drift), way_more.mul_add(at, way));
    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = faster.mul_add(at, v) * h;
    let (slid, _) = along(before - carried).length_and_unit();
    let rub = Friction::of(simd, step.h, tile.strand).secant(force, slid, k * STICK);
    let block = Sym3::outer(normal, k - rub).add_identity(rub);
    let push = normal * (force - k * (gap + normal.dot(drift))) - along(way + step.moved - carried) * rub;
    let share = one - at;
    system.add_diagonal(0, block * (share * share));
    system.add_diagonal(stride, block * (at * at));
    system.add_block(0, stride, &(block * (share * at)).full());
    system.add_force(0, push * share);
    system.add_force(stride, push * at);
}

/// The surface that is nearest to the place `at` of the segments from `a` to `a + e` (world), and that place; on an edge of a box, where the
/// segment crosses it. The distance along the edge's normal has no jump between two faces.
#[inline(never)]
fn nearest_edge<S: Simd>(
    simd: S,
    obstacles: &[ColliderPose],
    (a, e): (V3<S>, V3<S>),
    at: F<S>,
) -> (F<S>, Surface<S>) {
    simd.vectorize(
        #[inline(always)]
        || {
            let mut surface = nearest(simd, obstacles, e.mul_add(at, a));
            let mut at = at;
            for pose in obstacles {
                let Some(edges) = pose.edges.as_ref().filter(|edges| edges.is_box()) else { continue };
                let place = edges.nearest(simd, (a, e));
                let nearer = place.found & place.distance.simd_le(surface.distance);
                if nearer.any_true() {
                    let carried = surface_displacement(simd, pose, e.mul_add(place.at, a));
                    at = nearer.select(place.at, at);
                    surface.distance = nearer.select(place.distance, surface.distance);
                    surface.normal = V3::select(nearer, place.normal, surface.normal);
                    surface.carried = V3::select(nearer, carried, surface.carried);
                }
            }
            (at, surface)
        },
    )
}

/// The force that presses the segment from point `i` once the solve has moved its ends by `moved`.
#[inline(always)]
pub fn update_segment_contact_multiplier<S: Simd>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, moved): (usize, [V3<S>; 2]),
    contacts: &[[Work; scratch::ROWS]],
) {
    let outer = i + tile.model.stride();
    let Some(rows) = tile.segment_contacts.get_mut(outer) else { return };
    let force = load(simd, &rows[segment_contact::FORCE]);
    let shut = force.simd_gt(0.0);
    if !shut.any_true() {
        return;
    }
    let work = &contacts[outer][SEGMENT..];
    let delta = (moved[1] - moved[0]).mul_add(load(simd, &rows[segment_contact::AT]), moved[0]);
    let k = load(simd, &tile.rest[outer][rest::MASS]) * (STRETCH / (step.h * step.h));
    let gap = load(simd, &work[scratch::GAP]) + V3::load(simd, &work[scratch::NORMAL..]).dot(delta);
    store(shut.select((force - k * gap).max(0.0), force), &mut rows[segment_contact::FORCE]);
}
