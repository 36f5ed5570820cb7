//! Contact inside the solve: a collider exerts a normal force and friction on a point while the whole strand
//! is solved.
//!
//! ```text
//!   N ← max(0, N − k (g + n·δ))       g the gap [m], n the normal, k = STRETCH m/h²,
//!                                     δ the displacement of the point in the solve
//! ```
//!
//! The normal force N is carried from substep to substep, as the tension of a segment is (an augmented
//! Lagrangian, Alart & Curnier 1991, *A Mixed Formulation for Frictional Contact Problems*). Tension, weight
//! and N are thus in balance in one solve. With contact in [`super::post_solve`] alone, a taut strand over a
//! cylinder sank in and was pushed out again in every substep, from root to tip. Each time it moved half a
//! millimeter along the surface, and so ran off toward its root.
//!
//! Friction is the force of a spring along the surface, which yields at the Coulomb limit (see
//! [`FrictionSpring`]). A strand at rest therefore does not creep, and a point that is pulled by more than the limit
//! accelerates.
//!
//! Only points with N > 0 take part. N starts in `post_solve`, from the correction that pushed the point out.

use super::{
    assemble::{Linearization, SubstepContext},
    colliders::{contact, surface_displacement},
    friction::{Friction, FrictionSpring},
    model::stretch::STRETCH,
    segment::max_tolerance,
    system::System,
    tile::{Tile, rest, state},
};
use crate::collide::ColliderPose;
use crate::simd::lanes::{F, Mask, Simd, Sym3, V3, Work, load, store};

/// Returns the gap [m] that the solve closes in a substep: `gap` outside of the collider, and inside the share
/// `relaxation` of it (see `relax`). The surface moves by `approach` along its normal in the substep [m], and the point
/// follows that wholly.
#[inline(always)]
pub fn relaxed_gap<S: Simd>(gap: F<S>, approach: F<S>, relaxation: f32) -> F<S> {
    let before = (-gap - approach.max(0.0)).max(0.0);
    before.mul_add(1.0 - relaxation, gap)
}

/// Rows of scratch a point. They are written where at least one of the eight points is in contact.
pub mod scratch {
    /// Outward normal, 3 rows.
    pub const NORMAL: usize = 0;
    /// Gap before the solve, negative inside [m].
    pub const GAP: usize = 3;
    /// From here on, the same rows for the segment that ends at the point, at its contact position.
    pub const SEGMENT: usize = 4;
    /// Rows a point.
    pub const ROWS: usize = 8;
}

/// Ratio of the stiffness of a point's friction spring to that of contact [1]. At the limit, under its own weight, a
/// point stretches its spring by μ times 0.1 µm at four substeps. Found by trial: at
/// 6 and 8, a box of 2 by 10 mm that is dragged through 200 hairs loses 2 and 3 of them. A stiffer spring also makes a
/// strand that begins to slide slower at first: at μ = 0.3, it slips over a cylinder at a load that is too high by 1.8 %
/// at 4 and by 2.3 % at 8.
const STICK: f32 = 4.0;

