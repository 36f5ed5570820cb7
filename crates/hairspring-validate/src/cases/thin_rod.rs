//! A strand falls on a thin rod.

use super::USUAL;
use crate::{
    Case, Failure, Method, Parameter, Quantity, ROD_RADIUS_MM,
    plot::Sweep,
    specimen::{LENGTH, RADIUS, Setup, Specimen, straight},
};
use glam::{DVec3, Vec3};
use hairspring::{collide::ColliderShape, material::Material};
use rayon::prelude::*;

pub const CASE: Case = Case {
    name: "thin-rod",
    about: "A strand that falls on a thin rod stays over it, and touches it.",
    parameters: &[Parameter { symbol: &ROD_RADIUS_MM, range: (0.25, 10.0) }],
    defaults: &[&[1.0]],
    quantities: &[Quantity { name: "distance from the axis over the radius", tolerance: DEEPEST }],
    method: USUAL,
    points_fixed: false,
    min_points: 3,
    enough_points: 32,
    fails_with: &[],
    reason: |values, method| {
        let segment = 1e3 * LENGTH / f64::from(method.points - 1);
        let cut = CORNER * segment / values[0];
        (cut > DEEPEST).then(|| {
            format!(
                "a segment of {segment:.1} mm may cut a corner by {} % of its length, {:.0} % of the radius",
                100.0 * CORNER,
                100.0 * cut
            )
        })
    },
    reference: |_| Ok(vec![1.0]),
    measure: |values, method| {
        let distances: Result<Vec<f64>, Failure> =
            FALLS.into_par_iter().map(|fall| distance(values[0] * 1e-3, fall, method)).collect();
        let farthest = |a: f64, b: &f64| if (b - 1.0).abs() > (a - 1.0f64).abs() { *b } else { a };
        Ok(vec![distances?.iter().fold(1.0, farthest)])
    },
    sweep: Sweep::Parameter { index: 0, from: 0.5, to: 5.0, log: true },
};

/// Largest depth in the rod, over its radius [1].
const DEEPEST: f64 = 0.1;

/// Depth to which a segment may cut a corner of a collider, over its length [1].
const CORNER: f64 = 0.015;

/// Initial height of the strand above the rod [m].
const FALLS: [f64; 3] = [0.002, 0.005, 0.01];

/// Distance of the root from the rod, along the strand [m]. Most of the strand hangs beyond the rod.
const REACH: f64 = 0.03;

/// Number of frames, in which the strand falls, swings, and comes to hang.
const FRAMES: u32 = 300;

/// Smallest distance of the strand from the rod's axis at the end, over the rod's radius; negative if the
/// strand passes below.
fn distance(radius: f64, fall: f64, method: Method) -> Result<f64, Failure> {
    let mut setup = Setup::chain(straight(method.points, LENGTH, DVec3::X));
    setup.material = Material { radius: Some(RADIUS as f32), ..Material::default() };
    let axis = DVec3::new(REACH, -fall - radius, 0.0);
    let [a, b] = [-LENGTH, LENGTH].map(|z| (axis + DVec3::Z * z).as_vec3());
    setup.collider = Some(ColliderShape::Capsule { a, b, radius: radius as f32 });
    let mut specimen = Specimen::new(setup, method);
    for _ in 0..FRAMES {
        specimen.frame()?;
    }
    let across = |p: &Vec3| (p.as_dvec3() - axis) * DVec3::new(1.0, 1.0, 0.0);
    let (mut least, mut over) = (f64::INFINITY, false);
    for pair in specimen.points().windows(2) {
        let [a, b] = [across(&pair[0]), across(&pair[1])];
        let way = b - a;
        let nearest = a + way * (-a.dot(way) / way.length_squared()).clamp(0.0, 1.0);
        least = least.min(nearest.length());
        // Where the strand crosses the vertical plane through the axis.
        if a.x < 0.0 && b.x >= 0.0 {
            over = a.y - way.y * a.x / way.x > 0.0;
        }
    }
    Ok(if over { least } else { -least } / radius)
}
