//! The capstan: a strand over a cylinder holds a larger load with a smaller one.

use super::{FRICTION, USUAL};
use crate::{
    Case, Failure, MU, Method, Parameter, Quantity,
    plot::Sweep,
    specimen::{GRAVITY, LENGTH, LINE_DENSITY, Setup, Specimen},
};
use glam::{DVec3, Vec3};
use hairspring::{collide::ColliderShape, simulation::Hold};
use std::f64::consts::PI;

pub const CASE: Case = Case {
    name: "capstan",
    about: "A limp strand half around a cylinder slips where the ratio of the loads at its ends is above e^{μπ}.",
    parameters: &[Parameter { symbol: &MU, range: (0.02, 1.0) }],
    defaults: &[&[0.1], &[0.3]],
    quantities: &[Quantity { name: "ratio of the loads T₂/T₁", tolerance: FRICTION }],
    method: USUAL,
    points_fixed: false,
    min_points: 8,
    enough_points: 64,
    fails_with: &[],
    reason: |values, method| {
        let on_cylinder = (method.points - 1) / 2;
        (method.points < 64 || method.substeps > 4 || values[0] > 0.3).then(|| {
            format!(
                "a strand that is pulled slightly harder than friction holds starts slowly, which raises the measured \
                 ratio, the more so the greater the friction (μ = {}), the fewer segments are on the cylinder \
                 ({on_cylinder}) and the more substeps there are ({}); with μ = 0.3, 31 segments and 4 substeps it passes",
                values[0], method.substeps
            )
        })
    },
    reference: |values| Ok(vec![(values[0] * PI).exp()]),
    measure: |values, method| {
        let mu = values[0];
        // Bisection by experiments: the strand slips or holds.
        let (mut holds, mut slips) = (1.0, (2.0 * mu * PI).exp());
        if !slides(mu, slips, method)? {
            return Err(Failure::NoThreshold);
        }
        while slips - holds > 2e-3 * slips {
            let ratio = 0.5 * (holds + slips);
            if slides(mu, ratio, method)? { slips = ratio } else { holds = ratio }
        }
        Ok(vec![0.5 * (holds + slips)])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.05, to: 0.6, log: false },
};

/// The larger load, in weights of the strand. The difference of two loads moves the strand at once.
const LOAD: f64 = 3.0;

/// Frames in which equal loads and contacts settle, in which one load is then reduced, and in which the
/// strand carries both. With unequal loads from the start, the strand would slide before the measurement
/// begins.
const SETTLING: u32 = 30;
const EASING: u32 = 60;
const WATCHED: u32 = 120;

/// A load that sank by more than this number of segments has slipped. A strand that holds sinks by less.
const SLIPPED: f64 = 2.0;

/// Returns whether the strand slips. It hangs over a horizontal cylinder, and only the loads have weight: the
/// smaller one at its tip, the larger one at a point before the cylinder. From there to the root it is slack.
fn slides(mu: f64, ratio: f64, method: Method) -> Result<bool, Failure> {
    let n = method.points as usize;
    // About half of the segments lie on the cylinder, an eighth hangs on either side, and a quarter is slack.
    let segments = n - 1;
    let wrapped = (segments / 2).max(2);
    let hanging = (segments / 8).max(1);
    let slack = segments - wrapped - 2 * hanging;
    let l = LENGTH / segments as f64;
    let radius = 0.5 * l / (0.5 * PI / wrapped as f64).sin();

    let at = |angle: f64| DVec3::new(-angle.cos(), angle.sin(), 0.0) * radius;
    let mut path: Vec<DVec3> = Vec::with_capacity(n);
    let load = DVec3::new(-radius, -(hanging as f64) * l, 0.0);
    // The slack part forms a bow, whose width is how far the load can sink.
    for k in (1..=slack).rev() {
        let bow = PI * k as f64 / slack as f64;
        let wide = l * slack as f64 / PI;
        path.push(load + DVec3::new(-wide * (1.0 - bow.cos()), -wide * bow.sin(), 0.0));
    }
    path.extend((0..hanging).map(|k| load + DVec3::Y * (k as f64 * l)));
    path.extend((0..=wrapped).map(|k| at(PI * k as f64 / wrapped as f64)));
    path.extend((1..=hanging).map(|k| at(PI) - DVec3::Y * (k as f64 * l)));

    let mut setup = Setup::limp(path.iter().map(|p| p.as_vec3()).collect());
    setup.gravity = DVec3::ZERO;
    setup.material.drag = 0.8;
    setup.material.friction = mu as f32;
    let axis = Vec3::Z * LENGTH as f32;
    setup.collider = Some(ColliderShape::Capsule { a: -axis, b: axis, radius: radius as f32 });
    let mut specimen = Specimen::new(setup, method);
    let greater = LOAD * LINE_DENSITY * LENGTH * GRAVITY;
    let pull = |point: usize, load: f64| {
        let force = Vec3::NEG_Y * load as f32;
        Hold { point: point as u32, force, ..Hold::default() }
    };
    let hang = |specimen: &mut Specimen, smaller: f64| {
        specimen.hold(&[pull(slack, greater), pull(n - 1, smaller)]);
    };
    hang(&mut specimen, greater);
    let height = |specimen: &Specimen| specimen.points()[slack].y as f64;
    for _ in 0..SETTLING {
        specimen.frame()?;
    }
    let start = height(&specimen);
    for frame in 1..=EASING + WATCHED {
        let eased = (frame as f64 / EASING as f64).min(1.0);
        hang(&mut specimen, greater * (1.0 + (1.0 / ratio - 1.0) * eased));
        specimen.frame()?;
        if start - height(&specimen) > SLIPPED * l {
            return Ok(true);
        }
    }
    Ok(false)
}
