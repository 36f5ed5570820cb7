//! A straight strand clamped horizontally droops under its own weight.

use super::{HAIR, STATIC, USUAL};
use crate::{
    Case, GAMMA, Parameter, Quantity,
    plot::Sweep,
    reference::elastica::cantilever,
    specimen::{LENGTH, Setup, Specimen, straight},
};
use glam::DVec3;
use hairspring::material::Model;

pub const CASE: Case = Case {
    name: "heavy-cantilever",
    about: "A straight strand clamped horizontally droops under its own weight as the elastica does.",
    parameters: &[Parameter { symbol: &GAMMA, range: (0.01, 1e4) }],
    defaults: &[&[1.0], &[10.0], &[100.0]],
    quantities: &[
        Quantity { name: "drop H/L", tolerance: STATIC },
        Quantity { name: "reach W/L", tolerance: STATIC },
        Quantity { name: "drop over reach H/W", tolerance: STATIC },
    ],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 32,
    fails_with: &[],
    reason: |values, method| {
        let (gamma, all) = (values[0], f64::from(method.points - 1));
        let bent = gamma.cbrt().recip().min(1.0);
        let segments = bent * all;
        match method.model {
            Model::Springs if method.points >= 128 => None,
            _ if segments >= ENOUGH_IN_THE_BEND => None,
            Model::Springs => Some(format!(
                "at Γ = {gamma} and {} points, the strand bends within {bent:.2} of its length, in {segments:.1} segments; \
                 springs are too soft at joints with so large turns",
                method.points
            )),
            _ => Some(format!(
                "at Γ = {gamma} and {} points, the strand bends within {bent:.2} of its length, in only {segments:.1} \
                 segments",
                method.points
            )),
        }
    },
    reference: |values| {
        let shape = cantilever(values[0], 0.0);
        Ok(vec![shape.drop, shape.reach, shape.drop / shape.reach])
    },
    measure: |values, method| {
        let points = straight(method.points, LENGTH, DVec3::X);
        let mut specimen = Specimen::new(Setup::heavy(points, values[0], HAIR), method);
        let tip = specimen.settle()?[method.points as usize - 1];
        Ok(vec![-tip.y / LENGTH, tip.x / LENGTH, -tip.y / tip.x])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.3, to: 300.0, log: true },
};

/// Number of segments in the part of the strand that bends, L Γ^(−1/3), from which the shape is resolved.
const ENOUGH_IN_THE_BEND: f64 = 31.0;
