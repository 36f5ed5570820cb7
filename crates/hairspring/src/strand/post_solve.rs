//! The last stage of a substep: strain limit, collider contact of points and segments (`segment`), friction,
//! and velocities.
//!
//! One sweep from root to tip:
//!
//! - Strain limit: each segment is clamped to its rest length ± [`LIMIT`] by moving the outer point (follow
//!   the leader, Müller 2012, but only beyond the limit).
//! - Contact: a point inside a collider moves to the nearest free position, and its inward motion is removed
//!   (Liu 2013).
//! - Friction: Coulomb friction resists motion along the surface, by up to μ times the correction.
//!
//! With the implicit integrators, this stage handles only what the solve could not include: new contacts, and
//! points that projection pushed into a collider (see `contact`).

use super::{
    assemble::SubstepContext,
    colliders::{self, contact, segment_may_intersect, surface_displacement},
    contact::{is_passed, passes},
    friction::Friction,
    relax::{Correction, relax},
    scratch::Scratch,
    segment::{max_tolerance, resolve_segment_contact, segment_tolerance},
    tether::{apply_lra, exceeds_lra},
    tile::{Tile, history, rest, segment_contact, state},
    truss::beside,
};
use crate::collide::STEEP;
use crate::simd::lanes::{F, Mask, Row, Simd, V3, load, store};

/// Parameters of the post-solve stage.
pub struct PostSolveParams {
    /// Largest relative change of a segment's length: [`LIMIT`], or infinite for integrators that are shown
    /// without correction.
    pub limit: f32,
    /// Converts a correction into a contact force for the next solve: force over mass and depth [1/s²]; 0
    /// where contact is not part of the solve.
    pub press: f32,
    /// The share of a correction by contact that becomes velocity [1]; see [`relax`](super::relax).
    pub relaxation: f32,
    /// Whether points inside a collider are moved out.
    pub project: bool,
    /// Whether `scratch.kick` is added to the velocities.
    pub kicks: bool,
}

impl PostSolveParams {
    /// For integrators that are shown without a strain limit, and without contact in the solve.
    pub const WITHOUT_LIMIT: Self =
        Self { limit: f32::INFINITY, press: 0.0, relaxation: 1.0, project: true, kicks: true };

    /// Returns the initial contact force of the next solve for a point that is `depth` [m] inside, where the
    /// force was `force` [N].
    ///
    /// The force increases by the part of the depth that exceeds the `approach` in the substep [m]. Without
    /// projection, all of the depth counts, but is not accumulated.
    #[inline(always)]
    pub fn pressed<S: Simd>(&self, force: F<S>, mass: F<S>, depth: F<S>, approach: F<S>) -> F<S> {
        if self.project {
            force + mass * self.press * (depth - approach).max(0.0) * self.relaxation
        } else {
            force.max(mass * self.press * depth)
        }
    }
}

/// Largest relative change of a segment's length that leaves a substep [1].
pub const LIMIT: f32 = 0.01;

/// Largest number of corrections of a point in contact. Two are enough on a surface that is smooth at the
/// scale of the segment; in a crease the point alternates between the walls.
///
/// The value was found by trial, before corrections went along the walls. In a scene with a man rolling over
/// his hair, 367 of 48,000 points stayed inside with two corrections, 110 with six, and 63 with sixteen. Of
/// the hair caught between fingers, one segment was 1.1 mm deep with twelve.
pub const CORRECTIONS: usize = 24;

/// Depth of a point that is not corrected again, over its segment's length [1]: 0.1 µm for a centimeter,
/// about the precision of world coordinates in a room.
const SLACK: f32 = 1e-5;

/// The same as [`post_solve`], for the kernels that are not made for speed: they share its code, which keeps the build
/// short.
#[inline(never)]
pub fn post_solve_shared<S: Simd>(
    simd: S,
    stride: usize,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || post_solve(simd, stride, finish, step, tile, scratch),
    );
}

