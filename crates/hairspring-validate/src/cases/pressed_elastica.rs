//! A straight strand is lowered with its tip onto a frictionless plane, and bows out.

use super::{HAIR, STATIC, USUAL};
use crate::{
    Case, Failure, HEIGHT, Method, Parameter, Quantity,
    plot::Sweep,
    reference::column::column,
    specimen::{BENDING, LENGTH, Setup, Specimen, straight},
};
use glam::{DVec3, Vec3};
use hairspring::{collide::ColliderShape, material::Model, simulation::Hold};

pub const CASE: Case = Case {
    name: "pressed-elastica",
    about: "A weightless strand clamped upside down bows out as it is pressed with its tip onto a smooth plane.",
    // Any lower, its side would lie on the plane.
    parameters: &[Parameter { symbol: &HEIGHT, range: (0.5, 0.98) }],
    defaults: &[&[0.9], &[0.6]],
    quantities: &[
        Quantity { name: "load PL²/EI", tolerance: STATIC },
        Quantity { name: "tip aside x/L", tolerance: STATIC },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 16,
    fails_with: &[Model::Springs],
    reason: |_, method| {
        (method.model == Model::Springs && method.points >= 16).then(|| {
            "the joints of a truss have preferred bending directions, and the bent strand rotates about its axis to them for \
             minutes"
                .into()
        })
    },
    reference: |values| {
        let shape = column(values[0]);
        Ok(vec![shape.load, shape.aside])
    },
    measure: |values, method| measure(values[0], method),
    sweep: Sweep::Parameter { index: 0, from: 0.55, to: 0.97, log: false },
};

/// Time in which the root is lowered [s].
const LOWERING: f64 = 2.0;

/// Number of frames over which the load is averaged.
const WEIGHED: u32 = 60;

/// Sideways load on the tip while the strand is lowered, in EI/L². It selects the side to which the strand
/// bows out.
const ASIDE: f64 = 0.05;

fn measure(height: f64, method: Method) -> Result<Vec<f64>, Failure> {
    let mut setup = Setup::weightless(straight(method.points, LENGTH, DVec3::NEG_Y), HAIR);
    setup.material.drag = 0.8;
    setup.material.friction = 0.0;
    setup.collider = Some(ColliderShape::Plane { point: Vec3::NEG_Y * LENGTH as f32, normal: Vec3::Y });
    let mut specimen = Specimen::new(setup, method);
    let unit = BENDING / (LENGTH * LENGTH);
    let force = Vec3::X * (ASIDE * unit) as f32;
    specimen.hold(&[Hold { point: method.points - 1, force, ..Hold::default() }]);
    let steps = (LOWERING / specimen.substep()).round() as u32;
    for step in 1..=steps {
        let way = (1.0 - height) * LENGTH * f64::from(step) / f64::from(steps);
        specimen.small_step(DVec3::NEG_Y * way)?;
    }
    specimen.hold(&[]);
    let tip = specimen.settle()?[method.points as usize - 1];
    // The force of a single substep fluctuates about its mean.
    let mut load = 0.0;
    for _ in 0..WEIGHED {
        specimen.frame()?;
        load += specimen.contact_force() / f64::from(WEIGHED);
    }
    Ok(vec![load / unit, tip.x.hypot(tip.z) / LENGTH])
}
