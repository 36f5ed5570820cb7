//! The points of a convex hull that is read from a mesh.

use glam::Vec3;
use hairspring_scene::Shape;

/// Directions in which the outermost points of a larger mesh are kept: 6° apart, so that the hull of a ball loses less
/// than 0.5 % of its radius.
const DIRECTIONS: usize = 1000;

/// Returns `points`, or the outermost of them if there are more than [`Shape::MAX_POINTS`], in time that is linear in their
/// number.
pub(super) fn outermost(points: Vec<Vec3>) -> Vec<Vec3> {
    if points.len() <= Shape::MAX_POINTS {
        return points;
    }
    let mut kept: Vec<usize> = (0..DIRECTIONS)
        .filter_map(|i| {
            // Points of a Fibonacci lattice on the sphere (González 2010, *Measurement of areas on a sphere using
            // Fibonacci and latitude–longitude lattices*).
            let z = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
            let (sin, cos) = (i as f32 * 2.399_963_2).sin_cos();
            let direction = Vec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z);
            let height = |p: &usize| points[*p].dot(direction);
            (0..points.len())
                .filter(|p| points[*p].is_finite())
                .max_by(|a, b| height(a).total_cmp(&height(b)))
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|p| points[p]).collect()
}
