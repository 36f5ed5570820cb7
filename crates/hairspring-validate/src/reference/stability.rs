//! When a strand that bends in a plane leaves it: the sign of the energy's second variation.
//!
//! **In the plane.** With θ the angle from straight down, L = 1, B the bending stiffness in the plane, κ the natural curvature and
//! F(s) = Γ(1 − s) + α what hangs below s, the shape is a minimum of ∫ ½B(θ' − κ)² − F cos θ:
//!
//! ```text
//! B θ'' = F sin θ,      θ(0) = θ₀,  θ'(1) = κ
//! ```
//!
//! found by Newton steps on equal segments, the natural curvature raised from 0 so that it is the shape that a straight strand curls to.
//!
//! **Out of it.** A small turn (w₁, 0, w₃) of the frame (in-plane normal, binormal, tangent), with b the bending stiffness out of
//! the plane, C that of twist and m = B(θ' − κ), changes the energy by half of (Ω → Ω + δ + ½ δ×w, δ = w' + Ω×w)
//!
//! ```text
//! ∫ b δ₁² + C δ₃² + m (δ₃ w₁ − δ₁ w₃) + F (cos θ w₁² + sin θ w₁ w₃) ds,     δ₁ = w₁' + θ' w₃,  δ₃ = w₃' − θ' w₁
//! ```
//!
//! with w(0) = 0 and the tip free. On the same segments it is a block-tridiagonal matrix, and the plane shape is stable while that is
//! positive definite (all pivots of its elimination are positive; Jacobi's condition). Both are of second order in the segment, so that two
//! resolutions give the limit (Richardson 1911).

use super::bisect;

/// A strand in its plane, of length 1 and, but for the three stiffnesses, in units of any one of them.
#[derive(Clone, Copy, Debug)]
pub struct Strand {
    /// Direction of the clamp from straight down [rad]: 0 hangs, π/2 lies, π stands.
    pub clamp: f64,
    /// Bending stiffness in the plane.
    pub in_plane: f64,
    /// Bending stiffness out of it.
    pub out_of_plane: f64,
    /// Twisting stiffness.
    pub twist: f64,
    /// Natural curvature κL [rad], in the plane.
    pub curvature: f64,
}

/// Weight and tip load of a strand in the same units.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Own weight times the square of the length.
    pub weight: f64,
    /// Dead load at the tip times the square of the length.
    pub tip: f64,
}

impl Load {
    fn below(&self, s: f64) -> f64 {
        self.weight * (1.0 - s) + self.tip
    }
}

/// The angle at both ends of each of `n` segments in balance, shape `[n + 1]`.
pub fn plane_shape(strand: &Strand, load: Load, n: usize) -> Vec<f64> {
    let mut theta = vec![strand.clamp; n + 1];
    let stages = 1 + strand.curvature.abs().ceil() as usize * 2;
    for stage in 1..=stages {
        relax(&mut theta, strand, strand.curvature * stage as f64 / stages as f64, load);
    }
    theta
}

/// Brings the angles into balance, from a shape nearby, under the natural curvature `natural`.
fn relax(theta: &mut [f64], strand: &Strand, natural: f64, load: Load) {
    let n = theta.len() - 1;
    let h = 1.0 / n as f64;
    let (mut c, mut d) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    for _ in 0..50 {
        // Elimination from the clamp: Δ_i = c_i Δ_{i+1} + d_i, all times h.
        for i in 1..=n {
            let s = i as f64 * h;
            let last = i == n;
            let share = if last { 0.5 } else { 1.0 };
            let pull = load.below(s) * h * h * share;
            let (sin, cos) = theta[i].sin_cos();
            let back = strand.in_plane * (theta[i] - theta[i - 1] - natural * h);
            let ahead = if last { 0.0 } else { strand.in_plane * (theta[i + 1] - theta[i] - natural * h) };
            let residual = ahead - back - pull * sin;
            let stiffness = strand.in_plane * if last { 1.0 } else { 2.0 } + pull * cos;
            let pivot = stiffness - strand.in_plane * c[i - 1];
            c[i] = strand.in_plane / pivot;
            d[i] = (residual + strand.in_plane * d[i - 1]) / pivot;
        }
        let (mut delta, mut largest) = (0.0, 0.0f64);
        for i in (1..=n).rev() {
            delta = d[i] + if i == n { 0.0 } else { c[i] * delta };
            // No step turns a segment by more than a fraction of a radian: Newton is only to be believed nearby.
            theta[i] += delta.clamp(-0.3, 0.3);
            largest = largest.max(delta.abs());
        }
        if largest < 1e-11 {
            break;
        }
    }
}

