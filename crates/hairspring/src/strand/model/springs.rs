//! A mass-spring model: stretch, bend and torsion springs, and an altitude spring in every tetrahedron of
//! four consecutive particles.
//!
//! ```text
//!        e₀          e₁              o  the strand's points        stretch   (k, k+1), and (k, k+2) from a point
//!       ╱ ╲         ╱ ╲              e  extra particles, beside    bend      (k, k+2) from an extra particle
//!  o₀ ─╱───╲─ o₁ ──╱───╲─ o₂            the center of each         torsion   (k, k+3)
//!                                       segment, in rotation       altitude  k … k+3
//! ```
//!
//! Selle, Lentine, Fedkiw 2008, *A Mass Spring Model for Hair Simulation*, §3. A distance spring has no
//! lateral stiffness, so a straight strand gets extra particles next to it. The tetrahedra of four
//! consecutive particles form a truss that bends and twists as a whole. `truss` computes the spring
//! stiffnesses for it. An altitude spring acts along the shortest height of its tetrahedron (between a point
//! and a face, or two edges) and keeps it from collapsing or inverting.
//!
//! This implementation deviates in three ways:
//!
//! - An altitude spring acts below half the rest volume only, because the other springs already resist as
//!   much as the fiber does.
//! - The rest height of a tetrahedron follows from its volume over the current area, so one number a
//!   tetrahedron is enough.
//! - The strand's segments are projected to their lengths as in the other models, and their triangles with
//!   them.

use super::{
    At, Model, Solved,
    altitude::{altitude_spring, flattened, next_three_particles},
};
use crate::{
    simd::{
        dispatch::dispatch,
        lanes::{F, Simd, Sym3, V3, load, store},
    },
    strand::{
        band::Band,
        bordered::BorderedConstraint,
        frame_context::FrameContext,
        integrate::{Implicit, run_tile},
        precomputed::Precomputed,
        profile::Profile,
        root::Root,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, multipliers, springs, state, strand},
    },
};
use fearless_simd::Level;

/// A truss of distance springs; see the module documentation.
pub struct Springs;

impl<S: Simd> Model<S, 3, 12> for Springs {
    const STRIDE: usize = 2;

    // Found by trial: at 0.5 a swing leaves its plane, because the sides of a truss differ; at 1 it vibrates
    // on an edge.
    const SIDEWAYS: f32 = 0.8;

    // Springs come to rest over edges without it, and with it tremble at 3 mm/s over a stone.
    const DAMPS_AT_REST: bool = false;

    const PROFILE: Profile<3, 12> = Profile::far();

    #[inline(always)]
    fn begin(_: S, _: &Tile, _: &Root<S>) -> Self {
        Self
    }

    #[inline(always)]
    fn has_altitude_spring(simd: S, i: usize, tile: &Tile, scratch: &Scratch) -> bool {
        flattened(next_three_particles(simd, i, scratch), &tile.rest[i]).any_true()
    }

    #[inline(always)]
    fn altitude_spring(
        simd: S,
        times: (f32, f32),
        i: usize,
        tile: &Tile,
        scratch: &Scratch,
    ) -> BorderedConstraint<S> {
        altitude_spring(simd, times, i, tile, scratch)
    }

    #[cfg_attr(not(any(test, unoptimized)), inline(always))]
    fn add(&mut self, simd: S, at: &At<S>, scratch: &Scratch, tile: &mut Tile, band: &mut Band<S, 3, 12>) {
        let i = at.i;
        let (rest, fixed) = (&tile.rest[i], &scratch.fixed[i]);
        let p = next_three_particles(simd, i, scratch);
        // Elements beyond the tip have no stiffness, so the clamped index does no harm.
        let tip = tile.rest.len() - 1;
        let v = |k: usize| V3::load(simd, &tile.state[(i + k).min(tip)][state::V..]);
        let drift = |far: usize| v(far) - v(0);

        // The matrices here and below are Gauss–Newton without geometric stiffness. The internal tension of a
        // bent truss far exceeds the load that hangs from it. Springs under tension and springs under
        // compression contribute opposite geometric stiffness. If only the positive part were kept (Choi & Ko
        // 2002), it would resist every rotation of a segment; without it, the contributions cancel.
        let k = load(simd, &scratch.fixed[i - at.phase].along);
        let (l, u) = p[0].length_and_unit();
        let tension = load(simd, &tile.state[i][springs::SIDE]);
        let pull = k.mul_add(
            (l - load(simd, &tile.rest[i - at.phase + 1][springs::SIDES])) * at.length_error_share,
            tension,
        );
        add_spring(band, 1, u, k, k.mul_add(u.dot(drift(1)) * at.prediction_time, pull));

        // The second particle after a point is the strand's next point. That spring is the segment's and is
        // added elsewhere.
        if at.phase == 1 {
            let (u, k, pull) = BEND.spring(
                [p[1], drift(2)],
                [load(simd, &rest[springs::L2]), load(simd, &fixed.inverse_spans[0])],
                load(simd, &rest[springs::K2]),
                [at.damped, at.prediction_time],
            );
            add_spring(band, 2, u, k, pull);
        }
        let (u, k, pull) = TORSION.spring(
            [p[2], drift(3)],
            [load(simd, &rest[springs::L3]), load(simd, &fixed.inverse_spans[1])],
            load(simd, &rest[springs::K3]),
            [at.damped, at.prediction_time],
        );
        band.add_long_range_spring(u, k, pull);
    }

