//! Distributes the mass of a strand over its points, in f64.
//!
//! The mass of a point is that of the two half segments adjacent to it. For a material with a mass profile
//! w(s), it is
//!
//! ```text
//! m_i = c ρA_i ∫ w ds  over the half segments of point i,
//! c such that Σ m_i is the mass of the strand without a profile
//! ```
//!
//! The profile is integrated, not sampled, so that a narrow bead keeps its weight for any number of points.

use super::rest_shape::Fiber;
use std::f64::consts::PI;

/// Masses of one point and of the segment that begins at it [kg].
#[derive(Clone, Copy, Debug, Default)]
pub struct Mass {
    /// Mass of the point: half of each adjacent segment.
    pub point: f64,
    /// Mass of the point without a profile.
    pub even: f64,
    /// Mass of the segment that begins at the point; 0 at the tip.
    pub segment: f64,
}

/// Returns the masses of a strand whose segments have these `lengths` [m], shape `[points]`.
pub fn masses(lengths: &[f64], fiber: &Fiber) -> Vec<Mass> {
    let profile = Profile::new(fiber.mass_profile, lengths.iter().sum());
    let mut out = Vec::with_capacity(lengths.len() + 1);
    let (mut along, mut before) = (0.0, 0.0);
    let (mut even, mut shared) = (0.0, 0.0);
    for (i, r) in fiber.radii.iter().map(|r| *r as f64).enumerate() {
        let length = lengths.get(i).copied().unwrap_or(0.0);
        let line = fiber.density * PI * r * r;
        let half = 0.5 * (before + length);
        let mass = Mass {
            point: line * half * profile.mean(along - 0.5 * before, along + 0.5 * length),
            even: line * half,
            segment: line * length * profile.mean(along, along + length),
        };
        (even, shared) = (even + mass.even, shared + mass.point);
        (along, before) = (along + length, length);
        out.push(mass);
    }
    let scale = if shared > 0.0 { even / shared } else { 1.0 };
    out.iter_mut().for_each(|m| (m.point, m.segment) = (m.point * scale, m.segment * scale));
    out
}

/// Values at equal spacing along a strand, interpolated linearly.
enum Profile<'a> {
    /// Constant along the strand.
    Even,
    /// Two or more values from root to tip, and the length of the strand [m].
    Line(&'a [f32], f64),
}

impl<'a> Profile<'a> {
    fn new(values: &'a [f32], length: f64) -> Self {
        if values.iter().all(|v| *v == values[0]) { Self::Even } else { Self::Line(values, length) }
    }

