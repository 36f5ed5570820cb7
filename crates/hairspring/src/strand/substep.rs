//! One tile through one exchange interval: every substep while its points are in the first-level caches.
//!
//! A substep is: root driven → frames twisted into balance → implicit banded solve (backward Euler, linearised once; Baraff & Witkin 1998) → fast projection →
//! strain limit and contact, root to tip → velocities. With positions relative to the root, δ their change, Δr the root's own:
//!
//! ```text
//! (M/h² + D/h + K) δ = M/h² (h v − Δr) + D (w − Δr/h) + M g + f(x),      v⁺ = (δ + Δr) / h
//! ```
//!
//! so a teleporting root puts no strain into the linearisation, and far from the world's origin no digit is lost.

use super::{
    band::{Band, FACTOR_ROWS, Factors, back_substitute},
    bend::bend,
    interval::{Interval, Substep},
    lanes::{F, Row, V3, load, store},
    limit::limit,
    project::{self, project},
    root::Root,
    stretch::{STRETCH, stretch},
    tile::{Tile, rest, state},
    twist::{self, twist, twist_force},
};
use fearless_simd::prelude::*;

// The projection's rows lie over the factors, which are no longer needed then.
const _: () = assert!(project::scratch::ROWS <= FACTOR_ROWS);

/// Working memory of one thread, reused by every tile that it runs.
#[derive(Default)]
pub struct Scratch {
    /// Factors of the band, shape `[points]`; the projection's rows lie over them afterwards.
    factors: Vec<Factors>,
    /// New positions relative to the root, shape `[points]`.
    x: Vec<[Row; 3]>,
    /// Inverse masses; 0 for the driven points and the padding.
    inverse_mass: Vec<Row>,
}

impl Scratch {
    /// What the last solve and projections made of point `i`, before the limit; first lane.
    #[cfg(test)]
    pub fn solved(&self, i: usize) -> glam::Vec3 {
        glam::Vec3::from(self.x[i].map(|row| row.0[0]))
    }

    fn reserve(&mut self, points: usize) {
        if self.inverse_mass.len() < points {
            self.factors.resize(points, [Row::default(); FACTOR_ROWS]);
            self.x.resize(points, [Row::default(); 3]);
            self.inverse_mass.resize(points, Row::default());
        }
    }
}

/// All substeps of `interval` for one tile.
#[inline(always)]
pub fn run_tile<S: Simd>(simd: S, interval: &Interval, tile: &mut Tile, scratch: &mut Scratch) {
    scratch.reserve(tile.rest.len());
    for i in 0..tile.rest.len() {
        let at = &tile.rest[i];
        let mut w = load(simd, &at[rest::MASS]);
        w = w.simd_gt(0.0).select(F::splat(simd, 1.0) / w, F::splat(simd, 0.0));
        if i < 2 {
            w = F::splat(simd, 0.0);
        }
        store(w, &mut scratch.inverse_mass[i]);
    }
    let twisted = Root::twist_ratio(simd, tile.strand).simd_gt(0.0).any_true();
    let mut root = Root::between(simd, tile.strand, 0.0, &interval.anchor);
    for substep in &interval.substeps {
        let next = Root::at(simd, tile.strand, substep);
        let moved = next.position - root.position;
        root = next;
        if twisted {
            twist(simd, &root, tile, &mut scratch.factors);
        }
        solve(simd, interval, substep, (&root, moved, twisted), tile, scratch);
        for _ in 0..interval.projections {
            let Scratch { factors, x, inverse_mass } = &mut *scratch;
            if !project(simd, interval.h, tile, inverse_mass, x, factors) {
                break;
            }
        }
        limit(simd, interval.h, substep, &root, moved, tile, &scratch.x);
    }
}

