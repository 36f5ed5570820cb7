//! The path along which a camera follows the hair.

use glam::Vec3;

/// Half the window of the moving average, which is applied twice [s]. It is longer than a step, so that a camera that follows
/// a walk does not move up and down with each step.
const SMOOTHING: f64 = 0.5;

/// Tolerance of the time of a cut [s].
const SAME_TIME: f64 = 1e-6;

/// How far the roots of the hair have moved since the start, on a smoothed path.
///
/// The window of the average shrinks toward the start, the end and each cut, where the path equals the motion. A motion of
/// constant velocity is not changed.
///
/// ```
/// use glam::Vec3;
/// use hairspring_scene::stage::SubjectPath;
///
/// // A step to the side once a second, sampled at 30 Hz.
/// let steps: Vec<Vec3> = (0..90).map(|k| Vec3::X * (k / 30) as f32).collect();
/// let path = SubjectPath::new(&steps, 30.0, &[]);
/// assert_eq!(path.offset(0.0), Vec3::ZERO);
/// assert!((path.offset(1.5).x - 1.0).abs() < 0.1);
/// assert_eq!(path.offset(100.0), Vec3::X * 2.0);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubjectPath {
    /// Offset at each sample [m].
    offsets: Vec<Vec3>,
    /// Samples per second [Hz].
    rate: f64,
    /// The times of the cuts, in order [s].
    cuts: Vec<f64>,
}

impl SubjectPath {
    /// Smooths the positions of the subject [m], `rate` per second from the start. `cuts` are the times, in order, at which
    /// it is placed elsewhere instead of moving there [s]; nothing is averaged across them. A path with a position that is not
    /// finite does not move.
    pub fn new(positions: &[Vec3], rate: f64, cuts: &[f64]) -> Self {
        let Some(first) = positions.first().filter(|_| positions.iter().all(|p| p.is_finite())) else {
            return Self::default();
        };
        let reach = (SMOOTHING * rate).round() as usize;
        let sample_at = |cut: &f64| ((cut - SAME_TIME) * rate).ceil() as usize;
        let ends = cuts.iter().map(sample_at).chain([positions.len()]);
        let mut offsets: Vec<Vec3> = Vec::with_capacity(positions.len());
        for end in ends {
            let run = positions.get(offsets.len()..end).unwrap_or_default();
            let smooth = smoothed(&smoothed(run, reach), reach);
            offsets.extend(smooth.iter().map(|p| *p - *first));
        }
        Self { offsets, rate, cuts: cuts.to_vec() }
    }

    /// Returns the offset from the start at `time` [s]. After the end, it stays.
    pub fn offset(&self, time: f64) -> Vec3 {
        let Some(end) = self.offsets.len().checked_sub(1) else { return Vec3::ZERO };
        let place = (time * self.rate).clamp(0.0, end as f64);
        let before = place.floor() as usize;
        let after = (before + 1).min(end);
        let (a, b) = (self.offsets[before], self.offsets[after]);
        let between = |cut: &&f64| {
            **cut > before as f64 / self.rate + SAME_TIME && **cut <= after as f64 / self.rate + SAME_TIME
        };
        match self.cuts.iter().find(between) {
            Some(cut) if time < *cut - SAME_TIME => a,
            Some(_) => b,
            None => a.lerp(b, (place - before as f64) as f32),
        }
    }
}

/// Moving average of the positions: of each one with up to `reach` on either side, the same number before it as after it.
fn smoothed(positions: &[Vec3], reach: usize) -> Vec<Vec3> {
    let end = positions.len();
    let mean = |k: usize| {
        let reach = reach.min(k).min(end - 1 - k);
        let around = &positions[k - reach..=k + reach];
        // The differences are averaged, so that a position at rest is exact.
        let sum: Vec3 = around.iter().map(|p| *p - positions[k]).sum();
        positions[k] + sum / around.len() as f32
    };
    (0..end).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 30.0;

    #[test]
    fn steady_motion_is_kept_and_steps_are_smoothed() {
        let steady: Vec<Vec3> = (0..60).map(|k| Vec3::X * 0.1 * k as f32).collect();
        let path = SubjectPath::new(&steady, RATE, &[]);
        for k in 0..590 {
            let time = f64::from(k) / 300.0;
            let off = path.offset(time).distance(Vec3::X * 3.0 * time as f32);
            assert!(off < 1e-5, "{off} m at {time} s");
        }
        // Steps twice a second move the head up and down by 4 cm.
        let bobbing: Vec<Vec3> =
            (0..90).map(|k| Vec3::Y * 0.04 * (k as f32 * std::f32::consts::TAU / 15.0).sin()).collect();
        let path = SubjectPath::new(&bobbing, RATE, &[]);
        let highest = (30..60).map(|k| path.offset(f64::from(k) / RATE).y.abs()).fold(0.0, f32::max);
        assert!(highest < 0.002, "{highest} m");
    }

    #[test]
    fn nothing_is_averaged_across_a_cut() {
        let at = |k: usize| Vec3::X * if k < 20 { 0.0 } else { 5.0 };
        let positions: Vec<Vec3> = (0..40).map(at).collect();
        // At a sample, and between two.
        for (cut, first) in [(20.0 / RATE, 80), (19.5 / RATE, 78)] {
            let path = SubjectPath::new(&positions, RATE, &[cut]);
            for k in 0..160 {
                let time = f64::from(k) / 120.0;
                let expected = if k < first { 0.0 } else { 5.0 };
                assert_eq!(path.offset(time).x, expected, "{time} s");
            }
        }
        assert_eq!(SubjectPath::new(&[], RATE, &[]).offset(1.0), Vec3::ZERO);
    }
}
