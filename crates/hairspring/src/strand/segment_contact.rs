//! Contact of segments inside the solve, as `contact` for points: a collider exerts a normal force and friction at a
//! place of the segment.
//!
//! The place is part of the state, like the force. It follows the deepest place, but slowly where that jumps, so that
//! the force does not jump between solves.

use super::{
    assemble::{Linearization, SubstepContext},
    colliders::{contact, find_deepest_point, surface_displacement},
    contact::{
        Surface, nearest, passes, relaxed_gap,
        scratch::{self, SEGMENT},
    },
    friction::{Friction, FrictionSpring},
    model::stretch::STRETCH,
    segment::{max_tolerance, segment_tolerance},
    system::System,
    tile::{Tile, rest, segment_contact, state},
};
use crate::collide::{ColliderPose, ColliderShape, DeepestPoint, Edges, STEEP};
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, Work, load, store};

/// Distance to which the place of a contact follows the deepest place of its segment in a substep, as a fraction of
/// the segment [1].
const STEP: f32 = 0.02;

/// The same on a hull where the deepest place jumps farther. Found by trial: at 0.05, hair that lies on two edges of a hull
/// trembles by 4 mm/s.
const JUMP: f32 = 0.01;

/// Ratio of the stiffness of a segment's friction spring to that of contact [1]. Found by trial: at 4, hair over the edge
/// of a box trembles by 5 mm/s, and at 1, hair over a stone by 2.6 mm/s.
const STICK: f32 = 1.5;

/// Rate at which the solve closes the gap of a segment inside an edge of a thick box at rest [1/s]: the depth decreases to 1/e within 42
/// ms.
///
/// The gap is measured across segment and edge. Where the segment is nearly parallel to a face, it is many times the depth
/// that begins a contact (see `segment`). If the solve closed it within one substep, it would throw the segment off the edge,
/// again and again. Found by trial with curled hair over boxes; 12 and 48 are as good. The idea is the soft contact of Box2D
/// v3.
const EDGE_RATE: f32 = 24.0;

/// Speed below which an edge is at rest [m/s].
const RESTS: f32 = 1e-3;

/// Adds the contact of the segment from point `i`, the first of the window, to the strand's next, which is in
/// the window as well.
///
/// `x` is the position of point `i` relative to the root, `drift` its predicted displacement, and `displacement` its
/// displacement since the start of the substep, including `drift`. `stride` is the model's. It is a parameter
/// so that the compiler knows which entries of the band are written; otherwise all of the band stays in
/// memory.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn assemble_segment_contact<S: Simd, const B: usize>(
    simd: S,
    (sweep, step, stride): (Linearization, &SubstepContext<S>, usize),
    tile: &mut Tile,
    (i, x, drift, displacement): (usize, V3<S>, V3<S>, V3<S>),
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
    // The segment from this point to the next, now and at the start of the substep.
    let mut e = V3::load(simd, &edges[outer]);
    let mut old = V3::load(simd, &tile.state[outer][state::EDGE..]);
    if stride == 2 {
        e += V3::load(simd, &edges[i + 1]);
        old += V3::load(simd, &tile.state[i + 1][state::EDGE..]);
    }
    let (at, Surface { distance, normal, carried, tolerance }, at_edge) = nearest_edge(
        simd,
        step.colliders,
        (x + step.root.position, e),
        at,
        [i, outer].map(|i| passes(simd, tile, i)),
    );
    store(at, &mut tile.segment_contacts[outer][segment_contact::AT]);
    let gap = distance + segment_tolerance(simd, tile, outer, tolerance);

    // The contact is closed while N could close the gap within a substep. Segments farther away are released.
    let m_h2 = load(simd, &tile.rest[outer][rest::MASS]) * (1.0 / (step.h * step.h));
    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    // A moving edge could pass the segment before a slow correction ends. Refined substeps are used near moving edges.
    let slow = if step.relaxation < 1.0 { 1.0 } else { (EDGE_RATE * step.h).min(1.0) };
    let rests = at_edge & carried.dot(carried).simd_lt((RESTS * step.h).powi(2));
    let gap = rests.select(relaxed_gap(gap, normal.dot(carried), slow), gap);
    let gap = shut.select(gap, zero);
    store(force, &mut tile.segment_contacts[outer][segment_contact::FORCE]);
    let rows = &mut tile.segment_contacts[outer][segment_contact::FRICTION_STRETCH..];
    let stretch = [0, 1].map(|k| shut.select(load(simd, &rows[k]), zero));
    if !shut.any_true() {
        stretch.into_iter().zip(rows).for_each(|(stretch, row)| store(stretch, row));
        return;
    }
    // The normal is made perpendicular to the segment: on an edge, the surface normal jumps between two
    // faces, and this one does not.
    let (_, u) = e.length_and_unit();
    let (size, across) = (normal - u * normal.dot(u)).length_and_unit();
    let normal = V3::select(size.simd_lt(STEEP), normal, across);
    let normal = V3::select(shut, normal, V3::zero(simd));
    let work = &mut contacts[outer][SEGMENT..];
    normal.store(&mut work[scratch::NORMAL..]);
    store(gap, &mut work[scratch::GAP]);

    // Motion of the outer end relative to the inner one.
    let v = V3::load(simd, &tile.state[i][state::V..]);
    let faster = V3::load(simd, &tile.state[outer][state::V..]) - v;
    let h = F::splat(simd, step.h);
    let drifts = faster * h;
    let (drift_more, displacement_more) =
        if sweep == Linearization::Initial { (drifts, drifts) } else { (V3::zero(simd), e - old) };
    let (drift, displacement) = (drift_more.mul_add(at, drift), displacement_more.mul_add(at, displacement));
    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = faster.mul_add(at, v) * h;
    let slid = along(before - carried);
    let limit = Friction::of(simd, step.h, tile, i).limit(force, slid.length_and_unit().0);
    let rows = &mut tile.segment_contacts[outer];
    let sideways = normal.cross(u);
    let z = along(u * stretch[0] + sideways * stretch[1]);
    let z = z + if sweep == Linearization::Initial { slid } else { V3::zero(simd) };
    let FrictionSpring { stretch, stiffness } = FrictionSpring::new((limit, k * STICK), z, slid);
    let out = [stretch.dot(u), stretch.dot(sideways)];
    for (stretch, row) in out.into_iter().zip(&mut rows[segment_contact::FRICTION_STRETCH..]) {
        store(shut.select(stretch, zero), row);
    }
    let block = Sym3::outer(normal, k - stiffness).add_identity(stiffness);
    let push = normal * (force - k * (gap + normal.dot(drift)))
        - (stretch + along(displacement + step.moved - carried)) * stiffness;
    let share = one - at;
    system.add_diagonal(0, block * (share * share));
    system.add_diagonal(stride, block * (at * at));
    system.add_block(0, stride, &(block * (share * at)).full());
    system.add_force(0, push * share);
    system.add_force(stride, push * at);
}

