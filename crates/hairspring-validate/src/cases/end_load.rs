//! A straight strand clamped horizontally bends under a dead load at its tip.

use super::{HAIR, STATIC, USUAL};
use crate::{
    ALPHA, Case, Parameter, Quantity,
    plot::Sweep,
    reference::elastica::cantilever,
    specimen::{BENDING, LENGTH, Setup, Specimen, straight},
};
use glam::{DVec3, Vec3};
use hairspring::simulation::Hold;

pub const CASE: Case = Case {
    name: "end-load",
    about: "A straight, weightless strand clamped horizontally bends under a dead load at its tip.",
    parameters: &[Parameter { symbol: &ALPHA, range: (0.01, 100.0) }],
    defaults: &[&[1.0], &[5.0], &[10.0]],
    quantities: &[
        Quantity { name: "tip angle θ", tolerance: STATIC },
        Quantity { name: "vertical displacement w/L", tolerance: STATIC },
        Quantity { name: "horizontal displacement u/L", tolerance: STATIC },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 16,
    fails_with: &[],
    reason: |_, _| None,
    reference: |values| {
        let shape = cantilever(0.0, values[0]);
        Ok(vec![shape.tip_angle, shape.drop, 1.0 - shape.reach])
    },
    measure: |values, method| {
        let points = straight(method.points, LENGTH, DVec3::X);
        let mut setup = Setup::weightless(points, HAIR);
        // Less drag than for a heavy strand, because it moves more slowly.
        setup.material.drag = 0.8;
        let load = values[0] * BENDING / (LENGTH * LENGTH);
        let mut specimen = Specimen::new(setup, method);
        let force = Vec3::NEG_Y * load as f32;
        specimen.hold(&[Hold { point: method.points - 1, force, ..Hold::default() }]);
        let rest = specimen.settle()?;
        let [.., before, tip] = rest[..] else { unreachable!("three points or more") };
        // There is no moment at the tip: its angle is that of the last segment.
        let end = tip - before;
        Ok(vec![(-end.y).atan2(end.x), -tip.y / LENGTH, 1.0 - tip.x / LENGTH])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.3, to: 30.0, log: true },
};
