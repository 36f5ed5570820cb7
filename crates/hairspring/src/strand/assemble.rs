//! Assembly and elimination of a strand's linear system in one downward sweep, from root to tip.
//!
//! The system contains elasticity from the model, stretch, mass, air drag, gravity, external forces and
//! contact. Positions are relative to the root. δ is the change of a position, and Δr is the displacement of
//! the root:
//!
//! ```text
//! (a M/h² + D/h + K) δ = M p + D (w − Δr/h) + M g + f(x)
//!
//! backward Euler   a = 1     p = (v − Δr/h) / h                                v⁺ = Δ/h,              Δ = δ + Δr
//! BDF2             a = 9/4   p = (4v − v⁻)/2h + 3Δ⁻/4h² − 9Δr/4h²              v⁺ = (3Δ − Δ⁻) / 2h
//! ```
//!
//! With relative positions, a teleporting root adds no strain to the linearization, and no digits are lost
//! far from the origin of the world.
//!
//! The unknown is not δ but its difference from the predicted displacement δ₀ = h (v − v_root). The force
//! that each element produces at δ₀ goes to the right-hand side. The rounding error of a stiff entry then
//! scales with the change of a velocity, not with the velocity itself. In strands of a thousand points, that
//! error is as large as the mass term. With δ as the unknown, it accelerated such strands to 10 to 70 m/s at
//! rest.
//!
//! Baraff & Witkin 1998, *Large Steps in Cloth Simulation*; BDF2 after Choi & Ko 2002, *Stable but Responsive
//! Cloth*, eq. 17.

use super::{
    band::Band,
    drag::Drag,
    elements::{AssemblyCursor, Elements, PredictedState},
    external,
    model::Model,
    prefetch::prefetch_next_tile,
    root::Root,
    scratch::Scratch,
    system::System,
    tile::{Tile, history, state},
};
use crate::collide::ColliderPose;
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3};
use glam::Vec3;

/// The state of one substep that the assembly of one tile needs.
#[derive(Clone, Copy)]
pub struct SubstepContext<'a, S: Simd> {
    /// Index of the substep in the frame.
    pub number: usize,
    /// Fraction of the frame that remains at the end of the substep.
    pub left: f32,
    /// Length [s].
    pub h: f32,
    /// The share of a correction by contact that becomes velocity [1]; see [`relax`](super::relax).
    pub relaxation: f32,
    /// Gravity [m/s²].
    pub gravity: Vec3,
    /// Velocity of the air [m/s].
    pub wind: Vec3,
    /// The root at the end of the substep.
    pub root: Root<S>,
    /// Displacement of the root in the substep [m].
    pub moved: V3<S>,
    /// Whether the tile's history comes from a substep of the same length. If so, the substep uses BDF2,
    /// otherwise backward Euler.
    pub second_order: bool,
    /// Strands that are in contact.
    pub touches: Mask<S>,
    /// The share of the force of a stretch spring that becomes tension [1]; see
    /// [`stretch::CARRIED`](super::model::stretch::CARRIED).
    pub carried: F<S>,
    /// Colliders, each with its pose at the start and at the end of the substep.
    pub colliders: &'a [ColliderPose],
}

impl<S: Simd> SubstepContext<'_, S> {
    /// The inertia coefficient a of the system in the module documentation.
    #[inline(always)]
    pub fn inertia(&self) -> f32 {
        if self.second_order { 2.25 } else { 1.0 }
    }
}

/// Computes the elastic forces on all points at `scratch.edges` and stores them in `scratch.kick` [N].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn forces<S, M, const B: usize, const N: usize>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let n = tile.rest.len();
    let mut elements = Elements::<S, M, B, N>::begin(simd, Linearization::Forces, step, tile, scratch);
    for i in 0..n {
        if i + 1 < n {
            elements.add_forces(simd, i, tile, scratch);
        } else {
            elements.band = Band::new(simd);
        }
        elements.band.load_pending(simd, M::PROFILE, i, scratch.factors);
        elements.band.force().store(&mut scratch.kick[i]);
        elements.band.skip_row(simd, M::PROFILE, i, scratch.factors);
    }
}

/// What a downward sweep computes, and where it linearizes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Linearization {
    /// Forces only, without factors.
    Forces,
    /// Factors of the system at the start of the substep.
    Initial,
    /// Factors of the system at the positions of the last Newton iterate.
    Newton,
}

