//! What is true: the closed forms, computed in f64 for any parameter and without a line of the simulation.
//!
//! Differential equations are shot at or discretised by hand (a fourth-order Runge–Kutta and a bisection are all they
//! need); no table is stored. The tables of the literature stand in the tests, and these functions answer to them.

pub mod beam;
pub mod catenary;
pub mod chain;
pub mod column;
pub mod cylinder;
pub mod elastica;
pub mod elliptic;
pub mod helix;
pub mod pendulum;
pub mod ring;
pub mod stability;

#[cfg(test)]
mod tests;

/// The place where `f` changes its sign between `a` and `b`, to the last digits of f64.
///
/// `f` may return infinities; a NaN counts as positive. Where the sign is the same at both ends, one of them comes back.
pub fn bisect(mut a: f64, mut b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let negative = f(a) < 0.0;
    // The interval halves each time, so that 80 times exhaust the digits of any start that is not absurdly wide.
    for _ in 0..80 {
        let middle = 0.5 * (a + b);
        if middle == a || middle == b {
            break;
        }
        if (f(middle) < 0.0) == negative {
            a = middle;
        } else {
            b = middle;
        }
    }
    0.5 * (a + b)
}

/// The first `count` places above `start` where `f` changes its sign, looked for in steps of `step`, which must be shorter
/// than the distance of two neighbours; fewer where there are no more below `start + step × 100,000`.
pub fn first_roots(start: f64, step: f64, count: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut roots = Vec::with_capacity(count);
    let (mut a, mut fa) = (start, f(start));
    for k in 1..=100_000 {
        if roots.len() == count {
            break;
        }
        let b = start + step * k as f64;
        let fb = f(b);
        if (fa < 0.0) != (fb < 0.0) {
            roots.push(bisect(a, b, &f));
        }
        (a, fa) = (b, fb);
    }
    roots
}

/// Integrates y' = `f`(s, y) from s = 0 to 1 in `steps` equal steps of the classical fourth-order Runge–Kutta method; ends early
/// once `stop` holds.
pub fn integrate<const N: usize>(
    mut y: [f64; N],
    steps: usize,
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    stop: impl Fn(&[f64; N]) -> bool,
) -> [f64; N] {
    let h = 1.0 / steps as f64;
    let along = |y: &[f64; N], k: &[f64; N], t: f64| std::array::from_fn(|i| y[i] + t * k[i]);
    for step in 0..steps {
        let s = step as f64 * h;
        let k1 = f(s, &y);
        let k2 = f(s + 0.5 * h, &along(&y, &k1, 0.5 * h));
        let k3 = f(s + 0.5 * h, &along(&y, &k2, 0.5 * h));
        let k4 = f(s + h, &along(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if stop(&y) {
            break;
        }
    }
    y
}
