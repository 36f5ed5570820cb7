//! Twist: every segment's frame turned about its segment until no torque is left on it.
//!
//! Twist waves in hair run at hundreds of metres a second: to the eye the frames are always in balance (the quasi-static material frame of
//! Bergou et al. 2008, *Discrete Elastic Rods*, §5.1). With û the segment, m its normal, c the normal carried from the segment before, τ
//! the angle from c to m, the energy of the angles θ is
//!
//! ```text
//! E(θ) = Σ ½ GJ/L̄ (τ_i − τ⁰_i)²  +  Σ ½ B |r_{i+1}(θ_i)|²        dr/dθ = −û × d   (d: the rest turn, see `bend`)
//! ```
//!
//! and one Newton step on it each substep is a scalar tridiagonal system, one sweep down and one up, from the driven root to the free tip. It
//! comes before the solve for positions, which holds the frames fixed but for their swing: two exact descents of one energy. (Frames
//! carried from the root without torque would be cheaper, and pump energy into curls.) The measure of τ is 2 tan(τ/2), which grows
//! to the half turn.

use super::{
    band::Factors,
    bend::transport,
    lanes::{F, Sym3, V3, load, store},
    root::Root,
    tile::{Tile, rest, state},
};
use fearless_simd::prelude::*;

/// Rows of scratch a point.
pub mod scratch {
    /// Unit vector of the segment, 3 rows.
    pub const U: usize = 0;
    /// Coefficient of the next angle.
    pub const C: usize = 3;
    /// Angle without the next.
    pub const D: usize = 4;
    /// Torque of the twist at the joint at this point [N m]: what `twist` leaves for the solve.
    pub const TORQUE: usize = 5;
    /// Its change with the angle.
    pub const K: usize = 6;
}

/// Largest turn of a frame about its segment in a substep [rad]: a Newton step is not to be believed beyond.
const LARGEST_TURN: f32 = 0.5;