impl Linearization {
    /// The share of a segment's current length error that the solve adds to its tension [1]: 1 in the first
    /// solve, 0 in the following ones, because the first has already added it.
    pub fn length_error_share(self) -> f32 {
        if self == Self::Newton { 0.0 } else { 1.0 }
    }

    /// The time that velocities act before the starting point of the solve [s], in a substep of `h` [s].
    pub fn prediction_time(self, h: f32) -> f32 {
        if self == Self::Initial { h } else { 0.0 }
    }
}

/// Assembles and eliminates the system from root to tip, linearized at `scratch.edges`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn assemble<S, M, const B: usize, const N: usize>(
    simd: S,
    sweep: Linearization,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let n = tile.rest.len();
    let has_external_terms = external::any(tile);
    // The driven points and the tip are handled outside the loop, so that the loop has no special cases.
    let suspended = pass_driven_points::<S, M, B, N>(
        simd,
        sweep,
        step,
        &mut tile.reborrow(),
        &mut scratch.reborrow(),
        has_external_terms,
    );
    let mut elements = Elements::<S, M, B, N>::resume(simd, suspended);
    let mut i = first_in_loop::<S, M, B, N>();
    // Not `i + STRIDE < n`: from that, the compiler cannot infer that i + 1 is below n.
    while i < n.saturating_sub(M::STRIDE) {
        pass_point(simd, (sweep, i, 0, false), step, tile, scratch, &mut elements, has_external_terms);
        if M::STRIDE == 2 {
            pass_point(
                simd,
                (sweep, i + 1, 1, false),
                step,
                tile,
                scratch,
                &mut elements,
                has_external_terms,
            );
        }
        i += M::STRIDE;
    }
    elements.band = Band::new(simd);
    elements.band.eliminate(simd, M::PROFILE, n - 1, scratch.factors);
}

/// Index of the first point that the root does not drive.
#[inline(always)]
pub fn first_in_loop<S: Simd, M: Model<S, B, N>, const B: usize, const N: usize>() -> usize {
    M::DRIVEN.next_multiple_of(M::STRIDE)
}

/// Starts the sweep, and passes the points that the root drives.
///
/// Not inlined: it runs once a strand, so the call is cheap. Inlined, these few points would be a large part of the kernel's
/// code.
#[inline(never)]
fn pass_driven_points<S, M, const B: usize, const N: usize>(
    simd: S,
    sweep: Linearization,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
    has_external_terms: bool,
) -> (M, AssemblyCursor<S>)
where
    S: Simd,
    M: Model<S, B, N>,
{
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || {
            let mut elements = Elements::<S, M, B, N>::begin(simd, sweep, step, tile, scratch);
            // The number of points is not a constant, so that the loop is not unrolled. No strand has fewer.
            let count = first_in_loop::<S, M, B, N>().min(tile.rest.len() - 1);
            for i in 0..count {
                pass_point(
                    simd,
                    (sweep, i, i % M::STRIDE, true),
                    step,
                    tile,
                    scratch,
                    &mut elements,
                    has_external_terms,
                );
            }
            elements.suspend()
        },
    )
}

/// Adds all elements that begin at the current point i and all forces on point i+1, then eliminates point i.
/// `phase` is i modulo the model's stride. `driven` is set for the points next to the root.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn pass_point<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, i, phase, driven): (Linearization, usize, usize, bool),
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
    elements: &mut Elements<S, M, B, N>,
    has_external_terms: bool,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    if has_external_terms || external::pressed(simd, M::STRIDE, i, tile) {
        let AssemblyCursor { x, displacement, root_velocity, .. } = elements.cursor;
        let place = external::Place { i, x, displacement, root_velocity };
        external::add::<S, M, B, N>(
            simd,
            (sweep, step),
            &place,
            &mut tile.reborrow(),
            &mut scratch.reborrow(),
        );
    }
    // Evaluated before `add_point`, so that the data it loads is in the cache for what follows.
    let has_altitude_spring = M::has_altitude_spring(simd, i, tile, scratch);
    add_point(simd, (sweep, i, phase), step, tile, scratch, elements);
    eliminate(simd, (i, driven), scratch, elements);
    if has_altitude_spring {
        eliminate_altitude_spring::<S, M, B, N>(simd, (sweep, step), i, tile, &mut scratch.reborrow());
    }
}