/// Returns the surface nearest to the place `at` of the segments from `a` to `a + e` (world), that place, and where it is
/// the edge of a box that is thicker than the segment is long.
/// Where segments cross an edge of a box or a hull, the place follows the crossing. The distance there, along the
/// normal across segment and edge, is continuous across the two faces. The colliders that are `passed` are left out; they
/// have no straight edges.
#[inline(never)]
fn nearest_edge<S: Simd>(
    simd: S,
    colliders: &[ColliderPose],
    (a, e): (V3<S>, V3<S>),
    at: F<S>,
    passed: [F<S>; 2],
) -> (F<S>, Surface<S>, Mask<S>) {
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || {
            let mut surface = nearest(simd, colliders, e.mul_add(at, a), passed);
            let mut at = at;
            let (mut at_edge, length) = (Mask::splat(simd, false), e.length_and_unit().0);
            let whole = (F::splat(simd, 0.0), F::splat(simd, f32::MAX));
            for pose in colliders {
                if !has_straight_edges(pose) {
                    continue;
                }
                let place = match &pose.edges {
                    Some(edges) => edges.nearest(simd, (a, e)),
                    None => find_deepest_point(simd, pose, (a, e), whole)
                        .unwrap_or_else(|| DeepestPoint::none(simd)),
                };
                let between = place.at.simd_gt(0.0) & place.at.simd_lt(1.0);
                let between = between | Mask::splat(simd, pose.edges.is_some());
                let nearer = place.found & between & place.distance.simd_le(surface.distance);
                if nearer.any_true() {
                    let moved = moved_place(pose, at, place.at);
                    let p = e.mul_add(moved, a);
                    let there = moved.simd_eq(place.at);
                    let (distance, normal) = contact(simd, pose, p);
                    let distance = there.select(place.distance, distance);
                    let normal = V3::select(there, place.normal, normal);
                    let carried = surface_displacement(simd, pose, p);
                    at = nearer.select(moved, at);
                    surface.distance = nearer.select(distance, surface.distance);
                    surface.normal = V3::select(nearer, normal, surface.normal);
                    surface.carried = V3::select(nearer, carried, surface.carried);
                    let tolerance = F::splat(simd, max_tolerance(pose));
                    surface.tolerance = nearer.select(tolerance, surface.tolerance);
                    let half = pose.edges.as_ref().map_or(0.0, Edges::half_thickness);
                    at_edge = (at_edge & !nearer) | (nearer & length.simd_lt(2.0 * half));
                }
            }
            (at, surface, at_edge)
        },
    )
}

/// Returns whether segments cross edges of the shape, whose place [`nearest_edge`] follows.
fn has_straight_edges(pose: &ColliderPose) -> bool {
    matches!(pose.shape, ColliderShape::Cuboid { .. } | ColliderShape::Hull(_))
}

/// Returns the place `at` after one substep in which it follows `to`, both as fractions of the segment. It follows slowly
/// on hulls and on fields, whose deepest place jumps between the cells along a ridge. A thin box may cross a whole
/// segment in a substep.
///
/// ```text
///       ┏━━━━━●━━━━━━━●━━━━     a segment that lies on two edges: the deepest place jumps from one to the other, and
///      ┃  edge╲_______╱edge     the contact comes to rest between them, where the force balances the load
/// ```
#[inline(always)]
pub fn moved_place<S: Simd>(pose: &ColliderPose, at: F<S>, to: F<S>) -> F<S> {
    let most = match pose.shape {
        ColliderShape::Hull(_) => JUMP,
        ColliderShape::Field(_) => STEP,
        _ => return to,
    };
    let slowly = to.min(at + most).max(at - most);
    (to - at).abs().simd_le(STEP).select(to, slowly)
}

/// Updates the contact force on the segment from point `i` after the solve has moved its ends by `moved`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn update_segment_contact_multiplier<S: Simd>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, moved): (usize, [V3<S>; 2]),
    contacts: &[[Work; scratch::ROWS]],
) {
    let outer = i + tile.layout.model.stride();
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
    let now = (force - k * gap).max(0.0);
    store(shut.select(now, force), &mut rows[segment_contact::FORCE]);
    for row in &mut rows[segment_contact::FRICTION_STRETCH..] {
        store(now.simd_gt(0.0).select(load(simd, row), F::splat(simd, 0.0)), row);
    }
}
