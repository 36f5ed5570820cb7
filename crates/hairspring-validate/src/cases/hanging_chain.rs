//! A hanging chain swings in Bernoulli's modes.

use super::{FREQUENCY, SPRINGS_ARE_BRAKED, USUAL, times_as_long};
use crate::{
    Case, Method, Quantity,
    plot::Sweep,
    reference::chain,
    ring_down,
    specimen::{GRAVITY, LENGTH, Setup, pinned},
};
use glam::DVec3;
use hairspring::material::Model;
use rayon::prelude::*;

pub const CASE: Case = Case {
    name: "hanging-chain",
    about: "A strand without bending stiffness hangs and swings a little, in three modes.",
    parameters: &[],
    defaults: &[&[]],
    quantities: &[
        Quantity { name: "mode 1, ω/√(g/L)", tolerance: FREQUENCY },
        Quantity { name: "mode 2, ω/√(g/L)", tolerance: FREQUENCY },
        Quantity { name: "mode 3, ω/√(g/L)", tolerance: FREQUENCY },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 6,
    enough_points: 64,
    fails_with: &[Model::Springs],
    reason: |_, method| match method {
        Method { points: ..64, .. } => Some(format!(
            "the error of the third mode is proportional to the segment length: 2 % at 64 points, and here a segment is \
             {:.1} times as long",
            times_as_long(method)
        )),
        Method { model: Model::Springs, .. } => Some(SPRINGS_ARE_BRAKED.into()),
        _ => None,
    },
    reference: |_| Ok(chain::modes(3).into_iter().map(f64::sqrt).collect()),
    measure: |_, method| {
        let unit = (GRAVITY / LENGTH).sqrt();
        let measure = |lambda: f64| {
            let points = pinned(method.points, LENGTH, DVec3::NEG_Y, DVec3::NEG_Y);
            let shape: Vec<f64> =
                points.iter().map(|p| chain::shape(lambda, (1.0 + p.y as f64 / LENGTH).max(0.0))).collect();
            let omega = lambda.sqrt() * unit;
            ring_down::frequency(Setup::chain(points), method, LENGTH, DVec3::X, &shape, omega)
                .map(|omega| omega / unit)
        };
        chain::modes(3).into_par_iter().map(measure).collect()
    },
    sweep: Sweep::Modes { label: "ω/√(g/L)" },
};
