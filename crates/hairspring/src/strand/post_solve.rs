//! The last word on a substep: no segment longer or shorter than ±1 %, no point inside a collider and no segment (`segment`), and then the
//! velocities.
//!
//! One sweep from root to tip. Each segment is clamped to its rest length ± [`LIMIT`] by moving the outer point (follow the
//! leader, Müller 2012, but only past the limit); a point inside a collider moves to the nearest free position with
//! the inward motion removed (Liu 2013) and is held back along the surface by Coulomb friction, up to μ times the push. In the
//! implicit integrators that is for what the solve could not know: points that land, and what projection pushed in (see `contact`).

use super::{
    assemble::SubstepContext,
    colliders::{self, contact, segment_may_intersect, surface_displacement},
    friction::Friction,
    scratch::Scratch,
    segment::{resolve_segment_contact, segment_tolerance},
    tether::{apply_lra, exceeds_lra},
    tile::{Tile, history, rest, segment_contact, state},
    truss::beside,
};
use crate::collide::STEEP;
use crate::simd::lanes::{F, Mask, Simd, V3, load, store};

/// What a substep leaves behind besides positions.
pub struct PostSolveParams {
    /// Largest relative change of a segment's length: [`LIMIT`], or infinite for integrators that are shown as they are.
    pub limit: f32,
    /// Force over mass that a push into the next solve is worth, over its length [1/s²]; 0 where contact is not in the solve.
    pub press: f32,
    /// Whether what is inside of a collider moves out.
    pub project: bool,
    /// Whether `scratch.kick` is added to the velocities.
    pub kicks: bool,
}

impl PostSolveParams {
    /// The force [N] with which the next solve begins to press what is `depth` inside, where `force` pressed before: by what of the depth did not
    /// stop an approach by so much in the substep [m]; by all of it, once, where nothing else answers it.
    #[inline(always)]
    pub fn pressed<S: Simd>(&self, force: F<S>, mass: F<S>, depth: F<S>, approach: F<S>) -> F<S> {
        if self.project {
            force + mass * self.press * (depth - approach).max(0.0)
        } else {
            force.max(mass * self.press * depth)
        }
    }
}

/// Largest relative change of a segment's length that leaves a substep [1].
pub const LIMIT: f32 = 0.01;

/// Most times that a point in contact swings out of the collider. On what is round for its segment's length two are enough; in a crease it goes from
/// wall to wall. By trial, before it went along them: where a man rolls over his hair, 367 points of 48,000 stayed inside with two, 110 with six, 63 with sixteen;
/// of what is caught between fingers a segment was 1.1 mm deep with twelve.
pub const CORRECTIONS: usize = 24;

/// How deep a point may be that is not corrected again, over its segment's length [1]: 0.1 µm for a centimetre, as fine as places in a room are told.
const SLACK: f32 = 1e-5;

/// Applies strain limit and contact to the new `scratch.edges`, of every `stride`th particle, and writes state.
#[inline(always)]
pub fn post_solve<S: Simd>(
    simd: S,
    stride: usize,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let inv_h = F::<S>::splat(simd, 1.0 / step.h);
    // The root itself, and what it drives.
    let mut at = Particle { x: V3::zero(simd), way: step.moved };
    for (rows, driven) in tile.state.iter_mut().zip(&*scratch.edges).take(stride + 1) {
        let edge = V3::load(simd, driven);
        at = at.on(edge, V3::load(simd, &rows[state::EDGE..]));
        edge.store(&mut rows[state::EDGE..]);
        (step.moved * inv_h).store(&mut rows[state::V..]);
    }
    // By how much the point before is elsewhere than the integrator had it.
    let mut shift = V3::zero(simd);
    let mut i = 2 * stride;
    while i < tile.rest.len() {
        let length = load(simd, &tile.rest[i - stride][rest::LENGTH]);
        let link = SegmentLimit { length, limit: finish.limit };
        // From the strand's point before, wherever that is now.
        let mut extra = V3::load(simd, &scratch.edges[i + 1 - stride]) - shift;
        let solved = if stride == 2 { extra + V3::load(simd, &scratch.edges[i]) } else { extra };
        let mut e = solved;
        shift = V3::zero(simd);
        // A branch, so that a segment waits for the one before it only where something is to be done.
        let world = step.root.position + (at.x + e);
        let wrong = link.wrong(e) | exceeds_lra(simd, tile, i, at.x + e);
        if needs_contact_test(simd, step, tile, (i, world, e)) || wrong.any_true() {
            let free = load(simd, &scratch.fixed[i].inverse_mass).simd_gt(0.0);
            // Copies are lent, as of the tile: what is lent itself would wait in memory at every point.
            let (at, link) = (at, SegmentLimit { ..link });
            e = V3::select(
                free,
                resolve_contacts(simd, finish, step, &mut tile.reborrow(), (i, stride, e), (&at, &link)),
                e,
            );
            shift = e - solved;
            let press = &mut tile.state[i][state::NORMAL_FORCE];
            store(free.select(load(simd, press), F::splat(simd, 0.0)), press);
            if let Some(rows) = tile.segment_contacts.get_mut(i) {
                let force = &mut rows[segment_contact::FORCE];
                store(free.select(load(simd, force), F::splat(simd, 0.0)), force);
            }
        }
        let mut last = e;
        if stride == 2 {
            // An extra particle meets nothing and weighs next to nothing: it goes where its triangle puts it.
            if finish.limit.is_finite() {
                let free = load(simd, &scratch.fixed[i - 1].inverse_mass).simd_gt(0.0);
                let inverse = load(simd, &scratch.fixed[i - 2].inverse_length);
                extra = V3::select(free, beside(simd, extra, e, [length, inverse]), extra);
            }
            at = write(simd, finish, step, (i - 1, &at, extra), tile, scratch);
            last = e - extra;
        }
        at = write(simd, finish, step, (i, &at, last), tile, scratch);
        i += stride;
    }
}

