//! Reference solutions: closed forms, computed in f64 for any parameter and without code of the simulation.
//!
//! Differential equations are solved by shooting or by manual discretization; a fourth-order Runge–Kutta
//! method and a bisection are enough. No table is stored. The tests compare the functions with the tables of
//! the literature.

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

/// Returns where `f` changes its sign between `a` and `b`, to the precision of f64.
///
/// `f` may return infinities; a NaN counts as positive. If the sign is the same at both ends, the result is
/// one of them.
pub fn bisect(mut a: f64, mut b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let negative = f(a) < 0.0;
    // The interval is halved each time, so 80 iterations reach the precision of f64 unless the start is
    // extremely wide.
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

/// Returns the first `count` places above `start` where `f` changes its sign. The search uses steps of
/// `step`, which must be shorter than the distance between neighboring roots. Returns fewer if there are no
/// more below `start + step × 100,000`.
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

/// Integrates y' = `f`(s, y) from s = 0 to 1 in `steps` equal steps of the classical fourth-order Runge–Kutta
/// method. Stops early once `stop` holds.
pub fn integrate<const N: usize>(
    mut y: [f64; N],
    steps: usize,
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    stop: impl Fn(&[f64; N]) -> bool,
) -> [f64; N] {
    let h = 1.0 / steps as f64;
    let advanced = |y: &[f64; N], k: &[f64; N], t: f64| std::array::from_fn(|i| y[i] + t * k[i]);
    for step in 0..steps {
        let s = step as f64 * h;
        let k1 = f(s, &y);
        let k2 = f(s + 0.5 * h, &advanced(&y, &k1, 0.5 * h));
        let k3 = f(s + 0.5 * h, &advanced(&y, &k2, 0.5 * h));
        let k4 = f(s + h, &advanced(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        if stop(&y) {
            break;
        }
    }
    y
}