/// Applies strain limit and contact to every `stride`th particle of the new `scratch.edges`, and writes the
/// state.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn post_solve<S: Simd>(
    simd: S,
    stride: usize,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let inv_h = F::<S>::splat(simd, 1.0 / step.h);
    // The root and its driven particles.
    let mut at = Particle { x: V3::zero(simd), displacement: step.moved };
    for (rows, driven) in tile.state.iter_mut().zip(&*scratch.edges).take(stride + 1) {
        let edge = V3::load(simd, driven);
        at = at.on(edge, V3::load(simd, &rows[state::EDGE..]));
        edge.store(&mut rows[state::EDGE..]);
        (step.moved * inv_h).store(&mut rows[state::V..]);
    }
    // Correction of the previous point relative to the integrator's result.
    let mut shift = V3::zero(simd);
    // Where the previous point may be inside a collider, because the root drives it or because it could not get out.
    let mut buried = Mask::splat(simd, true);
    // Where the correction of the previous point was relaxed.
    let mut relaxed = Mask::splat(simd, false);
    let mut i = 2 * stride;
    while i < tile.rest.len() {
        let length = load(simd, &tile.rest[i - stride][rest::LENGTH]);
        let link = SegmentLimit { length, limit: finish.limit };
        // From the corrected position of the previous point.
        let shift_before = std::mem::replace(&mut shift, V3::zero(simd));
        let mut extra = V3::load(simd, &scratch.edges[i + 1 - stride]) - shift_before;
        let solved = if stride == 2 { extra + V3::load(simd, &scratch.edges[i]) } else { extra };
        let mut e = solved;
        // A branch: a segment depends on the previous one only where a correction is needed.
        let world = step.root.position + (at.x + e);
        let wrong = link.wrong(e) | exceeds_lra(simd, tile, i, at.x + e);
        let before = std::mem::replace(&mut buried, Mask::splat(simd, false));
        let follows = std::mem::replace(&mut relaxed, Mask::splat(simd, false));
        let mut slower = None;
        if needs_contact_test(simd, step, tile, (i, world, e)) || wrong.any_true() || follows.any_true() {
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            // Copies are passed, as for the tile. Passing the originals by reference would force the compiler
            // to keep them in memory at every point.
            let (at, link) = (at, SegmentLimit { ..link });
            let (out, inside) = resolve_contacts(
                simd,
                finish,
                step,
                &mut tile.reborrow(),
                (i, stride, e),
                (&at, &link, before),
            );
            e = V3::select(free, out, e);
            buried = inside | !free;
            let corrected = (e - solved).is_not_zero() & free;
            if finish.relaxation < 1.0 && (corrected | follows).any_true() {
                let correction = Correction { raw: solved + shift_before, solved, corrected: e, follows };
                let result = relax(
                    simd,
                    (step, finish.relaxation),
                    &tile.reborrow(),
                    (i, stride),
                    &correction,
                    (&at, &link),
                );
                e = V3::select(free, result.edge, e);
                relaxed = result.relaxed & (e - solved).is_not_zero() & free;
                slower = Some(relaxed.select(result.speed, F::splat(simd, 1.0)));
            }
            shift = e - solved;
            // A held point has no contact.
            let keep = |rows: &mut [Row]| {
                for row in rows {
                    store(free.select(load(simd, row), F::splat(simd, 0.0)), row);
                }
            };
            let rows = &mut tile.state[i];
            keep(&mut rows[state::NORMAL_FORCE..=state::NORMAL_FORCE]);
            keep(&mut rows[state::FRICTION_STRETCH..state::FRICTION_STRETCH + 3]);
            if let Some(rows) = tile.segment_contacts.get_mut(i) {
                keep(&mut rows[segment_contact::FORCE..=segment_contact::FORCE]);
                keep(&mut rows[segment_contact::FRICTION_STRETCH..]);
            }
        }
        let mut last = e;
        if stride == 2 {
            // An extra particle has no contact and almost no mass: its triangle determines its position.
            if finish.limit.is_finite() {
                let free = load(simd, &scratch.fixed[i - 1].inverse_mass).simd_gt(0.0);
                let inverse = load(simd, &scratch.fixed[i - 2].inverse_length);
                extra = V3::select(free, beside(simd, extra, e, [length, inverse]), extra);
            }
            at = write(simd, finish, step, (i - 1, &at, extra), tile, scratch);
            last = e - extra;
        }
        at = write(simd, finish, step, (i, &at, last), tile, scratch);
        if let Some(factor) = slower {
            let slow = |rows: &mut [Row]| (V3::load(simd, rows) * factor).store(rows);
            slow(&mut tile.state[i][state::V..state::V + 3]);
            if let Some(rows) = tile.history.get_mut(i) {
                slow(&mut rows[history::DISPLACEMENT..history::DISPLACEMENT + 3]);
            }
        }
        i += stride;
    }
}

