//! Contact inside the solve: a point that a collider holds out is pressed there, and rubs, while the strand moves as a whole.
//!
//! ```text
//!   N ← max(0, N − k (g + n·δ))       g the gap [m], n the normal, δ what the solve moves the point by, k = STRETCH m/h²
//! ```
//!
//! The normal force N is carried from substep to substep like a segment's tension (an augmented Lagrangian, Alart & Curnier 1991, *A
//! Mixed Formulation for Frictional Contact Problems*), so that tension, weight and N are in balance in one solve. Were contact
//! only what [`super::post_solve`] makes of it, a taut strand over a cylinder would sink in and be pushed out again in every
//! substep, from root to tip: half a millimetre along the surface each time, which ran it off toward its root.
//!
//! Friction is −μN s/|s| of the slide s along the surface, with |s| of the substep before (the lagged secant of Li et al. 2020,
//! *Incremental Potential Contact*, §5, for one step): what slides slower from substep to substep comes to a stop, what is
//! pulled harder than μN gathers speed. The secant is no stiffer than [`STICK`] k: a strand at rest creeps by up to μN over that a substep (μ times
//! 13 µm/s under its own weight, at four substeps). What is stiffer creeps less and is slower to start where it is pulled a little harder than
//! friction holds, since its slide grows from substep to substep by that ratio.
//!
//! Only points with N > 0 take part. It begins in `post_solve`, with the push that a point needed.

use super::{
    assemble::SubstepContext,
    colliders::{contact, surface_displacement},
    friction::Friction,
    model::stretch::STRETCH,
    system::System,
    tile::{Tile, rest, state},
};
use crate::collide::ColliderPose;
use crate::simd::lanes::{F, Simd, Sym3, V3, Work, load, store};

/// Rows of scratch a point, written where any of the eight is in contact.
pub mod scratch {
    /// Outward normal, 3 rows.
    pub const NORMAL: usize = 0;
    /// Gap before the solve, negative inside [m].
    pub const GAP: usize = 3;
    /// From here on the same of the segment to the point, at its place that is pressed.
    pub const SEGMENT: usize = 4;
    /// Rows a point.
    pub const ROWS: usize = 8;
}

/// How many times stiffer than contact friction is that holds [1]: by trial, between creep on a slope (0.36 mm in 10 s at 1, 0.02 at 16) and the load
/// at which a strand over a cylinder slips (at μ = 1 high by 6 % at 1, by 10 % at 16).
pub const STICK: f32 = 8.0;

/// Adds contact to point `i`, the second of the window, which is at `x` from the root, drifts by
/// `drift` and is by then `way` from where the substep began.
#[inline(always)]
pub fn assemble_contact<S: Simd, const B: usize>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, x, drift, way): (usize, V3<S>, V3<S>, V3<S>),
    system: &mut impl System<S, B>,
    work: &mut [Work; scratch::ROWS],
) {
    let zero = F::<S>::splat(simd, 0.0);
    let force = load(simd, &tile.state[i][state::NORMAL_FORCE]);
    if !force.simd_gt(0.0).any_true() {
        return;
    }
    let Surface { distance: mut gap, mut normal, carried } =
        nearest(simd, step.obstacles, x + step.root.position);
    gap -= load(simd, &tile.rest[i][rest::CLEARANCE]);

    // Shut while N could close the gap in a substep; what has gone farther is let go.
    let m_h2 = load(simd, &tile.rest[i][rest::MASS]) * (1.0 / (step.h * step.h));
    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    gap = shut.select(gap, zero);
    normal = V3::select(shut, normal, V3::zero(simd));
    store(force, &mut tile.state[i][state::NORMAL_FORCE]);
    normal.store(&mut work[scratch::NORMAL..]);
    store(gap, &mut work[scratch::GAP]);

    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = V3::load(simd, &tile.state[i][state::V..]) * F::splat(simd, step.h);
    let (slid, _) = along(before - carried).length_and_unit();
    let rub = Friction::of(simd, step.h, tile.strand).secant(force, slid, k * STICK);
    system.add_diagonal(1, Sym3::outer(normal, k - rub).add_identity(rub));
    system.add_force(
        1,
        normal * (force - k * (gap + normal.dot(drift))) - along(way + step.moved - carried) * rub,
    );
}

/// What eight places see of the surface that is nearest to each.
pub struct Surface<S: Simd> {
    /// Distance, negative inside [m].
    pub distance: F<S>,
    /// Unit normal, outward.
    pub normal: V3<S>,
    /// How far the surface moves there in the substep [m].
    pub carried: V3<S>,
}

/// The surface that is nearest to `world`. A function by itself, for all models and sweeps, like `post_solve`'s `place`.
#[inline(never)]
pub fn nearest<S: Simd>(simd: S, obstacles: &[ColliderPose], world: V3<S>) -> Surface<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = V3::zero(simd);
            let mut surface = Surface { distance: F::splat(simd, f32::MAX), normal: zero, carried: zero };
            for pose in obstacles {
                let (distance, normal) = contact(simd, pose, world);
                let nearest = distance.simd_lt(surface.distance);
                let carried = surface_displacement(simd, pose, world);
                surface.distance = nearest.select(distance, surface.distance);
                surface.normal = V3::select(nearest, normal, surface.normal);
                surface.carried = V3::select(nearest, carried, surface.carried);
            }
            surface
        },
    )
}

/// The force that presses point `i` once the solve has moved it by `delta`.
#[inline(always)]
pub fn update_contact_multiplier<S: Simd>(
    simd: S,
    step: &SubstepContext<S>,
    tile: &mut Tile,
    (i, delta): (usize, V3<S>),
    work: &[Work; scratch::ROWS],
) {
    let force = load(simd, &tile.state[i][state::NORMAL_FORCE]);
    let shut = force.simd_gt(0.0);
    if !shut.any_true() {
        return;
    }
    let k = load(simd, &tile.rest[i][rest::MASS]) * (STRETCH / (step.h * step.h));
    let gap = load(simd, &work[scratch::GAP]) + V3::load(simd, &work[scratch::NORMAL..]).dot(delta);
    store(shut.select((force - k * gap).max(0.0), force), &mut tile.state[i][state::NORMAL_FORCE]);
}
