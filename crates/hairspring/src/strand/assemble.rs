//! A strand's system, assembled and eliminated in one sweep down: elasticity from the model, then stretch, mass, air, gravity,
//! what holds a point from outside and what it is pressed against. With positions relative to the root, δ their change, Δr the root's own:
//!
//! ```text
//! (a M/h² + D/h + K) δ = M p + D (w − Δr/h) + M g + f(x)
//!
//! backward Euler   a = 1     p = (v − Δr/h) / h                                v⁺ = Δ/h,              Δ = δ + Δr
//! BDF2             a = 9/4   p = (4v − v⁻)/2h + 3Δ⁻/4h² − 9Δr/4h²              v⁺ = (3Δ − Δ⁻) / 2h
//! ```
//!
//! so a teleporting root puts no strain into the linearisation, and far from the world's origin no digit is lost. What is solved for is
//! not δ but by how much it differs from the drift δ₀ = h (v − v_root): element by element, what a force makes of δ₀ goes to the right.
//! So the rounding of a stiff entry multiplies the change of a velocity and not the velocity. (It weighs as much as the mass in
//! strands of a thousand points, where it pushed or braked them: 10 to 70 m/s at rest.)
//!
//! Baraff & Witkin 1998, *Large Steps in Cloth Simulation*; BDF2 after Choi & Ko 2002, *Stable but Responsive Cloth*, eq. 17.

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

/// One substep of one tile, as the assembly needs it.
#[derive(Clone, Copy)]
pub struct SubstepContext<'a, S: Simd> {
    /// Which it is of the interval's.
    pub number: usize,
    /// Fraction of the interval that is left at its end.
    pub left: f32,
    /// Length [s].
    pub h: f32,
    /// Gravity [m/s²].
    pub gravity: Vec3,
    /// Velocity of the air [m/s].
    pub wind: Vec3,
    /// The root at the end.
    pub root: Root<S>,
    /// How far the root moves in it [m].
    pub moved: V3<S>,
    /// Whether the tile's history stands for a substep of the same length: then by BDF2, else by backward Euler.
    pub second_order: bool,
    /// Which strands touch something.
    pub touches: Mask<S>,
    /// Colliders, each at the start and the end of it.
    pub obstacles: &'a [ColliderPose],
}

impl<S: Simd> SubstepContext<'_, S> {
    /// a of the system above.
    #[inline(always)]
    pub fn inertia(&self) -> f32 {
        if self.second_order { 2.25 } else { 1.0 }
    }
}

/// Elastic forces of all points at `scratch.edges`, into `scratch.kick` [N].
#[inline(always)]
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

/// What a sweep down makes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Linearization {
    /// Forces, and no factors.
    Forces,
    /// The factors of the system at the start of the substep.
    Initial,
    /// The factors of the system at positions that have moved since (Newton).
    Newton,
}

impl Linearization {
    /// How much of a segment's present error of length is news to its tension: all, or nothing once a solve has taken it.
    pub fn news(self) -> f32 {
        if self == Self::Newton { 0.0 } else { 1.0 }
    }

    /// How long velocities act until where the solve begins, of a substep of `h` [s].
    pub fn predicted_displacement(self, h: f32) -> f32 {
        if self == Self::Initial { h } else { 0.0 }
    }
}

/// Assembles and eliminates down the strand, at `scratch.edges`.
#[inline(always)]
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
    let mut elements = Elements::<S, M, B, N>::begin(simd, sweep, step, tile, scratch);
    let acted = external::any(tile);
    let first = M::DRIVEN.next_multiple_of(M::STRIDE);
    // The driven points and the last by themselves: the loop between knows nothing of them.
    for i in 0..first {
        pass_point(simd, (sweep, i, i % M::STRIDE, true), step, tile, scratch, &mut elements, acted);
    }
    let mut i = first;
    // Not `i + STRIDE < n`, from which the compiler does not learn that i + 1 is below n.
    while i < n.saturating_sub(M::STRIDE) {
        pass_point(simd, (sweep, i, 0, false), step, tile, scratch, &mut elements, acted);
        if M::STRIDE == 2 {
            pass_point(simd, (sweep, i + 1, 1, false), step, tile, scratch, &mut elements, acted);
        }
        i += M::STRIDE;
    }
    elements.band = Band::new(simd);
    elements.band.eliminate(simd, M::PROFILE, n - 1, scratch.factors);
}