/// Whether point `i`, which is at `world`, or the segment `e` to it may be inside of a collider.
#[inline(always)]
fn needs_contact_test<S: Simd>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &Tile,
    (i, world, e): (usize, V3<S>, V3<S>),
) -> bool {
    for pose in step.obstacles {
        if colliders::broadphase_test(simd, pose, world).any_true() {
            return true;
        }
    }
    // A loop by itself: the compiler would take what the segment alone asks for out of one, and work it out where it is not asked for.
    if !tile.segment_contacts.is_empty() {
        let tolerance = segment_tolerance(simd, tile, i);
        for pose in step.obstacles {
            if segment_may_intersect(simd, pose, (world, e), tolerance).any_true() {
                return true;
            }
        }
    }
    false
}

/// Where point `i` may be that is at `e` from the strand's point before, which is `at`: within the limits of its segment, outside of every
/// collider.
///
/// A function by itself, for all models, integrators and sweeps: most segments need none, and all shapes that there are would else be in each of them.
#[inline(never)]
fn resolve_contacts<S: Simd>(
    simd: S,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    segment: (usize, usize, V3<S>),
    from: (&Particle<S>, &SegmentLimit<S>),
) -> V3<S> {
    simd.vectorize(
        #[inline(always)]
        || project_particle(simd, finish, step, tile, segment, from),
    )
}

#[inline(always)]
fn project_particle<S: Simd>(
    simd: S,
    finish: &PostSolveParams,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, stride, e): (usize, usize, V3<S>),
    (at, link): (&Particle<S>, &SegmentLimit<S>),
) -> V3<S> {
    let friction = Friction::of(simd, step.h, tile.strand);
    let clearance = load(simd, &tile.rest[i][rest::CLEARANCE]);
    let mut old = V3::load(simd, &tile.state[i][state::EDGE..]);
    if stride == 2 {
        old += V3::load(simd, &tile.state[i - 1][state::EDGE..]);
    }
    let mut press = load(simd, &tile.state[i][state::NORMAL_FORCE]);
    let mut e = link.clamp(apply_lra(simd, tile, i, (at, link), e));
    // Summed from the root, like in `contact`: far from the world's origin a sum there would lose digits at every point.
    let in_world = |e: V3<S>| step.root.position + (at.x + e);
    for pose in step.obstacles {
        let world = in_world(e);
        let (distance, normal) = contact(simd, pose, world);
        let depth = (clearance - distance).max(0.0);
        let inside = depth.simd_gt(0.0);
        let mut caught = Mask::splat(simd, false);
        if inside.any_true() {
            // Out along the normal; then back along the surface, at most μ times as far.
            let pushed = e + normal * depth;
            let carried = surface_displacement(simd, pose, world);
            let slide = at.way + (pushed - old) - carried;
            let tangent = slide - normal * normal.dot(slide);
            let held = pushed - tangent * friction.share(depth, tangent.dot(tangent));
            // What of the push did not stop an approach presses on in the next solve (see `contact`).
            let v = V3::load(simd, &tile.state[i][state::V..]);
            let approach = normal.dot(carried - v * F::splat(simd, step.h)).max(0.0);
            let mass = load(simd, &tile.rest[i][rest::MASS]);
            press = finish.pressed(press, mass, depth, approach);
            // The limit again, then out: both hold where they can, and where a strand is caught (behind an
            // ear) its length goes before its depth, so that it slips free in time.
            let mut q = link.clamp(held);
            let mut wall = V3::zero(simd);
            for correction in 0..=CORRECTIONS {
                let (distance, normal) = contact(simd, pose, in_world(q));
                let left = (clearance - distance).max(0.0);
                let still = inside & left.simd_gt(link.slack());
                if !still.any_true() {
                    break;
                }
                if correction == CORRECTIONS {
                    caught = still;
                    break;
                }
                let (way, far) = out_of(simd, normal, wall);
                wall = normal;
                // What is out keeps its bits, whatever its neighbours in the tile do.
                q = V3::select(still, link.clamp(link.swing_out(q, way, left * far)), q);
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
                (distance, caught),
            );
        }
    }
    store(press, &mut tile.state[i][state::NORMAL_FORCE]);
    e
}

