//! The substep's solve again, for one strand, in scalar f64 and with a dense matrix: what the SIMD kernel is held against.
//!
//! Written from the energies, not from the kernel: every block comes from finite differences or outer products of plain
//! gradients, the system is solved by a dense Cholesky.

use super::stretch::STRETCH;
use glam::{DMat3, DQuat, DVec3};

/// One strand in one substep, in f64.
pub struct Strand {
    pub x: Vec<DVec3>,
    pub v: Vec<DVec3>,
    pub length: Vec<f64>,
    pub mass: Vec<f64>,
    pub bend: Vec<f64>,
    /// Rest turn of each joint in the frame (normal, binormal, tangent) of the segment before it.
    pub turn: Vec<DVec3>,
    pub tension: Vec<f64>,
    pub drag: f64,
    pub damping: f64,
    pub gravity: DVec3,
    pub wind: DVec3,
    /// The root's own displacement in the substep.
    pub moved: DVec3,
    pub h: f64,
}

/// r of a joint: the rest turn swings with the first segment by the least rotation from where it was.
pub fn residual(x: [DVec3; 3], lengths: [f64; 2], was: DVec3, turn: DVec3) -> DVec3 {
    let (e0, e1) = (x[1] - x[0], x[2] - x[1]);
    let swing = DQuat::from_rotation_arc(was, e0.normalize());
    e1 / lengths[1] - e0 / lengths[0] - swing * turn
}

/// Bending energy of a joint [J].
pub fn bend_energy(x: [DVec3; 3], lengths: [f64; 2], was: DVec3, turn: DVec3, stiffness: f64) -> f64 {
    0.5 * stiffness * residual(x, lengths, was, turn).length_squared()
}

/// ∂r/∂x_k by central differences.
fn jacobian(x: [DVec3; 3], lengths: [f64; 2], was: DVec3, turn: DVec3) -> [DMat3; 3] {
    let step = 1e-6 * lengths[0];
    [0, 1, 2].map(|k| {
        let column = |axis: DVec3| {
            let at = |s: f64| {
                let mut y = x;
                y[k] += axis * s;
                residual(y, lengths, was, turn)
            };
            (at(step) - at(-step)) / (2.0 * step)
        };
        DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
    })
}

/// GJ/EI of the strands in the tests.
pub const TWIST_RATIO: f64 = 0.46;

/// The twist from the normal `m0`, carried by the least rotation, to `m1`, as 2 tan(τ/2), and its gradient by central differences; the normals
/// swing with their segments.
fn twist(x: [DVec3; 3], was: DVec3, m0: DVec3, m1: DVec3) -> (f64, [DVec3; 3]) {
    let was1 = (x[2] - x[1]).normalize();
    let angle = |x: [DVec3; 3]| {
        let (u0, u1) = ((x[1] - x[0]).normalize(), (x[2] - x[1]).normalize());
        let carried = DQuat::from_rotation_arc(u0, u1) * (DQuat::from_rotation_arc(was, u0) * m0);
        let m1 = DQuat::from_rotation_arc(was1, u1) * m1;
        2.0 * (0.5 * carried.cross(m1).dot(u1).atan2(carried.dot(m1))).tan()
    };
    let gradient = [0, 1, 2].map(|k| {
        DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let at = |s: f64| {
                let mut y = x;
                y[k] += axis * s;
                angle(y)
            };
            (at(1e-8) - at(-1e-8)) / 2e-8
        }))
    });
    (angle(x), gradient)
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

impl Strand {
    /// Positions relative to the root after the linearised backward Euler solve, with these normals on the segments.
    pub fn solve(&self, normals: &[DVec3]) -> Vec<DVec3> {
        let n = self.x.len();
        let mut a = vec![vec![DMat3::ZERO; n]; n];
        let mut b = vec![DVec3::ZERO; n];
        for i in 0..n {
            let u = if i + 1 < n { (self.x[i + 1] - self.x[i]).normalize() } else { DVec3::ZERO };
            let across = DMat3::IDENTITY - outer(u, u) * 0.5;
            let air = across * (self.mass[i] * self.drag);
            a[i][i] += DMat3::IDENTITY * (self.mass[i] / (self.h * self.h)) + air * (1.0 / self.h);
            b[i] += (self.v[i] * self.h - self.moved) * (self.mass[i] / (self.h * self.h))
                + air * (self.wind - self.moved / self.h)
                + self.gravity * self.mass[i];
        }
        for i in 1..n - 1 {
            let (e, rest) = (self.x[i + 1] - self.x[i], self.length[i]);
            let (l, u) = (e.length(), e.normalize());
            let k = STRETCH as f64 * self.mass[i] / (self.h * self.h);
            let force = u * (k * (l - rest) + self.tension[i]);
            let taut = self.tension[i] / l - 0.25 * self.mass[i] / (self.h * self.h);
            let side = (k * (1.0 - rest / l)).max(taut).clamp(0.0, k);
            let block = outer(u, u) * (k - side) + DMat3::IDENTITY * side;
            b[i] += force;
            b[i + 1] -= force;
            a[i][i] += block;
            a[i + 1][i + 1] += block;
            a[i][i + 1] -= block;
            a[i + 1][i] -= block;
        }
        for j in 1..n - 1 {
            let x = [self.x[j - 1], self.x[j], self.x[j + 1]];
            let lengths = [self.length[j - 1], self.length[j]];
            let was = (x[1] - x[0]).normalize();
            let (m, local) = (normals[j - 1], self.turn[j]);
            let turn = m * local.x + was.cross(m) * local.y + was * local.z;
            let r = residual(x, lengths, was, turn);
            let jacobian = jacobian(x, lengths, was, turn);
            let (angle, swing) = twist(x, was, normals[j - 1], normals[j]);
            let stiffness = TWIST_RATIO * self.bend[j];
            for p in 0..3 {
                b[j - 1 + p] -= jacobian[p].transpose() * r * self.bend[j] + swing[p] * (stiffness * angle);
                for q in 0..3 {
                    let implicit = self.bend[j] * (1.0 + self.damping / self.h);
                    a[j - 1 + p][j - 1 + q] += jacobian[p].transpose() * jacobian[q] * implicit
                        + outer(swing[p], swing[q]) * (stiffness * (1.0 + self.damping / self.h));
                }
            }
        }
        let delta = dense_solve(&a[2..].iter().map(|row| row[2..].to_vec()).collect::<Vec<_>>(), &b[2..]);
        let mut x = self.x.clone();
        x[2..].iter_mut().zip(delta).for_each(|(x, d)| *x += d);
        x
    }
}

/// Solves a symmetric positive definite block system by dense Cholesky.
pub fn dense_solve(a: &[Vec<DMat3>], b: &[DVec3]) -> Vec<DVec3> {
    let n = 3 * b.len();
    let at = |i: usize, j: usize| a[i / 3][j / 3].col(j % 3)[i % 3];
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            l[i][j] = if i == j {
                let d = at(i, i) - sum;
                assert!(d > 0.0, "the matrix is positive definite");
                d.sqrt()
            } else {
                (at(i, j) - sum) / l[j][j]
            };
        }
    }
    let mut y = vec![0.0; n];
    for i in 0..n {
        y[i] = (b[i / 3][i % 3] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..n).rev() {
        y[i] = (y[i] - (i + 1..n).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
    }
    y.chunks(3).map(DVec3::from_slice).collect()
}
