//! Reference implementation of a substep's solve for one strand, in scalar f64 with a dense matrix. Tests
//! compare the SIMD kernel with it.
//!
//! It is derived from the energies, not from the kernel: every block comes from finite differences or outer
//! products of plain gradients, and a dense Cholesky factorization solves the system.

use super::{
    drag::normal_coefficient,
    model::{
        rod::{FOLDING, curved_joint},
        stretch::{SIDEWAYS, STRETCH, sideways},
    },
};
use glam::{DMat3, DQuat, DVec3};

/// One strand in one substep, in f64.
#[derive(Clone)]
pub struct Strand {
    pub x: Vec<DVec3>,
    pub v: Vec<DVec3>,
    pub length: Vec<f64>,
    pub mass: Vec<f64>,
    pub bend: Vec<f64>,
    /// Rest turn of each joint in the frame (normal, binormal, tangent) of the segment before it.
    pub turn: Vec<DVec3>,
    pub tension: Vec<f64>,
    /// Multipliers of drag and damping at each point.
    pub along: Vec<[f64; 2]>,
    pub drag: f64,
    /// Reynolds number over speed [s/m].
    pub reynolds: f64,
    pub damping: f64,
    pub gravity: DVec3,
    pub wind: DVec3,
    /// Displacement of the root in the substep [m].
    pub moved: DVec3,
    pub h: f64,
}

/// `v` rotated by the smallest rotation from `a` to `b`, both unit vectors: Rodrigues' formula with a × b and
/// a · b. It is smooth where the two coincide, as differences across a joint require;
/// `DQuat::from_rotation_arc` rounds small angles to zero there.
fn swung(a: DVec3, b: DVec3, v: DVec3) -> DVec3 {
    let (c, s) = (a.dot(b), a.cross(b));
    v * c + s.cross(v) + s * (s.dot(v) / (1.0 + c))
}

/// r of a joint. The rest turn follows the first segment by the smallest rotation from its old direction
/// `was`.
pub fn residual(x: [DVec3; 3], lengths: [f64; 2], was: DVec3, turn: DVec3) -> DVec3 {
    let (e0, e1) = (x[1] - x[0], x[2] - x[1]);
    e1 / lengths[1] - e0 / lengths[0] - swung(was, e0.normalize(), turn)
}

/// Bending energy of a joint [J].
pub fn bend_energy(x: [DVec3; 3], lengths: [f64; 2], was: DVec3, turn: DVec3, stiffness: f64) -> f64 {
    0.5 * stiffness * residual(x, lengths, was, turn).length_squared()
}

/// GJ/EI of the strands in the tests.
pub const TWIST_RATIO: f64 = 0.46;

/// The strains of a joint: three of bending in the frame of the first segment, and twist as 4 tan(φ/4), faded
/// out near a fold.
///
/// The two segments have frames with the normals `m0` and `m1` at the positions `x0`. A frame follows its
/// segment by the smallest rotation, and rotates about it by `angles`.
fn strains(
    x0: [DVec3; 3],
    normals: [DVec3; 2],
    x: [DVec3; 3],
    angles: [f64; 2],
    lengths: [f64; 2],
    turn: DVec3,
) -> [f64; 4] {
    let was = [(x0[1] - x0[0]).normalize(), (x0[2] - x0[1]).normalize()];
    let (e0, e1) = (x[1] - x[0], x[2] - x[1]);
    let (u0, u1) = (e0.normalize(), e1.normalize());
    let frame =
        |was: DVec3, u: DVec3, m: DVec3, angle: f64| DQuat::from_axis_angle(u, angle) * swung(was, u, m);
    let (m0, m1) = (frame(was[0], u0, normals[0], angles[0]), frame(was[1], u1, normals[1], angles[1]));
    let d = m0 * turn.x + u0.cross(m0) * turn.y + u0 * turn.z;
    let r = e1 / lengths[1] - e0 / lengths[0] - d;
    let carried = swung(u0, u1, m0);
    let tau = 4.0 * (0.25 * carried.cross(m1).dot(u1).atan2(carried.dot(m1))).tan();
    let z = ((1.0 + u0.dot(u1)) / FOLDING as f64).min(1.0);
    [r.x, r.y, r.z, z * (2.0 - z) * tau]
}

