//! Hair of each preset stays at rest when no force disturbs it.

use super::USUAL;
use crate::{
    Case, Failure, Method, Quantity,
    plot::Sweep,
    specimen::{RADIUS, Setup, Specimen},
};
use glam::{DVec3, Vec3};
use hairspring::material::{PRESETS, preset};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

pub const CASE: Case = Case {
    name: "rest",
    about: "Hair of each preset in its style's shape, clamped sideways, is nearly at rest after 5 s: below 1 mm/s.",
    parameters: &[],
    defaults: &[&[]],
    quantities: &[
        Quantity { name: "straight, fastest point [mm/s]", tolerance: FASTEST },
        Quantity { name: "wavy, fastest point [mm/s]", tolerance: FASTEST },
        Quantity { name: "curly, fastest point [mm/s]", tolerance: FASTEST },
        Quantity { name: "coily, fastest point [mm/s]", tolerance: FASTEST },
        Quantity { name: "short-fur, fastest point [mm/s]", tolerance: FASTEST },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 3,
    fails_with: &[],
    reason: |_, _| None,
    reference: |_| Ok(vec![0.0; PRESETS.len()]),
    measure: |_, method| STYLES.into_par_iter().map(|style| fastest(&style, method)).collect(),
    sweep: Sweep::Modes { label: "fastest point [mm/s]" },
};

/// Largest speed that passes [mm/s].
const FASTEST: f64 = 1.0;

/// Frames before the measurement, and frames in which the speed is measured.
const RESTING: u32 = 300;
const WATCHED: u32 = 60;

/// The shape of a preset's style, as in the built-in scene: [m].
struct Style {
    preset: &'static str,
    length: f64,
    wave: f64,
    wave_length: f64,
    roundness: f64,
    /// Length over which the hair bends down from the clamp [m], and the angle of the bend [rad].
    falls: (f64, f64),
}

const STYLES: [Style; 5] = [
    style(PRESETS[0], 0.42, (0.0012, 0.16, 0.5), (0.06, FRAC_PI_2)),
    style(PRESETS[1], 0.40, (0.012, 0.075, 0.5), (0.06, FRAC_PI_2)),
    style(PRESETS[2], 0.33, (0.0105, 0.042, 0.9), (0.06, FRAC_PI_2)),
    style(PRESETS[3], 0.105, (0.0038, 0.011, 1.0), (0.1, 0.3)),
    style(PRESETS[4], 0.030, (0.0006, 0.03, 0.5), (0.03, 0.8)),
];

const fn style(
    preset: &'static str,
    length: f64,
    (wave, wave_length, roundness): (f64, f64, f64),
    falls: (f64, f64),
) -> Style {
    Style { preset, length, wave, wave_length, roundness, falls }
}

impl Style {
    /// Returns `n` evenly spaced points along the path, with waves around it that grow from the clamp.
    fn points(&self, n: u32) -> Vec<Vec3> {
        /// Integration steps of the path between two points.
        const FINE: u32 = 16;
        let (over, by) = self.falls;
        let step = self.length / f64::from((n - 1) * FINE);
        let mut course = DVec3::ZERO;
        let mut points = vec![Vec3::ZERO];
        for k in 1..=(n - 1) * FINE {
            let s = f64::from(k) * step;
            let (sin, cos) = (by * ((s - 0.5 * step) / over).min(1.0)).sin_cos();
            course += DVec3::new(cos, -sin, 0.0) * step;
            if k.is_multiple_of(FINE) {
                let grown = (s / (0.35 * self.length)).min(1.0);
                let size = self.wave * grown * grown * (3.0 - 2.0 * grown);
                let turn = TAU * s / self.wave_length;
                let deep = DVec3::new(sin, cos, 0.0) * (turn.sin() * self.roundness);
                points.push((course + (DVec3::Z * turn.cos() + deep) * size).as_vec3());
            }
        }
        points
    }
}

/// Speed of the fastest point of a strand of this style in the last second [mm/s].
fn fastest(style: &Style, method: Method) -> Result<f64, Failure> {
    let mut setup = Setup::chain(style.points(method.points));
    setup.material = preset(style.preset).expect("a preset");
    setup.material.radius.get_or_insert(RADIUS as f32);
    setup.in_balance = true;
    let mut specimen = Specimen::new(setup, method);
    let mut fastest = 0f64;
    for frame in 0..RESTING + WATCHED {
        specimen.frame()?;
        if frame >= RESTING {
            fastest = fastest.max(specimen.fastest());
        }
    }
    Ok(fastest * 1e3)
}
