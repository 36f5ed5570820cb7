//! Bending: the change of tangent at a joint, compared with its rest value in the strand's frame.
//!
//! ```text
//!          t_{j-1}        t_j
//!   x_{j-1} ─────► x_j ─────► x_{j+1}      r = x_{j+1}−x_j / L_j − (x_j−x_{j-1}) / L_{j-1} − d,   E = ½ B |r|²
//!                   ╲  d (rest turn, rotates with t_{j-1})
//! ```
//!
//! B = EI / L̄ with L̄ the mean of the two rest lengths. The sum over joints is then ½∫EI|κ − κ₀|² of an
//! inextensible elastica, where the curvature vector is dt/ds.
//!
//! The rest turn follows the segment before it by the smallest rotation, δd = (û × δû) × d. The force
//! therefore conserves angular momentum except for the component about û, which belongs to the frame (see
//! `rod`). With a = û·d the gradient of r is P = (1 + a) I − û dᵀ on segment j−1:
//!
//! ```text
//! δr = δe_j / L_j − P δe_{j−1} / L_{j−1}
//! ```
//!
//! This sets ℓ = L in the rotation δû, which is exact for inextensible segments; projection makes them so.
//! The Gauss–Newton matrix B JᵀJ is positive semi-definite at any strain (cf. Choi & Ko 2002).

use super::joint::Joint;
use crate::simd::lanes::{F, M3, Simd, Sym3, V3};
use glam::DVec3;

/// The bending element of a joint.
pub struct Bend<S: Simd> {
    pub joint: Joint<S>,
    /// B r, the moment vector at the starting point of the solve [N m].
    pub moment: V3<S>,
}

/// Computes the bending element of a joint.
///
/// `e0` and `e1` are the segments before and after the joint, and `d0` and `d1` their predicted changes [m].
/// `u0` is the unit vector of `e0`, `alpha` and `beta` are the inverse rest lengths, and `d` is the rest turn
/// in world axes. `stiffness` is B [N m], and `implicit` is the stiffness with damping for the matrix, B (1 +
/// τ/h).
#[cfg_attr(not(any(test, unoptimized)), inline(always))]
pub fn bend<S: Simd>(
    [[e0, e1], [d0, d1]]: [[V3<S>; 2]; 2],
    u0: V3<S>,
    [alpha, beta]: [F<S>; 2],
    d: V3<S>,
    stiffness: F<S>,
    implicit: F<S>,
) -> Bend<S> {
    let r = e1 * beta - e0 * alpha - d;
    let a1 = u0.dot(d) + 1.0;
    let drift = d1 * beta - (d0 * a1 - u0 * d.dot(d0)) * alpha;
    let moment = r * stiffness + drift * implicit;
    let pull = [(moment * a1 - d * u0.dot(moment)) * alpha, -(moment * beta)];

    let (a, b) = (implicit * alpha, implicit * beta);
    let [aa, ab] = [a * alpha, b * alpha];
    // −Pᵀ = d ûᵀ − a1 I
    let db = d * ab;
    let mut h01 = M3 { rows: [u0 * db.x, u0 * db.y, u0 * db.z] };
    let diagonal = ab * a1;
    h01.rows[0].x -= diagonal;
    h01.rows[1].y -= diagonal;
    h01.rows[2].z -= diagonal;
    // PᵀP = a1² I − a1 (û dᵀ + d ûᵀ) + d dᵀ
    let w = d * F::splat(d.x.simd, 0.5) - u0 * a1;
    let da = d * aa;
    let h00 = Sym3 {
        xx: da.x * (w.x + w.x),
        xy: da.x.mul_add(w.y, da.y * w.x),
        xz: da.x.mul_add(w.z, da.z * w.x),
        yy: da.y * (w.y + w.y),
        yz: da.y.mul_add(w.z, da.z * w.y),
        zz: da.z * (w.z + w.z),
    }
    .add_identity(aa * a1 * a1);
    Bend { joint: Joint { pull, h00, h01, h11: Sym3::scaled_identity(b * beta) }, moment }
}

/// 1 + cos θ below which a joint counts as completely folded: θ within 0.03° of 180° [1].
pub const FOLDED: f32 = 1e-7;

/// Parallel transport: carries the frame's normal from segment `u0` to segment `u1` by the smallest rotation
/// (Bishop 1975). One Newton step keeps it at unit length.
#[inline(always)]
pub fn transport<S: Simd>(normal: V3<S>, u0: V3<S>, u1: V3<S>) -> V3<S> {
    // n' = n − (n·u1)/(1 + u0·u1) (u0 + u1). The denominator is computed as 1 + u0·u1 = ½|u0 + u1|², which
    // stays precise near a fold. A strand that is folded back on itself keeps its normal.
    let sum = u0 + u1;
    let scale = normal.dot(u1) / (sum.dot(sum) * 0.5).max(FOLDED);
    let n = normal - sum * scale;
    n * (n.dot(n).mul_add(-0.5, F::splat(scale.simd, 1.5)).max(0.5))
}

/// Parallel transport of a frame's normal for one strand in double precision, with unit length. Returns the normal
/// itself where the strand is folded back on itself.
pub fn transport_normal(normal: DVec3, t0: DVec3, t1: DVec3) -> DVec3 {
    let sum = t0 + t1;
    let scale = normal.dot(t1) / (0.5 * sum.length_squared()).max(f64::from(FOLDED));
    (normal - sum * scale).normalize_or(normal)
}
