//! Advances one tile through a frame. All substeps of a tile run in sequence while its points are in the L1
//! caches.
//!
//! A substep drives the root, computes new positions with the integrator, applies strain limit and contact
//! from root to tip, and updates the velocities.
//!
//! Each family of integrators has a file and kernels of its own:
//!
//! | family | use |
//! | --- | --- |
//! | [`Implicit`] | production; the kernels are in the files of the elastic models |
//! | [`explicit`], [`local_global`], [`ftl`] | comparison; each file has its kernels |

pub mod explicit;
pub mod ftl;
mod implicit;
pub mod local_global;

pub use implicit::Implicit;

use super::{
    assemble::SubstepContext,
    drag::Drag,
    frame_context::FrameContext,
    model::{Model, Stretching, stretch::CARRIED},
    post_solve::{PostSolveParams, post_solve, post_solve_shared},
    precomputed::precompute,
    root::Root,
    scratch::{Memory, Scratch},
    tile::{Tile, anisotropic_drag, multipliers, position_spring, rest, segment_contact, state},
};
use crate::simd::lanes::{F, Mask, Simd, V3, load, store};
use crate::{
    collide::{ColliderPose, ColliderShape},
    settings::Integrator,
};

/// A family of time integrators, for strands with the elastic model `M`.
pub trait Method<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize> {
    /// Stiffness of the segments' springs.
    const STRETCHING: Stretching = Stretching::Moderate;

    /// Whether the method is made for speed. Otherwise its kernels share code.
    const PRODUCTION: bool = false;

    /// Prepares the substeps of a frame.
    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn begin(_: S, _: &FrameContext, _: &Tile, _: &mut Scratch) {}

    /// Computes a substep: stores the new edges in `scratch.edges`, and returns how the substep is completed.
    fn advance(
        simd: S,
        frame: &FrameContext,
        step: &SubstepContext<S>,
        tile: &mut Tile,
        scratch: &mut Scratch,
    ) -> PostSolveParams;
}

/// Runs the substeps of `frame` that are due now, for one tile, with the method `I`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn run_tile<S, M, I, const B: usize, const N: usize>(
    simd: S,
    frame: &FrameContext,
    tile: &mut Tile,
    memory: &mut Memory,
) where
    S: Simd,
    M: Model<S, B, N>,
    I: Method<S, M, B, N>,
{
    let scratch = &mut memory.scratch(tile.rest.len());
    let tile = &mut tile.with_equal_lengths();
    precompute(simd, frame.h, I::STRETCHING, tile, scratch);
    scratch.begin(simd, tile.state);
    I::begin(simd, frame, tile, scratch);
    let (fraction, anchor) = frame.begun();
    let mut root = Root::between(simd, (tile.roots, tile.strand), fraction, anchor);
    // Driven points get the velocity of the root.
    let velocity: [_; 3] = std::array::from_fn(|k| tile.state[0][state::V + k]);
    for driven in &mut tile.state[1..M::DRIVEN] {
        driven[state::V..state::V + 3].copy_from_slice(&velocity);
    }
    let mut continues = frame.continues;
    for (number, substep) in frame.substeps[frame.now.clone()].iter().enumerate() {
        let next = Root::at(simd, (tile.roots, tile.strand), substep);
        let moved = next.position - root.position;
        root = next;
        // The solve starts with every point where the last substep left it, except for the driven segment,
        // which is already at its new position.
        let third = Root::third(simd, (tile.roots, tile.strand), substep);
        let driven = [V3::zero(simd), root.first, third - root.first];
        let mut behind = V3::zero(simd);
        for (edge, new) in scratch.edges.iter_mut().zip(driven).take(M::DRIVEN) {
            behind += new - V3::load(simd, edge);
            new.store(edge);
        }
        let next = &mut scratch.edges[M::DRIVEN];
        (V3::load(simd, next) - behind).store(next);

        let second_order = frame.integrator == Integrator::Bdf2 && continues;
        let touches = touching(simd, frame, &substep.colliders, tile);
        // Contacts between strands are forces of the substep before, and not part of the solve. Where hulls carried less,
        // single strands slipped off a stone at 5 cm/s.
        let carries_all =
            frame.hair_contact || substep.colliders.iter().any(|c| matches!(c.shape, ColliderShape::Hull(_)));
        let mut share = F::splat(simd, 1.0);
        if M::DAMPS_AT_REST && touches.any_true() && !carries_all {
            share = touches.select(carried(simd, moved, frame.h, tile), share);
        }
        let step = SubstepContext {
            number,
            left: 1.0 - substep.fraction,
            h: frame.h,
            relaxation: frame.relaxation,
            gravity: frame.gravity,
            wind: substep.wind,
            root,
            moved,
            second_order,
            touches,
            carried: share,
            colliders: &substep.colliders,
        };
        let finish = I::advance(simd, frame, &step, tile, scratch);
        if I::PRODUCTION {
            post_solve(simd, M::STRIDE, &finish, &step, tile, scratch);
        } else {
            post_solve_shared(simd, M::STRIDE, &finish, &step, tile, scratch);
        }
        continues = true;
    }
}