/// Brings the frames of all segments into balance with the positions; `work` of shape `[points]`.
#[inline(always)]
pub fn twist<S: Simd>(simd: S, root: &Root<S>, tile: &mut Tile, work: &mut [Factors]) {
    let zero = F::<S>::splat(simd, 0.0);
    let one = F::<S>::splat(simd, 1.0);
    let n = tile.rest.len();
    let ratio = Root::<S>::twist_ratio(simd, tile.strand);

    let mut x1 = root.first;
    let mut u0 = x1.length_and_unit().1;
    let mut m0 = root.normal;
    let x2 = V3::load(simd, &tile.state[2][state::X..]);
    let mut e1 = x2 - x1;
    x1 = x2;
    // Of the row before: its diagonal and right side without the joint that follows, and its elimination.
    let (mut diagonal, mut right) = (zero, zero);
    let (mut c_before, mut d_before, mut k_before) = (zero, zero, zero);
    for i in 1..n - 1 {
        let at = &tile.rest[i];
        let length = load(simd, &at[rest::LENGTH]);
        let real = length.simd_gt(0.0);
        let u = V3::select(real, e1.length_and_unit().1, u0);
        let carried = transport(m0, u0, u);
        let own = V3::load(simd, &tile.state[i][state::NORMAL..]);
        let across = own - u * own.dot(u);
        let size = across.dot(across);
        let m = V3::select(size.simd_gt(1e-6), across * (one / size.max(1e-6).sqrt()), carried);
        m.store(&mut tile.state[i][state::NORMAL..]);

        // Torque of the twist at the joint before this segment.
        let sine = carried.cross(m).dot(u);
        // Bounded near the half turn, where the measure would grow without end.
        let tau = (sine + sine) / (carried.dot(m) + 1.0).max(0.5);
        let slope = (tau * tau).mul_add(0.25, one);
        let stiffness = load(simd, &at[rest::BEND]) * ratio * slope;
        let torque = stiffness * (tau - load(simd, &at[rest::TWIST]));
        let k = stiffness * slope;

        // Torque of the bend at the joint after it.
        let next = &tile.rest[i + 1];
        let next_length = load(simd, &next[rest::LENGTH]);
        let x3 = if i + 2 < n { V3::load(simd, &tile.state[i + 2][state::X..]) } else { x1 };
        let e2 = x3 - x1;
        let turn = V3::load(simd, &next[rest::TURN..]);
        let binormal = u.cross(m);
        let d = m.mul_add(turn.x, binormal.mul_add(turn.y, u * turn.z));
        let r = e2 * (one / next_length.max(1e-12)) - e1 * (one / length.max(1e-12)) - d;
        let arm = u.cross(d);
        let bend = load(simd, &next[rest::BEND]);

        // The row before is complete now: (K₋ + K + H₋) δ₋ − K₋ δ₋₋ − K δ = T − T₋ + B r·(û × d)₋
        if i > 1 {
            let inv = one / (-k_before).mul_add(c_before, diagonal + k).max(1e-30);
            c_before = k * inv;
            d_before = k_before.mul_add(d_before, right + torque) * inv;
            store(c_before, &mut work[i - 1][scratch::C]);
            store(d_before, &mut work[i - 1][scratch::D]);
        }
        u.store(&mut work[i][scratch::U..]);
        store(torque, &mut work[i][scratch::TORQUE]);
        store(k, &mut work[i][scratch::K]);
        diagonal = k + bend * arm.dot(arm);
        right = bend * r.dot(arm) - torque;
        (k_before, m0, u0, e1, x1) = (k, m, u, e2, x3);
    }
    let inv = one / (-k_before).mul_add(c_before, diagonal).max(1e-30);
    let mut delta = k_before.mul_add(d_before, right) * inv;
    let mut delta_after = zero;
    for i in (1..n - 1).rev() {
        if i + 2 < n {
            delta = load(simd, &work[i][scratch::C]).mul_add(delta, load(simd, &work[i][scratch::D]));
        }
        // The torque of the joint after this segment, at the new angles.
        if i + 2 < n {
            let row = &mut work[i + 1][scratch::TORQUE];
            let torque = load(simd, row);
            let k = load(simd, &work[i + 1][scratch::K]);
            store(k.mul_add(delta_after - delta, torque), &mut work[i + 1][scratch::TORQUE]);
        }
        delta_after = delta;
        let turn = delta.max(-LARGEST_TURN).min(LARGEST_TURN);
        let u = V3::load(simd, &work[i][scratch::U..]);
        let row = &mut tile.state[i][state::NORMAL..];
        let m = V3::load(simd, row);
        u.cross(m).mul_add(turn, m).length_and_unit().1.store(row);
    }
    // The tip is no joint; what lies there is another tile's.
    store(zero, &mut work[n - 1][scratch::TORQUE]);
    store(zero, &mut work[n - 1][scratch::K]);
    let torque = load(simd, &work[1][scratch::TORQUE]);
    let k = load(simd, &work[1][scratch::K]);
    store(k.mul_add(delta_after, torque), &mut work[1][scratch::TORQUE]);
}

/// How a joint's twist acts on its three points: the angle between two frames also changes as their segments swing,
/// ∂τ/∂e = κb / 2ℓ on either side, κb = 2 û₀×û₁ / (1 + û₀·û₁) (Bergou et al. 2010, *Discrete Viscous Threads*, §4.2.2).
///
/// ∂τ/∂x_k = c_k g with one vector g for all three: forces −T c_k g [N], and Gauss–Newton blocks K c_k c_l g gᵀ.
pub struct TwistForce<S: Simd> {
    /// Forces [N].
    pub force: [V3<S>; 3],
    /// K g gᵀ.
    pub block: Sym3<S>,
    /// c of the three points [1/m].
    pub c: [F<S>; 3],
}

#[inline(always)]
pub fn twist_force<S: Simd>(
    (u0, u1): (V3<S>, V3<S>),
    (torque, stiffness): (F<S>, F<S>),
    (alpha, beta): (F<S>, F<S>),
) -> TwistForce<S> {
    let one = F::splat(torque.simd, 1.0);
    let g = u0.cross(u1) * (one / (u0.dot(u1) + 1.0).max(0.1));
    let c = [-alpha, alpha - beta, beta];
    let pull = g * -torque;
    TwistForce { force: [pull * c[0], pull * c[1], pull * c[2]], block: Sym3::outer(g, stiffness), c }
}