    #[inline(always)]
    fn take(simd: S, solved: &Solved<S, 12>, tile: &mut Tile, fixed: &[Precomputed]) {
        let i = solved.i;
        let extra = i - solved.phase + 1;
        let side = load(simd, &tile.rest[extra][springs::SIDES]);
        let inverse = load(simd, &fixed[extra].inverse_length);
        let taken = solved.taken(1, [side, inverse], solved.along);
        let row = &mut tile.state[i][springs::SIDE];
        store(load(simd, row) + taken, row);
    }
}

/// Advances one tile through a frame with the implicit integrators, and the widest available SIMD
/// instructions.
pub fn run(level: Level, frame: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    dispatch!(level, simd => run_tile::<_, Springs, Implicit, 3, 12>(simd, frame, tile, memory));
}

/// Stiffness of the sides of the triangle that begins at `point`, in addition to that of all segments (see
/// `truss`) [N/m].
#[inline(always)]
pub fn brace<S: Simd>(simd: S, h: f32, tile: &Tile, point: usize) -> F<S> {
    let damping = tile.at_particle(load(simd, &tile.strand[strand::DAMPING]), point, multipliers::DAMPING);
    let damped = damping * (1.0 / h) + 1.0;
    load(simd, &tile.rest[point][springs::BRACE]) * damped
}

/// A spring that stiffens with its strain x: F = k (ℓ − L)(1 + ax + bx²).
///
/// The two arms of a spring on its joint are rigid. When the joint rotates by φ, the lever arm shortens on
/// one side and grows on the other. With these coefficients, which are the series for ε = 3/2 (see `truss`),
/// the moment is linear in φ to third order. With linear springs, a joint gives way at a bend of 0.5 rad.
pub struct Progressive {
    a: f32,
    b: f32,
}

/// Springs between extra particles, for a joint that twists.
pub const BEND: Progressive = Progressive { a: 1.5, b: 4.5 };

/// Springs from points to extra particles, for a joint that bends.
pub const TORSION: Progressive = Progressive { a: 3.0, b: 12.0 };

impl Progressive {
    /// Largest strain up to which the stiffness changes [1].
    const LARGEST: f32 = 0.35;

    /// Secant and tangent stiffness at `strain`, relative to that at rest [1].
    #[inline(always)]
    fn stiffness<S: Simd>(&self, simd: S, strain: F<S>) -> [F<S>; 2] {
        let one = F::<S>::splat(simd, 1.0);
        let x = strain.max(-Self::LARGEST).min(Self::LARGEST);
        let poly = |a: f32, b: f32| x.mul_add(x * b + a, one);
        [poly(self.a, self.b), poly(2.0 * self.a, 3.0 * self.b)]
    }

    /// Returns the direction of a spring, its stiffness in the matrix [N/m] and its tension [N].
    ///
    /// The far end is at `e` from the near end and moves with the relative velocity `v`. `rest` is the rest
    /// length and `inverse` its inverse.
    #[inline(always)]
    fn spring<S: Simd>(
        &self,
        [e, v]: [V3<S>; 2],
        [rest, inverse]: [F<S>; 2],
        k: F<S>,
        [damped, prediction_time]: [F<S>; 2],
    ) -> (V3<S>, F<S>, F<S>) {
        let (l, u) = e.length_and_unit();
        let [secant, tangent] = self.stiffness(k.simd, (l - rest) * inverse);
        let implicit = k * tangent * damped;
        (u, implicit, implicit.mul_add(u.dot(v) * prediction_time, k * secant * (l - rest)))
    }

    /// Force and energy of a spring with linear stiffness 1 and rest length `rest`, extended by `longer` [m],
    /// [m²].
    pub fn pull(&self, longer: f64, rest: f64) -> (f64, f64) {
        let (a, b) = (self.a as f64, self.b as f64);
        let x = longer / rest;
        (longer * (1.0 + x * (a + x * b)), longer * longer * (0.5 + x * (a / 3.0 + x * b / 4.0)))
    }

    /// Returns the extension of a spring whose current length is `length`, under a tension that would extend
    /// a linear spring by `linear` [m].
    pub fn lengthened(&self, linear: f64, length: f64) -> f64 {
        let mut longer = linear;
        for _ in 0..40 {
            let x = (longer / (length - longer)).clamp(-Self::LARGEST as f64, Self::LARGEST as f64);
            longer += 0.5 * (linear / (1.0 + x * (self.a as f64 + x * self.b as f64)) - longer);
        }
        longer
    }
}

/// Adds a spring between the window's first particle and the one `far` after it, with direction `u`,
/// stiffness `k` [N/m] and tension `pull` [N].
#[inline(always)]
fn add_spring<S: Simd>(band: &mut Band<S, 3, 12>, far: usize, u: V3<S>, k: F<S>, pull: F<S>) {
    let (force, block) = (u * pull, Sym3::outer(u, k));
    band.add_diagonal(0, block);
    band.add_diagonal(far, block);
    band.add_block(0, far, &-block.full());
    band.add_force(0, force);
    band.add_force(far, -force);
}