/// Acceleration of point `i` by gravity, external acceleration, position spring, anisotropic drag and air
/// drag [m/s²]. `u` is the unit vector of the segment that begins at the point, and `x` is its position
/// relative to the root.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn outside<S: Simd>(simd: S, step: &SubstepContext<S>, tile: &Tile, i: usize, [u, x]: [V3<S>; 2]) -> V3<S> {
    let (stride, zero) = (tile.layout.model.stride(), F::<S>::splat(simd, 0.0));
    let length = |i: usize| load(simd, &tile.rest[i][rest::LENGTH]);
    // Drag acts on the half segments adjacent to the point. Extra particles are not part of the fiber and
    // have none.
    let around = if i.is_multiple_of(stride) { (length(i - stride) + length(i)) * 0.5 } else { zero };
    let drag = tile.at_particle(Root::<S>::fiber(simd, tile.strand).0, i, multipliers::DRAG) * around
        / load(simd, &tile.rest[i][rest::MASS]);
    // Explicit integration: a larger coefficient would overshoot the velocity of the air.
    let stable = |coefficient: F<S>| (drag * coefficient).min(1.0 / step.h);
    let v = V3::load(simd, &tile.state[i][state::V..]);
    let nothing = V3::zero(simd);
    let air = tile.wind_delta.get(i).map_or(nothing, |air| V3::load(simd, air));
    let slip = V3::splat(simd, step.wind) + air - v;
    let coefficients = Drag::new(simd, tile.strand, &tile.rest[i], slip, u);
    let (across, along) = (stable(coefficients.across), stable(coefficients.along));
    let dragged = slip * across + u * (u.dot(slip) * (along - across));
    let push = tile.external_acceleration.get(i).map_or(nothing, |push| V3::load(simd, push));
    let free = dragged + V3::splat(simd, step.gravity) + push;
    if tile.position_spring.is_empty() && tile.anisotropic_drag.is_empty() {
        return free;
    }
    let (h, one) = (F::<S>::splat(simd, step.h), F::<S>::splat(simd, 1.0));
    let (mut pulled, mut yielding) = (free, one);
    if let Some(rows) = tile.position_spring.get(i) {
        let (stiffness, brake) =
            (load(simd, &rows[position_spring::STIFFNESS]), load(simd, &rows[position_spring::BRAKE]));
        let late = V3::load(simd, &rows[position_spring::DISPLACEMENT..]) * F::splat(simd, step.left);
        pulled = pulled - late - (x + v * h - step.moved) * stiffness - v * brake;
        yielding += (stiffness * h + brake) * h;
    }
    if let Some(rows) = tile.anisotropic_drag.get(i) {
        let brake = load(simd, &rows[anisotropic_drag::BRAKE]);
        let slip = V3::load(simd, &rows[anisotropic_drag::ACCELERATION..]) - v * brake;
        pulled += slip - u * u.dot(slip);
        yielding += brake * h;
    }
    // The spring and the drag are implicit for each point by itself. Otherwise, methods with time steps as
    // long as the implicit integrators' would be unstable with stiff position springs.
    pulled * (one / yielding)
}

/// How long a strand still counts as touching after its last contact [s]. Found by trial: every value from
/// 0.05 to 0.25 keeps hair on thin rods.
const CONTACT_MEMORY: f32 = 0.1;

/// Speed relative to the root below which a strand in contact is coming to rest [m/s]. Strands tremble at up to 0.01
/// where all of a force is carried.
const RESTING_SPEED: f32 = 0.02;

/// Returns the share of the force of a stretch spring that becomes tension in a strand in contact [1]: from [`CARRIED`]
/// at rest to 1 where its fastest point moves at [`RESTING_SPEED`] relative to the root, which moved by `moved` [m] in
/// the substep of `h` [s].
#[inline(always)]
fn carried<S: Simd>(simd: S, moved: V3<S>, h: f32, tile: &Tile) -> F<S> {
    let root = moved * F::splat(simd, 1.0 / h);
    let mut most = F::<S>::splat(simd, 0.0);
    for rows in tile.state.iter() {
        let v = V3::load(simd, &rows[state::V..]) - root;
        most = most.max(v.dot(v));
    }
    let one = F::<S>::splat(simd, 1.0);
    let rests = most.mul_add(-1.0 / (RESTING_SPEED * RESTING_SPEED), one).max(0.0);
    rests.mul_add(CARRIED - 1.0, one)
}

/// Returns the strands that touch a collider or are gripped, or did so within the last [`CONTACT_MEMORY`] seconds;
/// all strands if any strands touch each other.
///
/// A contact may push a point away, and the point soon returns. In between, its motion is damped as in
/// contact. Otherwise it would gain speed from each bounce.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn touching<S: Simd>(simd: S, frame: &FrameContext, colliders: &[ColliderPose], tile: &mut Tile) -> Mask<S> {
    let mut most = F::<S>::splat(simd, if frame.hair_contact { 1.0 } else { 0.0 });
    if !colliders.is_empty() {
        for rows in tile.state.iter() {
            most = most.max(load(simd, &rows[state::NORMAL_FORCE]));
        }
        for rows in tile.segment_contacts.iter() {
            most = most.max(load(simd, &rows[segment_contact::FORCE]));
        }
    }
    for rows in tile.position_spring {
        most = most.max(load(simd, &rows[position_spring::STIFFNESS]));
    }
    let zero = F::<S>::splat(simd, 0.0);
    let left = (load(simd, tile.contact_age) - frame.h).max(0.0);
    let left = most.simd_gt(zero).select(F::splat(simd, CONTACT_MEMORY), left);
    store(left, tile.contact_age);
    most.simd_gt(zero) | left.simd_gt(zero)
}