/// Returns whether point `i` at world position `world`, or the segment `e` that ends there, may be inside a
/// collider.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn needs_contact_test<S: Simd>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &Tile,
    (i, world, e): (usize, V3<S>, V3<S>),
) -> bool {
    for pose in step.colliders {
        if colliders::broadphase_test(simd, pose, world).any_true() {
            return true;
        }
    }
    // A separate loop: in a common loop, the compiler would hoist the segment's computations to where they
    // are not needed.
    if !tile.segment_contacts.is_empty() {
        for pose in step.colliders {
            let tolerance = segment_tolerance(simd, tile, i, F::splat(simd, max_tolerance(pose)));
            if segment_may_intersect(simd, pose, (world, e), tolerance).any_true() {
                return true;
            }
        }
    }
    false
}

/// Returns the corrected offset `e` of point `i` from the strand's previous point `at`: within the limits of
/// its segment and outside of every collider. Also returns where it could not get out.
///
/// Where the previous point may be `buried`, the point cannot be farther out than that allows. It is moved as far out as
/// it can be, and has no contact force, which would grow without bound.
///
/// Not inlined: most segments do not need it, and otherwise each combination of model, integrator and sweep
/// would contain the code of all collider shapes.
#[inline(never)]
fn resolve_contacts<S: Simd>(
    simd: S,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    segment: (usize, usize, V3<S>),
    from: (&Particle<S>, &SegmentLimit<S>, Mask<S>),
) -> (V3<S>, Mask<S>) {
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || project_particle(simd, finish, step, tile, segment, from),
    )
}

