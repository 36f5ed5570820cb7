//! Springs only: stretch, bend, torsion, and an altitude spring in every tetrahedron of four neighbours.
//!
//! ```text
//!        e₀          e₁              o  the strand's points        stretch   (k, k+1), and (k, k+2) from a point
//!       ╱ ╲         ╱ ╲              e  extra particles, beside    bend      (k, k+2) from an extra particle
//!  o₀ ─╱───╲─ o₁ ──╱───╲─ o₂            the middle of each         torsion   (k, k+3)
//!                                       segment, turn by turn      altitude  k … k+3
//! ```
//!
//! Selle, Lentine, Fedkiw 2008, *A Mass Spring Model for Hair Simulation*, §3: a distance spring has no stiffness sideways, so a straight
//! strand gets extra particles beside it, and the four neighbours' tetrahedra make a truss that bends and twists as a whole; how stiff the
//! springs are for that is in `truss`. An altitude spring acts along the shortest height of its tetrahedron (between a point and a face,
//! or two edges), which keeps it from collapsing or turning inside out. Where we deviate: it acts below half the rest volume only, since
//! the others already resist as much as the fibre does; its height is kept by the volume over the present area, so one number a
//! tetrahedron is enough; and the strand's segments are projected to their lengths as in the other models, their triangles with them.

use super::{
    At, Model, Solved,
    altitude::{self, after, flattened},
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
        integrate::run_tile,
        precomputed::Precomputed,
        profile::Profile,
        root::Root,
        scratch::{Memory, Scratch},
        system::System,
        tile::{Tile, springs, state, strand},
    },
};
use fearless_simd::Level;

/// A truss of distance springs, see above.
pub struct Springs;

impl<S: Simd> Model<S, 3, 12> for Springs {
    const STRIDE: usize = 2;

    // By trial: with 0.5 a swing leaves its plane, since the sides of a truss are not alike; with 1 it trembles on an edge.
    const SIDEWAYS: f32 = 0.8;

    const PROFILE: Profile<3, 12> = Profile::far();

    #[inline(always)]
    fn begin(_: S, _: &Tile, _: &Root<S>) -> Self {
        Self
    }

    #[inline(always)]
    fn acts_across(simd: S, i: usize, tile: &Tile, scratch: &Scratch) -> bool {
        flattened(after(simd, i, scratch), &tile.rest[i]).any_true()
    }

    #[inline(always)]
    fn across(simd: S, times: (f32, f32), i: usize, tile: &Tile, scratch: &Scratch) -> BorderedConstraint<S> {
        altitude::across(simd, times, i, tile, scratch)
    }

