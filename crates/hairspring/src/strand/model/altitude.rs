//! The altitude springs of the springs model, which act along the shortest height of the tetrahedron of four
//! consecutive particles where it is flattened. Selle, Lentine, Fedkiw 2008, *A Mass Spring Model for Hair
//! Simulation*, §3; [`springs`](super::springs) lists the deviations.

use crate::{
    simd::lanes::{F, Mask, Row, Simd, V3, load},
    strand::{
        bordered::BorderedConstraint,
        root::Root,
        scratch::Scratch,
        tile::{Tile, multipliers, springs, state},
    },
};

/// Ratio of volume to rest volume below which an altitude spring acts [1].
const FLATTENED: f32 = 0.5;

/// Positions of the three particles after particle `i`, relative to it [m].
#[inline(always)]
pub fn next_three_particles<S: Simd>(simd: S, i: usize, scratch: &Scratch) -> [V3<S>; 3] {
    let edges: &[_; 3] = scratch.edges[i + 1..].first_chunk().expect("edges are padded past the tip");
    let [e1, e2, e3] = edges.each_ref().map(|e| V3::load(simd, e));
    [e1, e1 + e2, e1 + e2 + e3]
}

/// Returns where the tetrahedron of a particle and the three after it, at `p` relative to it, is flattened.
#[inline(always)]
pub fn flattened<S: Simd>(p: [V3<S>; 3], rest: &[Row]) -> Mask<S> {
    let volume = p[0].dot(p[1].cross(p[2]));
    let kept = load(volume.simd, &rest[springs::VOLUME]) * FLATTENED;
    (volume * kept).simd_lt(kept * kept)
}

/// Returns the altitude spring of particle `i` and the three after it, with stiffness 0 where their
/// tetrahedron is not [`flattened`]. `h` is the length of the substep [s], and `prediction_time` is the time that
/// velocities act before the starting point of the solve [s].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn altitude_spring<S: Simd>(
    simd: S,
    (h, prediction_time): (f32, f32),
    i: usize,
    tile: &Tile,
    scratch: &Scratch,
) -> BorderedConstraint<S> {
    let p = next_three_particles(simd, i, scratch);
    let rest = &tile.rest[i];
    let kept = load(simd, &rest[springs::VOLUME]) * FLATTENED;
    let k = flattened(p, rest).select(load(simd, &rest[springs::K3]), F::splat(simd, 0.0));
    let (direction, c, extension) = altitude(simd, [V3::zero(simd), p[0], p[1], p[2]], kept);
    let damping = tile.at_particle(Root::<S>::fiber(simd, tile.strand).1, i, multipliers::DAMPING);
    let damped = damping * (1.0 / h) + 1.0;
    // Elements beyond the tip have no stiffness, so the clamped index does no harm.
    let tip = tile.rest.len() - 1;
    let v0 = V3::load(simd, &tile.state[i][state::V..]);
    let mut drift = V3::zero(simd);
    for (far, c) in c.into_iter().enumerate().skip(1) {
        let v = V3::load(simd, &tile.state[(i + far).min(tip)][state::V..]);
        drift = (v - v0).mul_add(c, drift);
    }
    let extension = direction.dot(drift).mul_add(F::splat(simd, prediction_time), extension / damped);
    BorderedConstraint { gradient: c.map(|c| direction * c), extension, stiffness: k * damped }
}

/// The heights of a tetrahedron: the points p, q, r, v, and whether the height goes from the face pqr to v
/// (true) or from the edge pq to the edge rv (false).
const HEIGHTS: [([usize; 4], bool); 7] = [
    ([0, 1, 2, 3], true),
    ([1, 2, 3, 0], true),
    ([0, 2, 3, 1], true),
    ([0, 1, 3, 2], true),
    ([0, 1, 2, 3], false),
    ([0, 2, 1, 3], false),
    ([0, 3, 1, 2], false),
];

/// Returns the shortest height of a tetrahedron: its unit direction, the coefficient of that direction in the
/// gradient of the height at each of the four points, and the extension of the height beyond its value at
/// `volume`, which is six times a volume [m³]. The extension is in [m].
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn altitude<S: Simd>(simd: S, x: [V3<S>; 4], volume: F<S>) -> (V3<S>, [F<S>; 4], F<S>) {
    let (zero, one) = (F::<S>::splat(simd, 0.0), F::<S>::splat(simd, 1.0));
    let nought = V3::zero(simd);
    // Each height is six volumes over |a × b|, so the shortest has the largest |a × b|.
    let (mut a, mut b, mut d, mut n) = (nought, nought, nought, nought);
    let mut largest = F::<S>::splat(simd, -1.0);
    let mut sign = one;
    let mut which = zero;
    each!(k of 0 1 2 3 4 5 6, {
        let ([p, q, r, v], face) = HEIGHTS[k];
        let side = x[q] - x[p];
        let (other, across) = if face { (x[r] - x[p], x[v] - x[p]) } else { (x[v] - x[r], x[r] - x[p]) };
        let cross = side.cross(other);
        let area = cross.dot(cross);
        let better: Mask<S> = area.simd_gt(largest);
        largest = better.select(area, largest);
        (a, b) = (V3::select(better, side, a), V3::select(better, other, b));
        (d, n) = (V3::select(better, across, d), V3::select(better, cross, n));
        sign = better.select(F::splat(simd, ORIENTATION[k]), sign);
        which = better.select(F::splat(simd, k as f32), which);
    });
    let inverse = one / largest.max(1e-30);
    let s = d.cross(b).dot(n) * inverse;
    let t = d.cross(a).dot(n) * inverse;
    let mut c = [zero; 4];
    each!(k of 0 1 2 3 4 5 6, {
        let (points, face) = HEIGHTS[k];
        let weights = if face { [s - t - one, -s, t, one] } else { [s - one, -s, one - t, t] };
        let chosen = which.simd_eq(k as f32);
        for (point, weight) in points.into_iter().zip(weights) {
            c[point] = chosen.select(weight, c[point]);
        }
    });
    let scale = inverse.sqrt();
    let strain = (n.dot(d) - sign * volume) * scale;
    (n * scale, c, strain)
}

/// Sign of n·d for each of [`HEIGHTS`] in a tetrahedron with (x₁−x₀)·((x₂−x₀)×(x₃−x₀)) > 0.
const ORIENTATION: [f32; 7] = [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0];
