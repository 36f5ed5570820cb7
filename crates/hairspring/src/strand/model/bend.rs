//! Bending: the change of tangent at a joint against its rest value carried in the strand's frame.
//!
//! ```text
//!          t_{j-1}        t_j
//!   x_{j-1} ─────► x_j ─────► x_{j+1}      r = x_{j+1}−x_j / L_j − (x_j−x_{j-1}) / L_{j-1} − d,   E = ½ B |r|²
//!                   ╲  d (rest turn, rotates with t_{j-1})
//! ```
//!
//! B = EI / L̄ with L̄ the mean of the two rest lengths, so that the sum over joints is ½∫EI|κ − κ₀|² of an inextensible
//! elastica (the curvature vector is dt/ds). The rest turn d turns with the segment before it by the least rotation,
//! δd = (û × δû) × d, so the force keeps angular momentum but for the part about û, which is the frame's (see `rod`). With a = û·d the gradient of r is P = (1 + a) I − û dᵀ on segment j−1:
//!
//! ```text
//! δr = δe_j / L_j − P δe_{j−1} / L_{j−1}
//!
//! (with ℓ = L in the swing δû: exact for inextensible segments, which the projection makes of them)
//! and the Gauss–Newton matrix B JᵀJ is positive semi-definite whatever the strain (cf. Choi & Ko 2002).

use crate::strand::{
    band::Band,
    lanes::{F, M3, Sym3, V3},
};
use fearless_simd::prelude::*;

/// A joint's contribution to the band, points j−1, j and j+1 being i, i+1 and i+2 of it.
pub struct Bend<S: Simd> {
    /// B α² PᵀP, block (i, i).
    pub g: Sym3<S>,
    /// B αβ Pᵀ, block (i, i+2).
    pub q: M3<S>,
    /// B β², times the identity: block (i+2, i+2).
    pub b: F<S>,
    /// Forces on i, i+1, i+2 [N].
    pub force: [V3<S>; 3],
    /// B r, the moment vector [N m].
    pub moment: V3<S>,
}

impl<S: Simd> Bend<S> {
    /// Adds the joint to a band whose window begins at its first point.
    #[inline(always)]
    pub fn add_to<const B: usize, const N: usize>(&self, band: &mut Band<S, B, N>) {
        let Self { g, q, b, force, .. } = self;
        // Block (i+1, i+1) is G + Q + Qᵀ + b, (i, i+1) is −(G + Q), (i+1, i+2) is −(Q + b).
        band.add_diagonal(0, *g);
        band.add_diagonal(1, *g + q.plus_transposed());
        band.add_identity(1, *b);
        band.add_identity(2, *b);
        band.add_block(0, 1, &-(*q + g.full()));
        band.add_block(0, 2, q);
        band.add_block(1, 2, &-(*q + Sym3::scaled_identity(*b).full()));
        for (p, force) in force.iter().enumerate() {
            band.add_force(p, *force);
        }
    }
}

/// Bending at a joint: `e0`, `e1` the segments before and after it [m], `u0` the unit vector of `e0`, `alpha`, `beta` the
/// inverse rest lengths, `d` the rest turn in world axes, `stiffness` B [N m], and `implicit` the stiffness with damping
/// for the matrix, B (1 + τ/h).
#[inline(always)]
pub fn bend<S: Simd>(
    [e0, e1]: [V3<S>; 2],
    u0: V3<S>,
    [alpha, beta]: [F<S>; 2],
    d: V3<S>,
    stiffness: F<S>,
    implicit: F<S>,
) -> Bend<S> {
    let r = e1 * beta - e0 * alpha - d;
    let a1 = u0.dot(d) + 1.0;
    let pt_r = r * a1 - d * u0.dot(r);
    let f0 = -(pt_r * (stiffness * alpha));
    let moment = r * stiffness;
    let f2 = -(moment * beta);

    let bab = implicit * alpha * beta;
    let baa = implicit * alpha * alpha;
    // Pᵀ = a1 I − d ûᵀ
    let mut q = M3 { rows: [u0 * -(d.x * bab), u0 * -(d.y * bab), u0 * -(d.z * bab)] };
    let diagonal = bab * a1;
    q.rows[0].x += diagonal;
    q.rows[1].y += diagonal;
    q.rows[2].z += diagonal;
    // PᵀP = a1² I − a1 (û dᵀ + d ûᵀ) + d dᵀ
    let w = d * F::splat(d.x.simd, 0.5) - u0 * a1;
    let g = Sym3 {
        xx: baa * (d.x * w.x + d.x * w.x),
        xy: baa * d.x.mul_add(w.y, d.y * w.x),
        xz: baa * d.x.mul_add(w.z, d.z * w.x),
        yy: baa * (d.y * w.y + d.y * w.y),
        yz: baa * d.y.mul_add(w.z, d.z * w.y),
        zz: baa * (d.z * w.z + d.z * w.z),
    }
    .add_identity(baa * a1 * a1);
    Bend { g, q, b: implicit * beta * beta, force: [f0, -(f0 + f2), f2], moment }
}

/// The frame's normal carried from segment `u0` to segment `u1` by the least rotation (parallel transport;
/// Bishop 1975), kept at unit length by one Newton step.
#[inline(always)]
pub fn transport<S: Simd>(normal: V3<S>, u0: V3<S>, u1: V3<S>) -> V3<S> {
    // n' = n − (n·u1)/(1 + u0·u1) (u0 + u1); a strand folded back on itself keeps its normal.
    let scale = normal.dot(u1) / (u0.dot(u1) + 1.0).max(1e-3);
    let n = normal - (u0 + u1) * scale;
    n * (n.dot(n).mul_add(-0.5, F::splat(scale.simd, 1.5)).max(0.5))
}