#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn project_particle<S: Simd>(
    simd: S,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, stride, e): (usize, usize, V3<S>),
    (at, link, buried): (&Particle<S>, &SegmentLimit<S>, Mask<S>),
) -> (V3<S>, Mask<S>) {
    let friction = Friction::of(simd, step.h, tile, i);
    let clearance = load(simd, &tile.rest[i][rest::CLEARANCE]);
    let mut old = V3::load(simd, &tile.state[i][state::EDGE..]);
    if stride == 2 {
        old += V3::load(simd, &tile.state[i - 1][state::EDGE..]);
    }
    let mut press = load(simd, &tile.state[i][state::NORMAL_FORCE]);
    let mut e = link.clamp(apply_lra(simd, tile, i, (at, link), e));
    // Summed relative to the root, as in `contact`. In world coordinates far from the origin, every sum would
    // lose precision.
    let in_world = |e: V3<S>| step.root.position + (at.x + e);
    let mut left_inside = Mask::splat(simd, false);
    let passed = [passes(simd, tile, i - stride), passes(simd, tile, i)];
    for (k, pose) in step.colliders.iter().enumerate() {
        let world = in_world(e);
        let (distance, normal) = contact(simd, pose, world);
        let free = is_passed([passed[1]; 2], k);
        // Distance of the previous point, and the farthest out that this one can be.
        let mut before = F::<S>::splat(simd, f32::MAX);
        if buried.any_true() {
            before = buried.select(contact(simd, pose, step.root.position + at.x).0, before);
        }
        let allowed = clearance.min(before + link.length);
        let unreachable = allowed.simd_lt(clearance) & !free;
        let depth = free.select(F::splat(simd, 0.0), (allowed - distance).max(0.0));
        let inside = depth.simd_gt(0.0);
        let mut caught = Mask::splat(simd, false);
        if inside.any_true() {
            // Out along the normal, then back along the surface, by at most μ times the depth.
            let pushed = e + normal * depth;
            let carried = surface_displacement(simd, pose, world);
            let slide = at.displacement + (pushed - old) - carried;
            let tangent = slide - normal * normal.dot(slide);
            let rubbed = pushed - tangent * friction.share(depth, tangent.dot(tangent));
            // The part of the correction that did not stop an approach becomes a contact force in the next
            // solve (see `contact`).
            let v = V3::load(simd, &tile.state[i][state::V..]);
            let approach = normal.dot(carried - v * F::splat(simd, step.h)).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            press = finish.pressed(press, mass, depth, approach);
            // The strain limit again, then out of the collider. Both hold where possible. Where a strand is
            // caught (behind an ear), its length has priority over its depth, so that it eventually slips
            // free.
            let mut q = link.clamp(rubbed);
            let mut wall = V3::zero(simd);
            for correction in 0..=CORRECTIONS {
                let (distance, normal) = contact(simd, pose, in_world(q));
                let left = (allowed - distance).max(0.0);
                let still = inside & left.simd_gt(link.slack());
                if !still.any_true() {
                    break;
                }
                if correction == CORRECTIONS {
                    caught = still;
                    break;
                }
                let (outward, far) = out_of(simd, normal, wall);
                wall = normal;
                // Points that are out are not changed, so that their result does not depend on their
                // neighbors in the tile.
                q = V3::select(still, link.clamp(link.swing_out(q, outward, left * far)), q);
            }
            if finish.project {
                e = V3::select(inside, q, e);
            }
        }
        if !tile.segment_contacts.is_empty() {
            e = resolve_segment_contact(
                simd,
                (finish, step, pose),
                tile,
                (i, old, e),
                (at, link),
                (distance, caught, is_passed(passed, k)),
                before,
            );
        }
        press = unreachable.select(F::splat(simd, 0.0), press);
        left_inside |= caught | unreachable;
    }
    store(press, &mut tile.state[i][state::NORMAL_FORCE]);
    (e, left_inside)
}

/// Smallest sine between a wall and the way out along it. It bounds the correction of points that are caught
/// between nearly parallel walls.
const WEDGE: f32 = 0.25;

/// Returns the direction out of a surface with the normal `normal`, as a unit vector, and the distance along
/// it for each meter of depth.
///
/// `wall` is the normal of the surface that the previous correction left, or 0. Two walls that face each
/// other squarely have no common way out; the result is then the normal itself.
///
/// ```text
///    wall ╲   ↗╱ surface    straight out of one wall of a crease leads into the other and back;
///          ╲ ● ╱            moving out along the other wall satisfies both
///           ╲ ╱
/// ```
#[inline(always)]
pub fn out_of<S: Simd>(simd: S, normal: V3<S>, wall: V3<S>) -> (V3<S>, F<S>) {
    let into = wall.dot(normal).min(0.0);
    let (size, outward) = (normal - wall * into).length_and_unit();
    let (squarely, one) = (size.simd_lt(STEEP), F::<S>::splat(simd, 1.0));
    (V3::select(squarely, normal, outward), one / squarely.select(one, size.max(WEDGE)))
}

