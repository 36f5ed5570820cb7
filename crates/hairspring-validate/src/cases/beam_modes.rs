//! A clamped strand without gravity vibrates in Euler's modes.

use super::{FREQUENCY, HAIR, USUAL};
use crate::{
    Case, Method, Quantity,
    plot::Sweep,
    reference::beam,
    ring_down,
    specimen::{BENDING, LINE_DENSITY, Setup, straight},
};
use glam::DVec3;
use rayon::prelude::*;

pub const CASE: Case = Case {
    name: "beam-modes",
    about: "A straight strand clamped at its root vibrates without gravity, in three modes.",
    parameters: &[],
    defaults: &[&[]],
    quantities: &[
        Quantity { name: "mode 1, ω/√(EI/ρAL⁴)", tolerance: FREQUENCY },
        Quantity { name: "mode 2, ω/√(EI/ρAL⁴)", tolerance: FREQUENCY },
        Quantity { name: "mode 3, ω/√(EI/ρAL⁴)", tolerance: FREQUENCY },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 32,
    fails_with: &[],
    reason: |_, _| None,
    reference: |_| Ok(beam::modes(3).into_iter().map(|beta| beta * beta).collect()),
    measure: |_, method| beam::modes(3).into_par_iter().map(|beta| measure(beta, method)).collect(),
    sweep: Sweep::Modes { label: "ω/√(EI/ρAL⁴)" },
};

/// Long hair: the third mode of a shorter strand would be too fast for any frame rate.
const LENGTH: f64 = 0.3;

fn measure(beta: f64, method: Method) -> Result<f64, crate::Failure> {
    let points = straight(method.points, LENGTH, DVec3::X);
    let shape: Vec<f64> = points.iter().map(|p| beam::shape(beta, p.x as f64 / LENGTH)).collect();
    let mut setup = Setup::weightless(points, HAIR);
    setup.material.drag = 0.0;
    let unit = (BENDING / LINE_DENSITY).sqrt() / (LENGTH * LENGTH);
    let omega = ring_down::frequency(setup, method, LENGTH, DVec3::Y, &shape, beta * beta * unit)?;
    Ok(omega / unit)
}