/// Adds the contact of point `i`, the second of the window. `x` is its position relative to the root, `drift`
/// its predicted displacement, and `displacement` its displacement since the start of the substep, including `drift`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn assemble_contact<S: Simd, const B: usize>(
    simd: S,
    (sweep, step): (Linearization, &SubstepContext<S>),
    tile: &mut Tile,
    (i, x, drift, displacement): (usize, V3<S>, V3<S>, V3<S>),
    system: &mut impl System<S, B>,
    work: &mut [Work; scratch::ROWS],
) {
    let zero = F::<S>::splat(simd, 0.0);
    let force = load(simd, &tile.state[i][state::NORMAL_FORCE]);
    if !force.simd_gt(0.0).any_true() {
        return;
    }
    let Surface { distance: mut gap, mut normal, carried, .. } =
        nearest(simd, step.colliders, x + step.root.position, [passes(simd, tile, i); 2]);
    gap -= load(simd, &tile.rest[i][rest::CLEARANCE]);

    // The contact is closed while N could close the gap within a substep. Points farther away are released.
    let m_h2 = load(simd, &tile.rest[i][rest::MASS]) * (1.0 / (step.h * step.h));
    let shut = force.simd_gt(0.0) & force.simd_gt(gap * m_h2);
    let force = shut.select(force, zero);
    gap = shut.select(relaxed_gap(gap, normal.dot(carried), step.relaxation), zero);
    normal = V3::select(shut, normal, V3::zero(simd));
    store(force, &mut tile.state[i][state::NORMAL_FORCE]);
    normal.store(&mut work[scratch::NORMAL..]);
    store(gap, &mut work[scratch::GAP]);

    let along = |v: V3<S>| v - normal * normal.dot(v);
    let k = shut.select(m_h2 * STRETCH, zero);
    let before = V3::load(simd, &tile.state[i][state::V..]) * F::splat(simd, step.h);
    let slid = along(before - carried);
    let limit = Friction::of(simd, step.h, tile, i).limit(force, slid.length_and_unit().0);
    let mut z = along(V3::load(simd, &tile.state[i][state::FRICTION_STRETCH..]));
    if sweep == Linearization::Initial {
        z += slid;
    }
    let FrictionSpring { stretch, stiffness } = FrictionSpring::new((limit, k * STICK), z, slid);
    V3::select(shut, stretch, V3::zero(simd)).store(&mut tile.state[i][state::FRICTION_STRETCH..]);
    system.add_diagonal(1, Sym3::outer(normal, k - stiffness).add_identity(stiffness));
    system.add_force(
        1,
        normal * (force - k * (gap + normal.dot(drift)))
            - (stretch + along(displacement + step.moved - carried)) * stiffness,
    );
}

/// Returns 1 + the index of the collider that point `i` passes through, because it was authored deep inside, or 0.
#[inline(always)]
pub fn passes<S: Simd>(simd: S, tile: &Tile, i: usize) -> F<S> {
    tile.passes.get(i).map_or(F::splat(simd, 0.0), |row| load(simd, row))
}

/// Returns where the collider with index `k` is one of the two that [`passes`] returned.
#[inline(always)]
pub fn is_passed<S: Simd>([a, b]: [F<S>; 2], k: usize) -> Mask<S> {
    let number = (k + 1) as f32;
    a.simd_eq(number) | b.simd_eq(number)
}

/// The nearest surface, as seen from eight places.
pub struct Surface<S: Simd> {
    /// Distance, negative inside [m].
    pub distance: F<S>,
    /// Unit normal, outward.
    pub normal: V3<S>,
    /// Displacement of the surface there in the substep [m].
    pub carried: V3<S>,
    /// The largest permitted depth of a segment there [m]; see [`max_tolerance`].
    pub tolerance: F<S>,
}

/// Finds the surface nearest to `world`, without the colliders that are `passed`. Not inlined: all models and sweeps
/// share one copy.
#[inline(never)]
pub fn nearest<S: Simd>(simd: S, colliders: &[ColliderPose], world: V3<S>, passed: [F<S>; 2]) -> Surface<S> {
    simd.vectorize(
        #[cfg_attr(not(any(test, unoptimized)), inline(always))]
        || {
            let (zero, most) = (V3::zero(simd), F::splat(simd, f32::MAX));
            let mut surface = Surface { distance: most, normal: zero, carried: zero, tolerance: most };
            for (k, pose) in colliders.iter().enumerate() {
                let (distance, normal) = contact(simd, pose, world);
                let nearest = distance.simd_lt(surface.distance) & !is_passed(passed, k);
                let carried = surface_displacement(simd, pose, world);
                surface.distance = nearest.select(distance, surface.distance);
                surface.normal = V3::select(nearest, normal, surface.normal);
                surface.carried = V3::select(nearest, carried, surface.carried);
                let tolerance = F::splat(simd, max_tolerance(pose));
                surface.tolerance = nearest.select(tolerance, surface.tolerance);
            }
            surface
        },
    )
}

/// Updates the normal force on point `i` after the solve has moved the point by `delta`.
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
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
    let force = (force - k * gap).max(0.0);
    let rows = &mut tile.state[i];
    store(shut.select(force, load(simd, &rows[state::NORMAL_FORCE])), &mut rows[state::NORMAL_FORCE]);
    // A contact that opens forgets where it stuck.
    let stretch = V3::load(simd, &rows[state::FRICTION_STRETCH..]);
    V3::select(force.simd_gt(0.0), stretch, V3::zero(simd)).store(&mut rows[state::FRICTION_STRETCH..]);
}