/// A particle in the sweep from root to tip.
#[derive(Clone, Copy)]
pub struct Particle<S: Simd> {
    /// Position relative to the root [m].
    pub x: V3<S>,
    /// Displacement in the substep [m].
    pub displacement: V3<S>,
}

impl<S: Simd> Particle<S> {
    /// The next particle, from the edge to it after (`edge`) and before (`old`) the substep.
    #[inline(always)]
    fn on(&self, edge: V3<S>, old: V3<S>) -> Self {
        Self { x: self.x + edge, displacement: self.displacement + (edge - old) }
    }
}

/// Stores the new edge from `before` to particle `i` and the particle's velocity. Returns the particle.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn write<S: Simd>(
    simd: S,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    (i, before, edge): (usize, &Particle<S>, V3<S>),
    tile: &mut Tile,
    scratch: &mut Scratch,
) -> Particle<S> {
    let inv_h = F::<S>::splat(simd, 1.0 / step.h);
    let at = before.on(edge, V3::load(simd, &tile.state[i][state::EDGE..]));
    let mut v = at.displacement * inv_h;
    if finish.kicks {
        v += V3::load(simd, &scratch.kick[i]);
    }
    if let Some(history) = tile.history.get_mut(i) {
        if step.second_order {
            let before = V3::load(simd, &history[history::DISPLACEMENT..]);
            v += (at.displacement - before) * (inv_h * 0.5);
        }
        V3::load(simd, &tile.state[i][state::V..]).store(&mut history[history::V..]);
        at.displacement.store(&mut history[history::DISPLACEMENT..]);
    }
    let rows = &mut tile.state[i];
    v.store(&mut rows[state::V..state::V + 3]);
    edge.store(&mut rows[state::EDGE..state::EDGE + 3]);
    edge.store(&mut scratch.edges[i]);
    at
}

/// The length limit between a point and the previous one.
pub struct SegmentLimit<S: Simd> {
    /// Rest length of the segment [m].
    pub length: F<S>,
    /// Largest relative change of the length [1].
    limit: f32,
}

impl<S: Simd> SegmentLimit<S> {
    /// Returns where the segment is too long or too short.
    #[inline(always)]
    fn wrong(&self, e: V3<S>) -> Mask<S> {
        let (size, length) = (e.dot(e), self.length * self.length);
        let (shortest, longest) = ((1.0 - self.limit).max(0.0), 1.0 + self.limit);
        size.simd_gt(length * (longest * longest)) | size.simd_lt(length * (shortest * shortest))
    }

    /// Moves the point along the segment until the length is within the limit.
    #[inline(always)]
    pub fn clamp(&self, e: V3<S>) -> V3<S> {
        let (l, u) = e.length_and_unit();
        V3::select(self.wrong(e), u * self.within(l), e)
    }

    /// Depth of a point that is not corrected again [m].
    #[inline(always)]
    pub fn slack(&self) -> F<S> {
        self.length * SLACK
    }

    /// Clamps a length to the limit.
    #[inline(always)]
    pub fn within(&self, l: F<S>) -> F<S> {
        l.min(self.length * (1.0 + self.limit)).max(self.length * (1.0 - self.limit))
    }

    /// Rotates the segment about the previous point until the point is `depth` farther out along `normal`. On
    /// a flat surface, this satisfies both the length and the contact at once. (Alternating between the two
    /// hardly moves a tip that meets the surface head on.) Where the previous point is deeper than the
    /// segment is long, the segment points straight out.
    #[inline(always)]
    pub fn swing_out(&self, e: V3<S>, normal: V3<S>, depth: F<S>) -> V3<S> {
        let (l, _) = e.length_and_unit();
        let along = e.dot(normal);
        let (_, side) = (e - normal * along).length_and_unit();
        let out = (along + depth).min(l);
        let aside = (l * l - out * out).max(0.0).sqrt();
        V3::select(depth.simd_gt(0.0), normal * out + side * aside, e)
    }
}
