//! The plane pendulum: its period by the complete elliptic integral of the first kind.

/// Period at `amplitude` [rad], 0 to under π, over that of small swings: 2K(sin(θ₀/2))/π = 1 / agm(1, cos(θ₀/2)) (Gauss 1799).
pub fn period_ratio(amplitude: f64) -> f64 {
    let (mut a, mut b): (f64, f64) = (1.0, (0.5 * amplitude).cos());
    // The digits double each time.
    for _ in 0..12 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    1.0 / a
}