/// Whether the plane shape `theta` under `load` is stable against leaving the plane.
fn is_stable(theta: &[f64], strand: &Strand, load: Load) -> bool {
    let n = theta.len() - 1;
    let h = 1.0 / n as f64;
    // Pivot block of the node before, [11, 13, 33]; the clamp is no unknown.
    let mut before: Option<[f64; 3]> = None;
    for i in 0..n {
        let k = (theta[i + 1] - theta[i]) / h;
        let m = strand.in_plane * (k - strand.curvature);
        let f = load.below((i as f64 + 0.5) * h);
        let (sin, cos) = (0.5 * (theta[i] + theta[i + 1])).sin_cos();
        // Midpoint rule; each row is a linear function of (w₁, w₃ at the start, w₁, w₃ at the end).
        let w1 = [0.5, 0.0, 0.5, 0.0];
        let w3 = [0.0, 0.5, 0.0, 0.5];
        let d1 = [-1.0 / h, 0.5 * k, 1.0 / h, 0.5 * k];
        let d3 = [-0.5 * k, -1.0 / h, -0.5 * k, 1.0 / h];
        let mut a = [[0.0; 4]; 4];
        for r in 0..4 {
            for c in 0..4 {
                let both = |x: &[f64; 4], y: &[f64; 4]| 0.5 * (x[r] * y[c] + x[c] * y[r]);
                a[r][c] = h
                    * (strand.out_of_plane * both(&d1, &d1)
                        + strand.twist * both(&d3, &d3)
                        + m * (both(&d3, &w1) - both(&d1, &w3))
                        + f * (cos * both(&w1, &w1) + sin * both(&w1, &w3)));
            }
        }
        let mut next = [a[2][2], a[2][3], a[3][3]];
        if let Some([p, q, r]) = before {
            // The node before is complete: its pivot must be positive, and is eliminated.
            let (p, q, r) = (p + a[0][0], q + a[0][1], r + a[1][1]);
            let determinant = p * r - q * q;
            if !(p > 0.0 && determinant > 0.0) {
                return false;
            }
            let inverse = [[r / determinant, -q / determinant], [-q / determinant, p / determinant]];
            let mut schur = |at: usize, x: usize, y: usize| {
                for u in 0..2 {
                    for v in 0..2 {
                        next[at] -= a[2 + x][u] * inverse[u][v] * a[v][2 + y];
                    }
                }
            };
            schur(0, 0, 0);
            schur(1, 0, 1);
            schur(2, 1, 1);
        }
        before = Some(next);
    }
    before.is_some_and(|[p, q, r]| p > 0.0 && p * r - q * q > 0.0)
}

/// The load `at(λ)` at which the plane shape loses its stability, looked for from `λ` = `stable` on by steps of the factor `step`
/// (above 1 for growing loads, below for falling ones); `None` where it stays stable over the whole search.
pub fn threshold(strand: &Strand, stable: f64, step: f64, at: impl Fn(f64) -> Load) -> Option<f64> {
    // A curl's tip is a boundary layer as short as its radius.
    let coarse = 200 + 20 * strand.curvature.abs() as usize;
    let find = |n: usize, from: f64| {
        let mut theta = plane_shape(strand, at(from), n);
        // Each shape is found from the one before.
        let mut is_stable = |lambda: f64| {
            relax(&mut theta, strand, strand.curvature, at(lambda));
            is_stable(&theta, strand, at(lambda))
        };
        let mut good = from;
        for _ in 0..300 {
            let next = good * step;
            if !is_stable(next) {
                return Some(bisect(good, next, |lambda| if is_stable(lambda) { 1.0 } else { -1.0 }));
            }
            good = next;
        }
        None
    };
    let first = find(coarse, stable)?;
    let second = find(2 * coarse, first / step / step)?;
    Some(second + (second - first) / 3.0)
}

/// Γ below which the plane shape of a hanging curl of natural curvature `curl` = κL and `ratio` = GJ/EI leaves its plane
/// (bend-twist); `None` where it never does.
pub fn curl_threshold(curl: f64, ratio: f64) -> Option<f64> {
    let strand = Strand { clamp: 0.0, in_plane: 1.0, out_of_plane: 1.0, twist: ratio, curvature: curl };
    // Curls that never leave the plane by 10⁻³ of the weight that scales with them do so by none.
    let (heavy, light) = (4.0 * curl.powi(3) / ratio, 1e-3f64);
    let at = |weight: f64| Load { weight, tip: 0.0 };
    let step = light.powf(1.0 / 300.0).max(0.97);
    threshold(&strand, heavy, step, at)
}

/// Γ at which an upright strand gives way under its own weight (Greenhill 1881: the first zero of J₋⅓(⅔√Γ)).
pub fn greenhill() -> f64 {
    let strand =
        Strand { clamp: std::f64::consts::PI, in_plane: 1.0, out_of_plane: 1.0, twist: 1.0, curvature: 0.0 };
    // Standing straight is always a balance, and always stable for a light strand.
    threshold(&strand, 1.0, 1.1, |weight| Load { weight, tip: 0.0 }).unwrap_or(f64::INFINITY)
}

/// A horizontal strand with the bending stiffnesses `weak` sideways and `strong` in its vertical plane, and `twist`.
pub fn flat(weak: f64, strong: f64, twist: f64) -> Strand {
    Strand { clamp: std::f64::consts::FRAC_PI_2, in_plane: strong, out_of_plane: weak, twist, curvature: 0.0 }
}

/// Load at which a [`flat`] strand tips over sideways (Prandtl 1899, Michell 1899), where the load consists of `weight` parts of own weight
/// (times L²) and `tip` parts of dead load at the tip (times L²).
pub fn lateral(strand: &Strand, weight: f64, tip: f64) -> Option<f64> {
    let unit = (strand.out_of_plane * strand.twist).sqrt();
    threshold(strand, 0.5 * unit, 1.1, |load| Load { weight: weight * load, tip: tip * load })
}
