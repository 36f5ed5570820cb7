//! Out-of-plane stability of a strand that bends in a plane, from the sign of the energy's second variation.
//!
//! **In the plane.** θ is the angle from straight down, L = 1, B the bending stiffness in the plane, κ the
//! natural curvature, and F(s) = Γ(1 − s) + α the load that hangs below s. The shape is a minimum of ∫ ½B(θ'
//! − κ)² − F cos θ:
//!
//! ```text
//! B θ'' = F sin θ,      θ(0) = θ₀,  θ'(1) = κ
//! ```
//!
//! It is computed by Newton steps on equal segments. The natural curvature is increased from 0, to find the
//! shape that a straight strand curls into.
//!
//! **Out of the plane.** A small rotation (w₁, 0, w₃) of the frame (in-plane normal, binormal, tangent)
//! changes the energy. b is the bending stiffness out of the plane, C that of twist, and m = B(θ' − κ). The
//! change is half of (Ω → Ω + δ + ½ δ×w, δ = w' + Ω×w)
//!
//! ```text
//! ∫ b δ₁² + C δ₃² + m (δ₃ w₁ − δ₁ w₃) + F (cos θ w₁² + sin θ w₁ w₃) ds,     δ₁ = w₁' + θ' w₃,  δ₃ = w₃' − θ' w₁
//! ```
//!
//! with w(0) = 0 and the tip free. On the same segments it is a block-tridiagonal matrix. The planar shape is
//! stable while that matrix is positive definite, which holds if all pivots of its elimination are positive
//! (Jacobi's condition). Both discretizations are of second order in the segment length, so two resolutions
//! give the limit (Richardson 1911).

use super::bisect;

/// A planar strand of length 1. The three stiffnesses share an arbitrary unit.
#[derive(Clone, Copy, Debug)]
pub struct Strand {
    /// Direction of the clamp from straight down [rad]: 0 hangs, π/2 is horizontal, π is upright.
    pub clamp: f64,
    /// Bending stiffness in the plane.
    pub in_plane: f64,
    /// Bending stiffness out of the plane.
    pub out_of_plane: f64,
    /// Twisting stiffness.
    pub twist: f64,
    /// Natural curvature κL [rad], in the plane.
    pub curvature: f64,
}

/// Weight and tip load of a strand, in the same unit.
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

/// Returns the equilibrium angles at the ends of each of `n` segments, shape `[n + 1]`.
pub fn plane_shape(strand: &Strand, load: Load, n: usize) -> Vec<f64> {
    let mut theta = vec![strand.clamp; n + 1];
    let stages = 1 + strand.curvature.abs().ceil() as usize * 2;
    for stage in 1..=stages {
        relax(&mut theta, strand, strand.curvature * stage as f64 / stages as f64, load);
    }
    theta
}

/// Brings the angles into equilibrium, from a nearby shape, under the natural curvature `natural`.
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
            // The rotation of a segment per step is limited to a fraction of a radian, because Newton's
            // method only converges nearby.
            theta[i] += delta.clamp(-0.3, 0.3);
            largest = largest.max(delta.abs());
        }
        if largest < 1e-11 {
            break;
        }
    }
}

/// Returns whether the planar shape `theta` under `load` is stable against leaving the plane.
fn is_stable(theta: &[f64], strand: &Strand, load: Load) -> bool {
    let n = theta.len() - 1;
    let h = 1.0 / n as f64;
    // Pivot block of the previous node, [11, 13, 33]. The clamp is not an unknown.
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
            // The previous node is complete: its pivot must be positive, and it is eliminated.
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

/// Returns the load parameter λ at which the planar shape loses its stability under the load `at(λ)`. The
/// search starts from `stable` and multiplies by `step` (above 1 for increasing loads, below 1 for decreasing
/// ones). Returns `None` if the shape stays stable over the whole search.
pub fn threshold(strand: &Strand, stable: f64, step: f64, at: impl Fn(f64) -> Load) -> Option<f64> {
    // The tip of a curl is a boundary layer as short as the curl's radius.
    let coarse = 200 + 20 * strand.curvature.abs() as usize;
    let find = |n: usize, from: f64| {
        let mut theta = plane_shape(strand, at(from), n);
        // Each shape starts from the previous one.
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

/// Γ below which a hanging curl with natural curvature `curl` = κL and `ratio` = GJ/EI leaves its plane
/// (bend-twist); `None` if it never does.
pub fn curl_threshold(curl: f64, ratio: f64) -> Option<f64> {
    let strand = Strand { clamp: 0.0, in_plane: 1.0, out_of_plane: 1.0, twist: ratio, curvature: curl };
    // A curl that is still stable at 10⁻³ is stable at any weight.
    let (heavy, light) = (4.0 * curl.powi(3) / ratio, 1e-3f64);
    let at = |weight: f64| Load { weight, tip: 0.0 };
    let step = light.powf(1.0 / 300.0).max(0.97);
    threshold(&strand, heavy, step, at)
}

/// Γ at which an upright strand buckles under its own weight (Greenhill 1881: the first zero of J₋⅓(⅔√Γ)).
pub fn greenhill() -> f64 {
    let strand =
        Strand { clamp: std::f64::consts::PI, in_plane: 1.0, out_of_plane: 1.0, twist: 1.0, curvature: 0.0 };
    // Standing straight is always an equilibrium, and stable for a light strand.
    threshold(&strand, 1.0, 1.1, |weight| Load { weight, tip: 0.0 }).unwrap_or(f64::INFINITY)
}

/// A horizontal strand with the bending stiffness `weak` sideways and `strong` in its vertical plane, and the
/// twisting stiffness `twist`.
pub fn flat(weak: f64, strong: f64, twist: f64) -> Strand {
    Strand { clamp: std::f64::consts::FRAC_PI_2, in_plane: strong, out_of_plane: weak, twist, curvature: 0.0 }
}

/// Load at which a [`flat`] strand buckles laterally (Prandtl 1899, Michell 1899). The load consists of
/// `weight` parts of own weight (times L²) and `tip` parts of dead load at the tip (times L²).
pub fn lateral(strand: &Strand, weight: f64, tip: f64) -> Option<f64> {
    let unit = (strand.out_of_plane * strand.twist).sqrt();
    threshold(strand, 0.5 * unit, 1.1, |load| Load { weight: weight * load, tip: tip * load })
}