    /// Mean from `from` to `to` [m]; exactly 1 for a constant profile.
    fn mean(&self, from: f64, to: f64) -> f64 {
        let Self::Line(values, length) = *self else { return 1.0 };
        // Integral from the root, divided by the spacing.
        let intervals = (values.len() - 1) as f64;
        let integral = |s: f64| {
            let at = (s / length * intervals).clamp(0.0, intervals);
            let k = (at as usize).min(values.len() - 2);
            let (part, v) = (at - k as f64, |k: usize| values[k] as f64);
            let whole: f64 = (0..k).map(|j| 0.5 * (v(j) + v(j + 1))).sum();
            whole + part * (v(k) + 0.5 * part * (v(k + 1) - v(k)))
        };
        if to > from { (integral(to) - integral(from)) * length / (intervals * (to - from)) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::masses;
    use crate::strand::{
        rest_shape::{Fiber, rest_shape},
        section::Section,
        truss::{particles, truss},
    };
    use glam::{DVec3, Vec3};

    const LINE: f64 = 1310.0 * std::f64::consts::PI * 4e-5 * 4e-5;

    fn fiber<'a>(radii: &'a [f32], mass_profile: &'a [f32]) -> Fiber<'a> {
        Fiber {
            radii,
            density: 1310.0,
            mass_profile,
            young: 3.9e9,
            bend_profile: &[1.0],
            sections: &[Section { bend: 1.0, flat: 0.0, twist_ratio: 0.46 }; 64],
            twists: true,
            substep: 1.0 / 240.0,
            damping: 0.0,
            double: false,
        }
    }

    fn near(a: f64, b: f64) -> bool {
        (a / b - 1.0).abs() < 1e-5
    }

    #[test]
    fn a_profile_shares_the_mass_and_adds_none() {
        let lengths = [0.01, 0.03, 0.02, 0.04];
        let radii = [4e-5; 5];
        let even = masses(&lengths, &fiber(&radii, &[1.0]));
        let shared = masses(&lengths, &fiber(&radii, &[0.5, 1.5]));
        // w = ½ + s/L; its mean over an interval is its value at the center.
        let middles = [0.0025, 0.015, 0.0375, 0.065, 0.09];
        for ((even, shared), middle) in even.iter().zip(&shared).zip(middles) {
            assert!(near(shared.point, even.point * (0.5 + middle / 0.1)), "{shared:?}, {even:?}");
        }
        let total: f64 = shared.iter().map(|m| m.point).sum();
        let segments: f64 = shared.iter().map(|m| m.segment).sum();
        assert!(near(total, LINE * 0.1) && near(segments, total), "{total} kg, {segments} kg");
        // Only ratios matter: a constant profile gives bitwise the same masses.
        for same in [&[7.0, 7.0, 7.0][..], &[]] {
            let same = masses(&lengths, &fiber(&radii, same));
            assert!(same.iter().zip(&even).all(|(a, b)| a.point == b.point && a.segment == b.segment));
        }
        // A taper with a profile keeps the mass of the taper.
        let tapered = [6e-5, 5e-5, 4e-5, 3e-5, 2e-5];
        let sum = |profile: &[f32]| {
            masses(&lengths, &fiber(&tapered, profile)).iter().map(|m| m.point).sum::<f64>()
        };
        assert!(near(sum(&[1.0, 5.0, 2.0]), sum(&[1.0])));
    }

    #[test]
    fn a_bead_between_two_points_keeps_its_weight() {
        // A triangle of height 100 over 1, at the center of the third of four segments and half as wide as
        // it.
        let mut profile = [1.0; 33];
        profile[20] = 100.0;
        let lengths = [0.05; 4];
        let masses = masses(&lengths, &fiber(&[4e-5; 5], &profile));
        let (bead, rest) = (99.0 / 32.0, 1.0);
        let unit = LINE * 0.2 / (bead + rest);
        for (mass, share) in masses.iter().zip([0.125, 0.25, 0.25 + 0.5 * bead, 0.25 + 0.5 * bead, 0.125]) {
            assert!(near(mass.point, unit * share), "{masses:?}");
        }
        assert!(near(masses[2].segment, unit * (0.25 + bead)), "{masses:?}");
    }

    #[test]
    fn each_segment_carries_the_weight_below_it() {
        let points: Vec<Vec3> = (0..33).map(|i| Vec3::NEG_Y * (0.2 * i as f32 / 32.0)).collect();
        let (radii, gravity) = ([4e-5; 33], DVec3::NEG_Y * 9.81);
        let fiber = fiber(&radii, &[1.0, 3.0]);
        for (model, rest, stride) in [
            ("rod", rest_shape(&points, &fiber, gravity), 1),
            ("springs", truss(&particles(&points), &fiber, gravity), 2),
        ] {
            for i in 1..32 {
                // Everything beyond the center of the segment: ∫ (½ + s) ds to the tip, where the whole is 1.
                let s = (i as f64 + 0.5) / 32.0;
                let weight = 9.81 * LINE * 0.2 * (0.5 * (1.0 - s) + 0.5 * (1.0 - s * s));
                let tension = rest.points[stride * i].tension;
                // The extra particles of the springs model carry a thousandth of the mass and hang next to
                // the strand.
                assert!((tension / weight - 1.0).abs() < 3e-3, "{model}: {tension} N for {weight} N at {s}");
            }
        }
    }
}