    #[inline(always)]
    fn add(&mut self, simd: S, at: &At<S>, scratch: &Scratch, tile: &mut Tile, band: &mut Band<S, 3, 12>) {
        let i = at.i;
        let (rest, fixed) = (&tile.rest[i], &scratch.fixed[i]);
        let p = after(simd, i, scratch);
        // Beyond the tip nothing is stiff.
        let tip = tile.rest.len() - 1;
        let v = |k: usize| V3::load(simd, &tile.state[(i + k).min(tip)][state::V..]);
        let drift = |far: usize| v(far) - v(0);

        // Gauss–Newton here and below. What holds a bent truss in itself is far above what hangs from it, and pulls or pushes across itself as
        // much as along: kept where it pulls alone (Choi & Ko 2002), it would resist every turn of a segment; left out, it cancels.
        let k = load(simd, &scratch.fixed[i - at.phase].along);
        let (l, u) = p[0].length_and_unit();
        let tension = load(simd, &tile.state[i][springs::SIDE]);
        let pull =
            k.mul_add((l - load(simd, &tile.rest[i - at.phase + 1][springs::SIDES])) * at.news, tension);
        add_spring(band, 1, u, k, k.mul_add(u.dot(drift(1)) * at.drifting, pull));

        // From a point, the particle after the next is the strand's next point: that spring is the segment's.
        if at.phase == 1 {
            let (u, k, pull) = BEND.spring(
                [p[1], drift(2)],
                [load(simd, &rest[springs::L2]), load(simd, &fixed.inverse_spans[0])],
                load(simd, &rest[springs::K2]),
                [at.damped, at.drifting],
            );
            add_spring(band, 2, u, k, pull);
        }
        let (u, k, pull) = TORSION.spring(
            [p[2], drift(3)],
            [load(simd, &rest[springs::L3]), load(simd, &fixed.inverse_spans[1])],
            load(simd, &rest[springs::K3]),
            [at.damped, at.drifting],
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

/// One tile through an interval, on the widest lanes that there are.
pub fn run(level: Level, interval: &FrameContext, tile: &mut Tile, memory: &mut Memory) {
    dispatch!(level, simd => run_tile::<_, Springs, 3, 12>(simd, interval, tile, memory));
}

/// What a triangle's sides have besides the stiffness of all segments, for the triangle that begins at `point` (see `truss`) [N/m].
#[inline(always)]
pub fn brace<S: Simd>(simd: S, h: f32, tile: &Tile, point: usize) -> F<S> {
    let damped = load(simd, &tile.strand[strand::DAMPING]) * (1.0 / h) + 1.0;
    load(simd, &tile.rest[point][springs::BRACE]) * damped
}

/// How a spring grows stiffer with its strain x: F = k (ℓ − L)(1 + ax + bx²).
///
/// A spring's two arms on its joint are rigid; turned by φ, its lever shortens on one side and grows on the other. With these numbers, which
/// are the series for ε = 3/2 (see `truss`), its moment is linear in φ to third order. Linear springs let a joint go at a bend of 0.5 rad.
pub struct Progressive {
    a: f32,
    b: f32,
}

/// Of the springs between extra particles, for a joint that twists.
pub const BEND: Progressive = Progressive { a: 1.5, b: 4.5 };

/// Of the springs from points to extra particles, for a joint that bends.
pub const TORSION: Progressive = Progressive { a: 3.0, b: 12.0 };

impl Progressive {
    /// Largest strain at which the stiffness still changes [1].
    const LARGEST: f32 = 0.35;

    /// Secant and tangent stiffness under `strain`, over that at rest [1].
    #[inline(always)]
    fn stiffness<S: Simd>(&self, simd: S, strain: F<S>) -> [F<S>; 2] {
        let one = F::<S>::splat(simd, 1.0);
        let x = strain.max(-Self::LARGEST).min(Self::LARGEST);
        let poly = |a: f32, b: f32| x.mul_add(x * b + a, one);
        [poly(self.a, self.b), poly(2.0 * self.a, 3.0 * self.b)]
    }

    /// Direction of a spring to its farther end, which is at `e` from the nearer and drifts with `v`, its stiffness in the matrix [N/m] and with how much it
    /// pulls [N]; with its rest length and the inverse.
    #[inline(always)]
    fn spring<S: Simd>(
        &self,
        [e, v]: [V3<S>; 2],
        [rest, inverse]: [F<S>; 2],
        k: F<S>,
        [damped, drifting]: [F<S>; 2],
    ) -> (V3<S>, F<S>, F<S>) {
        let (l, u) = e.length_and_unit();
        let [secant, tangent] = self.stiffness(k.simd, (l - rest) * inverse);
        let implicit = k * tangent * damped;
        (u, implicit, implicit.mul_add(u.dot(v) * drifting, k * secant * (l - rest)))
    }

    /// Force and energy of a spring of linear stiffness 1 and rest length `rest` that is longer by `longer` [m], [m²].
    pub fn pull(&self, longer: f64, rest: f64) -> (f64, f64) {
        let (a, b) = (self.a as f64, self.b as f64);
        let x = longer / rest;
        (longer * (1.0 + x * (a + x * b)), longer * longer * (0.5 + x * (a / 3.0 + x * b / 4.0)))
    }

    /// How much longer than at rest a spring is that is `length` long under a tension that would lengthen a linear one by `linear` [m].
    pub fn lengthened(&self, linear: f64, length: f64) -> f64 {
        let mut longer = linear;
        for _ in 0..40 {
            let x = (longer / (length - longer)).clamp(-Self::LARGEST as f64, Self::LARGEST as f64);
            longer += 0.5 * (linear / (1.0 + x * (self.a as f64 + x * self.b as f64)) - longer);
        }
        longer
    }
}

/// Adds a spring between the window's first particle and the one `far` after it, in direction `u`, which has stiffness `k` [N/m] and pulls [N].
#[inline(always)]
fn add_spring<S: Simd>(band: &mut Band<S, 3, 12>, far: usize, u: V3<S>, k: F<S>, pull: F<S>) {
    let (force, block) = (u * pull, Sym3::outer(u, k));
    band.add_diagonal(0, block);
    band.add_diagonal(far, block);
    band.add_block(0, far, &-block.full());
    band.add_force(0, force);
    band.add_force(far, -force);
}
