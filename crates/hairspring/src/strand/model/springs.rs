//! Springs only: stretch, bend, torsion, and an altitude spring in every tetrahedron of four neighbours.
//!
//! ```text
//!        e₀          e₁              o  the strand's points        stretch   (k, k+1)
//!       ╱ ╲         ╱ ╲              e  extra particles, set aside bend      (k, k+2)
//!  o₀ ─╱───╲─ o₁ ──╱───╲─ o₂            from the middle of each    torsion   (k, k+3)
//!                                       segment, a third of a turn altitude  k … k+3
//! ```
//!
//! Selle, Lentine, Fedkiw 2008, *A Mass Spring Model for Hair Simulation*, §3: a distance spring has no stiffness sideways, so a straight
//! strand gets extra particles beside it, and the four neighbours' tetrahedra make a truss that bends and twists as a whole. An
//! altitude spring acts along the shortest height of its tetrahedron (between a point and a face, or two edges), which keeps it from
//! collapsing or turning inside out. Where we deviate: the height is kept by the rest volume over the present area, V₀/|n|, so one number a
//! tetrahedron is enough; and every edge (k, k+1) is projected to its length like the segments of the other models.

use super::{At, Model};
use crate::strand::{
    band::Band,
    lanes::{F, Row, Sym3, V3, load},
    root::Root,
    tile::{Tile, springs},
};
use fearless_simd::{mask32x8, prelude::*};

/// A truss of distance springs; see above.
pub struct Springs;

impl<S: Simd> Model<S, 3, 12> for Springs {
    const DRIVEN: usize = 3;

    #[inline(always)]
    fn begin(_: S, _: &Tile, _: &Root<S>) -> Self {
        Springs
    }

    #[inline(always)]
    fn add(&mut self, simd: S, at: &At<S>, x: &[[Row; 3]], tile: &mut Tile, band: &mut Band<S, 3, 12>) {
        let (i, n) = (at.i, tile.rest.len());
        let rest = &tile.rest[i];
        let point = |k: usize| V3::load(simd, &x[(i + k).min(n - 1)]);
        let p = [point(0), point(1), point(2), point(3)];
        for (far, length, stiffness) in [(2, springs::L2, springs::K2), (3, springs::L3, springs::K3)] {
            let k = load(simd, &rest[stiffness]);
            let (l, u) = (p[far] - p[0]).length_and_unit();
            let length = load(simd, &rest[length]);
            // Kept positive semi-definite under compression (Choi & Ko 2002).
            let across = k * (F::splat(simd, 1.0) - length / l).max(0.0) * at.damped;
            let block = Sym3::outer(u, k * at.damped - across).add_identity(across);
            let force = u * (k * (l - length));
            band.add_diagonal(0, block);
            band.add_diagonal(far, block);
            band.add_block(0, far, &-block.full());
            band.add_force(0, force);
            band.add_force(far, -force);
        }
        let k = load(simd, &rest[springs::K3]);
        let (normal, c, strain) = altitude(simd, p, load(simd, &rest[springs::VOLUME]));
        let block = Sym3::outer(normal, k * at.damped);
        for a in 0..4 {
            let scaled = block * c[a];
            band.add_diagonal(a, scaled * c[a]);
            for (b, c) in c.iter().enumerate().skip(a + 1) {
                band.add_block(a, b, &(scaled * *c).full());
            }
            band.add_force(a, normal * -(k * strain * c[a]));
        }
    }

    #[inline(always)]
    fn take(_: S, _: usize, _: V3<S>, _: &[F<S>; 12], _: &mut Tile) {}
}

/// The heights of a tetrahedron: the points p, q, r, v, and whether from the face pqr to v, or from the edge pq to the edge rv.
const HEIGHTS: [([usize; 4], bool); 7] = [
    ([0, 1, 2, 3], true),
    ([1, 2, 3, 0], true),
    ([0, 2, 3, 1], true),
    ([0, 1, 3, 2], true),
    ([0, 1, 2, 3], false),
    ([0, 2, 1, 3], false),
    ([0, 3, 1, 2], false),
];

/// The shortest height of a tetrahedron: its unit direction, the gradient of the height over that direction at the four points, and what it is
/// longer than with six times the rest volume `volume` [m].
#[inline(always)]
pub fn altitude<S: Simd>(simd: S, x: [V3<S>; 4], volume: F<S>) -> (V3<S>, [F<S>; 4], F<S>) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let nought = V3::zero(simd);
    // All heights are six volumes over |a × b|; the shortest has the largest.
    let (mut a, mut b, mut d, mut n) = (nought, nought, nought, nought);
    let mut largest = F::<S>::splat(simd, -1.0);
    let mut sign = one;
    let mut chosen = [largest.simd_gt(one); 7];
    for (k, ([p, q, r, v], face)) in HEIGHTS.into_iter().enumerate() {
        let side = x[q] - x[p];
        let (other, across) = if face { (x[r] - x[p], x[v] - x[p]) } else { (x[v] - x[r], x[r] - x[p]) };
        let cross = side.cross(other);
        let area = cross.dot(cross);
        let better: mask32x8<S> = area.simd_gt(largest);
        largest = better.select(area, largest);
        (a, b) = (V3::select(better, side, a), V3::select(better, other, b));
        (d, n) = (V3::select(better, across, d), V3::select(better, cross, n));
        sign = better.select(F::splat(simd, ORIENTATION[k]), sign);
        for chosen in chosen.iter_mut().take(k) {
            *chosen &= !better;
        }
        chosen[k] = better;
    }
    let inverse = one / largest.max(1e-30);
    let s = d.cross(b).dot(n) * inverse;
    let t = d.cross(a).dot(n) * inverse;
    let mut c = [zero; 4];
    for (k, ([p, q, r, v], face)) in HEIGHTS.into_iter().enumerate() {
        let weights = if face { [s - t - one, -s, t, one] } else { [s - one, -s, one - t, t] };
        for (point, weight) in [p, q, r, v].into_iter().zip(weights) {
            c[point] = chosen[k].select(weight, c[point]);
        }
    }
    let scale = inverse.sqrt();
    let strain = (n.dot(d) - sign * volume) * scale;
    (n * scale, c, strain)
}

/// Sign of n·d of each of [`HEIGHTS`] in a tetrahedron with (x₁−x₀)·((x₂−x₀)×(x₃−x₀)) > 0.
const ORIENTATION: [f32; 7] = [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0];