/// Adds everything that begins at the walk's next point i, and what acts on point i+1, and eliminates point i; `phase` is i modulo the model's stride, and
/// `driven` tells the points by the root.
#[inline(always)]
fn pass_point<S, M, const B: usize, const N: usize>(
    simd: S,
    (sweep, i, phase, driven): (Linearization, usize, usize, bool),
    step: &SubstepContext<S>,
    tile: &mut Tile,
    scratch: &mut Scratch,
    elements: &mut Elements<S, M, B, N>,
    acted: bool,
) where
    S: Simd,
    M: Model<S, B, N>,
{
    if acted || external::pressed(simd, M::STRIDE, i, tile) {
        let AssemblyCursor { x, way, root_velocity, .. } = elements.walk;
        let place = external::Place { i, x, way, root_velocity };
        external::add::<S, M, B, N>(
            simd,
            (sweep, step),
            &place,
            &mut tile.reborrow(),
            &mut scratch.reborrow(),
        );
    }
    // Asked here, so that what it looks at is at hand for what follows.
    let acts_across = M::acts_across(simd, i, tile, scratch);
    add_point(simd, (sweep, i, phase), step, tile, scratch, elements);
    eliminate(simd, (i, driven), scratch, elements);
    if acts_across {
        eliminate_across::<S, M, B, N>(simd, (sweep, step), i, tile, &mut scratch.reborrow());
    }
}

/// Eliminates the force of the spring across the four points from `i` on, by itself.
#[inline(never)]
fn eliminate_across<S, M, const B: usize, const N: usize>(
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
            let across = M::across(simd, (step.h, sweep.predicted_displacement(step.h)), i, tile, scratch);
            scratch.across.push(across.eliminate(simd, M::PROFILE, i, scratch.factors));
        },
    );
}

/// Eliminates point i, if the root does not drive it.
#[inline(always)]
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
    // An angle of the driven first segment is driven too, of the second it is not.
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

/// Adds everything that begins at point i, and what acts on point i+1 but for what acts on few; `phase` is i modulo the model's stride.
#[inline(always)]
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
        elements.walk.way += V3::load(simd, &scratch.edges[i + 1]) - old;
    }
    let Elements { band, walk: AssemblyCursor { way, root_velocity, ambient, .. }, .. } = elements;
    let (way, root_velocity) = (*way, *root_velocity);
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
    let outset =
        PredictedState { sweep, faster: v - root_velocity, share: sweep.predicted_displacement(step.h), way };
    // p less a/h² of that, and gravity.
    let mut p = if step.second_order {
        let before = &tile.history[i + 1];
        let v_before = V3::load(simd, &before[history::V..]);
        let way_before = V3::load(simd, &before[history::WAY..]);
        V3::splat(simd, step.gravity)
            + (v * F::splat(simd, 4.0) - v_before) * F::splat(simd, 0.5 * inv_h)
            + (way_before * F::splat(simd, 3.0) - step.moved * F::splat(simd, 9.0))
                * F::splat(simd, 0.25 * inv_h2)
            - outset.way(simd) * F::splat(simd, a * inv_h2)
    } else if sweep == Linearization::Initial {
        ambient.pull
    } else {
        ambient.pull + (v - root_velocity - outset.way(simd) * F::splat(simd, inv_h)) * F::splat(simd, inv_h)
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
            root_velocity + outset.way(simd) * F::splat(simd, inv_h)
        };
        let slip = ambient.wind + local - moving;
        right += slip * across + u * (u.dot(slip) * (along - across));
        band.add_diagonal(1, Sym3::outer(u, (along - across) * inv_h).add_identity(across * inv_h));
    }
    band.add_force(1, right);
}
