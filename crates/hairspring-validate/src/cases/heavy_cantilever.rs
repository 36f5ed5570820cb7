//! A straight strand clamped horizontally droops under its own weight.

use super::{HAIR, STATIC, USUAL};
use crate::{
    Case, GAMMA, Method, Parameter, Quantity,
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
    out_of_reach: |method| match method {
        Method { model: Model::Springs, points: ..48, .. } => Some(BENT_FAR),
        _ => None,
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

/// Why the springs model does not pass with few points.
const BENT_FAR: &str =
    "at 32 points and Γ = 100, the joint at the clamp turns by 0.6 rad, where its springs are too soft";