/// Eliminates the force of the spring that spans the four points from `i` on.
#[inline(never)]
fn eliminate_altitude_spring<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, step): (Linearization, &SubstepContext<S>),
    i: usize,
    tile: &Tile,
    scratch: &mut Scratch,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    simd.vectorize(
        #[inline(always)]
        || {
            let spring = M::altitude_spring(simd, (step.h, sweep.prediction_time(step.h)), i, tile, scratch);
            scratch.altitude_springs.push(spring.eliminate(simd, M::PROFILE, i, scratch.factors));
        },
    );
}

/// Eliminates point i unless the root drives it.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn eliminate<S, M, const B: usize, const N: usize>(
    simd: S,
    (i, driven): (usize, bool),
    scratch: &mut Scratch,
    elements: &mut Elements<S, M, B, N>,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let band = &mut elements.band;
    // The angle of the first segment is driven as well; that of the second is free.
    let angle = driven && i == 1 && B > 3;
    if angle {
        band.load_pending(simd, M::PROFILE, i, scratch.factors);
        for k in 0..3 {
            band.hold(simd, k);
        }
    }
    if driven && !angle && i < M::DRIVEN {
        band.skip_row(simd, M::PROFILE, i, scratch.factors);
    } else {
        band.eliminate(simd, M::PROFILE, i, scratch.factors);
    }
}

/// Adds all elements that begin at point i, and all forces on point i+1 except those that act on few points.
/// `phase` is i modulo the model's stride.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
fn add_point<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, i, phase): (Linearization, usize, usize),
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
    elements: &mut Elements<S, M, B, N>,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    let segment = elements.add(simd, i, phase, tile, scratch);
    if sweep == Linearization::Newton {
        let old = V3::load(simd, &tile.state[i + 1][state::EDGE..]);
        elements.cursor.displacement += V3::load(simd, &scratch.edges[i + 1]) - old;
    }
    let Elements { band, cursor: AssemblyCursor { displacement, root_velocity, ambient, .. }, .. } = elements;
    let (displacement, root_velocity) = (*displacement, *root_velocity);
    prefetch_next_tile(tile.rest, i, step.number);
    prefetch_next_tile(tile.state, i, 2 * step.number);
    prefetch_next_tile(tile.state, i, 2 * step.number + 1);
    prefetch_next_tile(tile.segment_contacts, i, step.number);

    // Mass, air and gravity of point i+1.
    let inv_h = 1.0 / step.h;
    let mass = segment.mass;
    let v = V3::load(simd, &tile.state[i + 1][state::V..]);
    let (a, inv_h2) = (step.inertia(), inv_h * inv_h);
    let m_h2 = mass * (a * inv_h2);
    let predicted = PredictedState {
        sweep,
        faster: v - root_velocity,
        share: sweep.prediction_time(step.h),
        displacement,
    };
    // p minus a/h² times the displacement so far, plus gravity.
    let mut p = if step.second_order {
        let before = &tile.history[i + 1];
        let v_before = V3::load(simd, &before[history::V..]);
        let displacement_before = V3::load(simd, &before[history::DISPLACEMENT..]);
        V3::splat(simd, step.gravity)
            + (v * F::splat(simd, 4.0) - v_before) * F::splat(simd, 0.5 * inv_h)
            + (displacement_before * F::splat(simd, 3.0) - step.moved * F::splat(simd, 9.0))
                * F::splat(simd, 0.25 * inv_h2)
            - predicted.displacement(simd) * F::splat(simd, a * inv_h2)
    } else if sweep == Linearization::Initial {
        ambient.pull
    } else {
        ambient.pull
            + (v - root_velocity - predicted.displacement(simd) * F::splat(simd, inv_h))
                * F::splat(simd, inv_h)
    };
    if let Some(push) = tile.external_acceleration.get(i + 1) {
        p += V3::load(simd, push);
    }
    let mut right = p * mass;
    band.add_identity(1, m_h2);
    if phase + 1 == M::STRIDE {
        let u = segment.u;
        let local = tile.wind_delta.get(i + 1).map_or(V3::zero(simd), |air| V3::load(simd, air));
        let drag = Drag::new(simd, tile.strand, &tile.rest[i + 1], V3::splat(simd, step.wind) + local - v, u);
        let (across, along) = (segment.air * drag.across, segment.air * drag.along);
        let moving = if sweep == Linearization::Initial {
            v
        } else {
            root_velocity + predicted.displacement(simd) * F::splat(simd, inv_h)
        };
        let slip = ambient.wind + local - moving;
        right += slip * across + u * (u.dot(slip) * (along - across));
        band.add_diagonal(1, Sym3::outer(u, (along - across) * inv_h).add_identity(across * inv_h));
    }
    band.add_force(1, right);
}