/// Energy of bending and twisting [J] of a strand at `x`. The frames of its segments had these `normals` at
/// `x0`.
pub fn elastic_energy(s: &Strand, normals: &[DVec3], x0: &[DVec3], x: &[DVec3]) -> f64 {
    let joint = |j: usize| {
        let at = |x: &[DVec3]| [x[j - 1], x[j], x[j + 1]];
        let lengths = [s.length[j - 1], s.length[j]];
        let strains = strains(at(x0), [normals[j - 1], normals[j]], at(x), [0.0; 2], lengths, s.turn[j]);
        let stiffness =
            [1.0, 1.0, 1.0, TWIST_RATIO * curved_joint(s.turn[j].z)].map(|ratio| ratio * s.bend[j]);
        strains.iter().zip(stiffness).map(|(strain, k)| 0.5 * k * strain * strain).sum::<f64>()
    };
    (1..s.x.len() - 1).map(joint).sum()
}

/// Gradients of these strains with respect to three displacements and two angles.
fn gradients(x: [DVec3; 3], normals: [DVec3; 2], lengths: [f64; 2], turn: DVec3) -> [[f64; 4]; 11] {
    let mut out = [[0.0; 4]; 11];
    for (k, out) in out.iter_mut().enumerate() {
        let step = if k < 9 { 1e-6 * lengths[0] } else { 1e-6 };
        let at = |s: f64| {
            let (mut y, mut angles) = (x, [0.0; 2]);
            if k < 9 {
                y[k / 3][k % 3] += s
            } else {
                angles[k - 9] += s
            }
            strains(x, normals, y, angles, lengths, turn)
        };
        let (a, b) = (at(step), at(-step));
        *out = [0, 1, 2, 3].map(|c| (a[c] - b[c]) / (2.0 * step));
    }
    out
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

impl Strand {
    /// Positions relative to the root after the linearized backward Euler solve. `normals` are those of the
    /// segments at its start. With `twists`, angles are among the unknowns.
    pub fn solve(&self, normals: &[DVec3], twists: bool) -> Vec<DVec3> {
        let n = self.x.len();
        let mut a = vec![vec![DMat3::ZERO; n]; n];
        let mut b = vec![DVec3::ZERO; n];
        for i in 0..n {
            let u = if i + 1 < n { (self.x[i + 1] - self.x[i]).normalize() } else { DVec3::ZERO };
            let slip = self.wind - self.v[i];
            let root = ((slip - u * u.dot(slip)).length() * self.reynolds).sqrt();
            let normal = f64::from(normal_coefficient(root as f32));
            let tangential = (0.5 * normal).min(0.7 + 2.7 * root);
            let across = DMat3::IDENTITY * normal - outer(u, u) * (normal - tangential);
            let around = 0.5 * (self.length[i.saturating_sub(1)] + self.length[i]);
            let air = across * (around * self.drag * self.along[i][0]);
            a[i][i] += DMat3::IDENTITY * (self.mass[i] / (self.h * self.h)) + air * (1.0 / self.h);
            b[i] += (self.v[i] * self.h - self.moved) * (self.mass[i] / (self.h * self.h))
                + air * (self.wind - self.moved / self.h)
                + self.gravity * self.mass[i];
        }
        for i in 1..n - 1 {
            let (e, rest) = (self.x[i + 1] - self.x[i], self.length[i]);
            let (l, u) = (e.length(), e.normalize());
            let k = STRETCH as f64 * self.mass[i] / (self.h * self.h);
            let pull = k * (l - rest) + self.tension[i];
            let side = (pull.max(self.tension[i]) / l).clamp(0.0, k);
            let tense = (self.tension[i] / l).clamp(0.0, k);
            let turned = sideways(SIDEWAYS.into(), false, tense, (self.mass[i + 1], self.h));
            // The matrix acts on the whole displacement. The tension is linearized at a share of the
            // predicted displacement, and at everything that the solve adds to it. Driven points move with
            // the root.
            let inner = if i < 2 { self.v[0] } else { self.v[i] };
            let drift = (self.v[i + 1] - inner) * self.h;
            let force = u * pull + (drift - u * u.dot(drift)) * (turned - side);
            let block = outer(u, u) * (k - side) + DMat3::IDENTITY * side;
            b[i] += force;
            b[i + 1] -= force;
            a[i][i] += block;
            a[i + 1][i + 1] += block;
            a[i][i + 1] -= block;
            a[i + 1][i] -= block;
        }
        // Unknowns: three displacements a point, then one angle a segment.
        let size = 4 * n;
        let mut full = vec![vec![0.0; size]; size];
        let mut right = vec![0.0; size];
        for i in 0..n {
            for j in 0..n {
                for (r, c) in (0..9).map(|k| (k / 3, k % 3)) {
                    full[3 * i + r][3 * j + c] = a[i][j].col(c)[r];
                }
            }
            for k in 0..3 {
                right[3 * i + k] = b[i][k];
            }
        }
        for j in 1..n - 1 {
            let x = [self.x[j - 1], self.x[j], self.x[j + 1]];
            let lengths = [self.length[j - 1], self.length[j]];
            let frames = [normals[j - 1], normals[j]];
            let strain = strains(x, frames, x, [0.0; 2], lengths, self.turn[j]);
            let gradient = gradients(x, frames, lengths, self.turn[j]);
            let at = |k: usize| if k < 9 { 3 * (j - 1) + k } else { 3 * n + j - 1 + (k - 9) };
            for c in 0..if twists { 4 } else { 3 } {
                let ratio = if c < 3 { 1.0 } else { TWIST_RATIO * curved_joint(self.turn[j].z) };
                let stiffness = ratio * self.bend[j];
                let implicit = stiffness * (1.0 + self.damping * self.along[j][1] / self.h);
                // The linearized twist: its force has the gradient, its matrix the outer product of the
                // gradient.
                for p in 0..11 {
                    right[at(p)] -= gradient[p][c] * strain[c] * stiffness;
                    for q in 0..11 {
                        full[at(p)][at(q)] += gradient[p][c] * gradient[q][c] * implicit;
                    }
                }
            }
        }
        // Driven: the first two points and the first angle. No segment begins at the tip.
        let free: Vec<usize> = (6..3 * n).chain(if twists { 3 * n + 1..size - 1 } else { 0..0 }).collect();
        let matrix: Vec<Vec<f64>> =
            free.iter().map(|i| free.iter().map(|j| full[*i][*j]).collect()).collect();
        let delta = dense_solve(&matrix, &free.iter().map(|i| right[*i]).collect::<Vec<_>>());
        let mut x = self.x.clone();
        for (i, d) in free.iter().zip(delta).filter(|(i, _)| **i < 3 * n) {
            x[i / 3][i % 3] += d;
        }
        x
    }
}

/// Solves a symmetric positive definite system by dense Cholesky.
pub fn dense_solve(a: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            l[i][j] = if i == j {
                let d = a[i][i] - sum;
                assert!(d > 0.0, "the matrix is positive definite");
                d.sqrt()
            } else {
                (a[i][j] - sum) / l[j][j]
            };
        }
    }
    let mut y = vec![0.0; n];
    for i in 0..n {
        y[i] = (b[i] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..n).rev() {
        y[i] = (y[i] - (i + 1..n).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
    }
    y
}