/// The implicit solve: assembles and eliminates down the strand, substitutes back up, and leaves x + δ in `scratch.x`.
#[inline(always)]
fn solve<S: Simd>(
    simd: S,
    interval: &Interval,
    substep: &Substep,
    (root, moved, twisted): (&Root<S>, V3<S>, bool),
    tile: &mut Tile,
    scratch: &mut Scratch,
) {
    let nought = F::<S>::splat(simd, 0.0);
    let one = F::<S>::splat(simd, 1.0);
    let n = tile.rest.len();
    let h = interval.h;
    let inv_h = 1.0 / h;
    let (drag, damping, _) = Root::<S>::fibre(simd, tile.strand);
    let implicit_scale = damping * inv_h + 1.0;
    let gravity = V3::splat(simd, interval.gravity);
    let wind = V3::splat(simd, substep.wind);
    let root_velocity = moved * F::splat(simd, inv_h);

    // The driven segment and its frame at the end of the substep.
    let zero = V3::zero(simd);
    root.first.store(&mut tile.state[1][state::X..]);
    let mut x0 = zero;
    let mut x1 = root.first;
    let mut e0 = x1 - x0;
    let mut u0 = e0.length_and_unit().1;
    let mut normal = root.normal;
    let length0 = load(simd, &tile.rest[0][rest::LENGTH]);
    let mut alpha = one / length0.max(1e-12);

    let mut band = Band::new(simd);
    for i in 0..n {
        // Joint i+1 (between segments i and i+1), segment i+1 and the mass of point i+1.
        if i + 1 < n {
            let at = &tile.rest[i + 1];
            let length = load(simd, &at[rest::LENGTH]);
            let mass = load(simd, &at[rest::MASS]);
            let real = length.simd_gt(0.0);
            let x2 = if i + 2 < n { V3::load(simd, &tile.state[i + 2][state::X..]) } else { x1 };
            let e1 = x2 - x1;
            let (l1, u1) = e1.length_and_unit();
            let u1 = V3::select(real, u1, zero);
            let beta = real.select(one / length.max(1e-12), nought);

            // d = R_i turn: the frame (normal, binormal, tangent) on segment i.
            let rest_turn = V3::load(simd, &at[rest::TURN..]);
            let d = normal.mul_add(rest_turn.x, u0.cross(normal).mul_add(rest_turn.y, u0 * rest_turn.z));
            let stiffness = load(simd, &at[rest::BEND]);
            let joint = bend((e0, e1), u0, (alpha, beta), d, stiffness, stiffness * implicit_scale);
            band.diag[0] = band.diag[0] + joint.g;
            band.upper[0] = band.upper[0] - joint.q - joint.g;
            band.far = joint.q;
            let q = &joint.q.rows;
            band.diag[1] = band.diag[1] + joint.g;
            band.diag[1].xx += joint.b + q[0].x + q[0].x;
            band.diag[1].yy += joint.b + q[1].y + q[1].y;
            band.diag[1].zz += joint.b + q[2].z + q[2].z;
            band.diag[1].xy += q[0].y + q[1].x;
            band.diag[1].xz += q[0].z + q[2].x;
            band.diag[1].yz += q[1].z + q[2].y;
            let mut bc = joint.q;
            bc.rows[0].x += joint.b;
            bc.rows[1].y += joint.b;
            bc.rows[2].z += joint.b;
            band.upper[1] = band.upper[1] - bc;
            band.diag[2] = band.diag[2].add_identity(joint.b);
            band.rhs[0] += joint.force[0];
            band.rhs[1] += joint.force[1];
            band.rhs[2] += joint.force[2];

            // Its twist.
            if twisted {
                let torque = load(simd, &scratch.factors[i + 1][twist::scratch::TORQUE]);
                let stiffness = load(simd, &scratch.factors[i + 1][twist::scratch::K]) * implicit_scale;
                let t = twist_force((u0, u1), (torque, stiffness), (alpha, beta));
                band.diag[0] = band.diag[0] + t.block * (t.c[0] * t.c[0]);
                band.diag[1] = band.diag[1] + t.block * (t.c[1] * t.c[1]);
                band.diag[2] = band.diag[2] + t.block * (t.c[2] * t.c[2]);
                band.upper[0] = band.upper[0] - t.block * -(t.c[0] * t.c[1]);
                band.upper[1] = band.upper[1] - t.block * -(t.c[1] * t.c[2]);
                band.far = band.far - t.block * -(t.c[0] * t.c[2]);
                band.rhs[0] += t.force[0];
                band.rhs[1] += t.force[1];
                band.rhs[2] += t.force[2];
            }

            // Segment i+1.
            let k = real.select(mass * (STRETCH * inv_h * inv_h), nought);
            let tension = load(simd, &tile.state[i + 1][state::TENSION]);
            let (force, block) = stretch((l1, u1), length, k, tension);
            band.diag[1] = band.diag[1] + block;
            band.upper[1] = band.upper[1] - block;
            band.diag[2] = band.diag[2] + block;
            band.rhs[1] += force;
            band.rhs[2] -= force;

            // Mass, air and gravity of point i+1. Drag along a slender fibre is half of that across it (Batchelor 1970).
            let v = V3::load(simd, &tile.state[i + 1][state::V..]);
            let m_h = mass * inv_h;
            let air = mass * drag;
            let slip = wind - root_velocity;
            let slip = slip - u1 * (u1.dot(slip) * 0.5);
            let inertia = (v - root_velocity) * m_h + slip * air + gravity * mass;
            band.rhs[1] += inertia;
            let across = air * inv_h;
            band.diag[1] = band.diag[1] + super::lanes::Sym3::outer(u1, across * -0.5);
            band.diag[1] = band.diag[1].add_identity(m_h * inv_h + across);

            normal = V3::load(simd, &tile.state[i + 1][state::NORMAL..]);
            (x0, x1, e0, u0, alpha) = (x1, x2, e1, u1, beta);
        }
        if i >= 2 {
            band.eliminate(&mut scratch.factors[i]);
        }
        band.shift(simd);
    }
    let _ = x0;

    let (mut next, mut after) = (zero, zero);
    let mut outer = zero;
    for i in (2..n).rev() {
        let delta = back_substitute(simd, &scratch.factors[i], next, after);
        let x = V3::load(simd, &tile.state[i][state::X..]);
        (x + delta).store(&mut scratch.x[i]);
        if i + 1 < n {
            add_tension(simd, tile, i, (outer - x, next - delta), inv_h);
        }
        (next, after, outer) = (delta, next, x);
    }
    if n > 2 {
        add_tension(simd, tile, 1, (outer - root.first, next), inv_h);
    }
    zero.store(&mut scratch.x[0]);
    root.first.store(&mut scratch.x[1]);
}

/// Adds to the tension of segment `i` what its spring took in the solve: k (ℓ − L + û·(δ_{i+1} − δ_i)).
#[inline(always)]
fn add_tension<S: Simd>(simd: S, tile: &mut Tile, i: usize, (e, stretched): (V3<S>, V3<S>), inv_h: f32) {
    let at = &tile.rest[i];
    let length = load(simd, &at[rest::LENGTH]);
    let k = load(simd, &at[rest::MASS]) * (STRETCH * inv_h * inv_h);
    let (l, u) = e.length_and_unit();
    let row = &mut tile.state[i][state::TENSION];
    let tension = load(simd, row) + k * (l - length + u.dot(stretched));
    store(length.simd_gt(0.0).select(tension, F::splat(simd, 0.0)), row);
}