/// Least sine between a wall and the way out along it: what is caught between walls that are more nearly parallel is not thrown out of them.
const WEDGE: f32 = 0.25;

/// The way out of a surface with that `normal`, a unit vector, and how far that is for each metre of depth; for what was moved out of another just before,
/// whose normal `wall` is, 0 if there was none. Walls that face each other squarely have no way along both: straight out of the one it is.
///
/// ```text
///    wall ╲   ↗╱ surface    straight out of one wall of a crease leads into the other, and back:
///          ╲ ● ╱            out along that other, both hold
///           ╲ ╱
/// ```
#[inline(always)]
pub fn out_of<S: Simd>(simd: S, normal: V3<S>, wall: V3<S>) -> (V3<S>, F<S>) {
    let into = wall.dot(normal).min(0.0);
    let (size, way) = (normal - wall * into).length_and_unit();
    let (squarely, one) = (size.simd_lt(STEEP), F::<S>::splat(simd, 1.0));
    (V3::select(squarely, normal, way), one / squarely.select(one, size.max(WEDGE)))
}

/// A particle on the walk from root to tip.
#[derive(Clone, Copy)]
pub struct Particle<S: Simd> {
    /// Where it is, from the root [m].
    pub x: V3<S>,
    /// How far it went in the substep [m].
    pub way: V3<S>,
}

impl<S: Simd> Particle<S> {
    /// The particle after this one, by the edge to it and what that was before the substep.
    #[inline(always)]
    fn on(&self, edge: V3<S>, old: V3<S>) -> Self {
        Self { x: self.x + edge, way: self.way + (edge - old) }
    }
}

/// Writes the new edge to particle `i` from the one before, which is `before`, and its velocity; returns where it is.
#[inline(always)]
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
    let mut v = at.way * inv_h;
    if finish.kicks {
        v += V3::load(simd, &scratch.kick[i]);
    }
    if let Some(history) = tile.history.get_mut(i) {
        if step.second_order {
            let before = V3::load(simd, &history[history::WAY..]);
            v += (at.way - before) * (inv_h * 0.5);
        }
        V3::load(simd, &tile.state[i][state::V..]).store(&mut history[history::V..]);
        at.way.store(&mut history[history::WAY..]);
    }
    let rows = &mut tile.state[i];
    v.store(&mut rows[state::V..state::V + 3]);
    edge.store(&mut rows[state::EDGE..state::EDGE + 3]);
    edge.store(&mut scratch.edges[i]);
    at
}

/// What holds a point to the one before it, from which it is at `e`.
pub struct SegmentLimit<S: Simd> {
    /// Rest length of the segment [m].
    pub length: F<S>,
    /// Largest relative change of it.
    limit: f32,
}

impl<S: Simd> SegmentLimit<S> {
    /// Where the segment is too long or too short.
    #[inline(always)]
    fn wrong(&self, e: V3<S>) -> Mask<S> {
        let (size, length) = (e.dot(e), self.length * self.length);
        let (shortest, longest) = ((1.0 - self.limit).max(0.0), 1.0 + self.limit);
        size.simd_gt(length * (longest * longest)) | size.simd_lt(length * (shortest * shortest))
    }

    /// The point moved along the segment until its length is within the limit.
    #[inline(always)]
    pub fn clamp(&self, e: V3<S>) -> V3<S> {
        let (l, u) = e.length_and_unit();
        V3::select(self.wrong(e), u * self.within(l), e)
    }

    /// How deep a point may be that is not corrected again [m].
    #[inline(always)]
    pub fn slack(&self) -> F<S> {
        self.length * SLACK
    }

    /// The nearest length that is within the limit.
    #[inline(always)]
    pub fn within(&self, l: F<S>) -> F<S> {
        l.min(self.length * (1.0 + self.limit)).max(self.length * (1.0 - self.limit))
    }

    /// The point swung about the point before until it is `depth` farther out along `normal`: for a flat surface both its length and the surface
    /// hold at once. (Out and back in turn hardly moves a tip that meets the surface head on.) Where the point before is deeper than the
    /// segment is long, it points straight out.
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
