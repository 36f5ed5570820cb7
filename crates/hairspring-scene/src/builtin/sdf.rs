//! Signed distance functions from which the bust is modeled, with smooth blends (after I. Quilez, "Distance
//! functions" and "Smooth minimum", iquilezles.org, 2008 to 2024).
//!
//! Distances have the same unit as the input lengths. Negative inside.

use glam::{Quat, Vec2, Vec3, Vec3Swizzles, vec3};

/// Smooth union: the minimum of `a` and `b`, rounded where they differ by less than `k` (quadratic
/// polynomial).
pub fn union(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// Smooth difference: `a` without `b`, the edge rounded over `k`.
pub fn cut(a: f32, b: f32, k: f32) -> f32 {
    -union(-a, b, k)
}

/// Smooth intersection of `a` and `b`, the edge rounded over `k`.
pub fn both(a: f32, b: f32, k: f32) -> f32 {
    -union(-a, -b, k)
}

/// Returns the unit outward normal of a distance at `p`, by central differences with `step` to each side.
pub fn normal(distance: impl Fn(Vec3) -> f32, p: Vec3, step: f32) -> Vec3 {
    let along = |axis: Vec3| distance(p + axis * step) - distance(p - axis * step);
    vec3(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
}

/// Smooth step: 0 below `lo`, 1 above `hi`. If `lo` is above `hi`, it decreases.
pub fn smoothstep(lo: f32, hi: f32, x: f32) -> f32 {
    let t = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A sphere.
pub fn sphere(p: Vec3, center: Vec3, radius: f32) -> f32 {
    p.distance(center) - radius
}

/// An axis-aligned ellipsoid, exact to first order near its surface.
pub fn ellipsoid(p: Vec3, center: Vec3, radii: Vec3) -> f32 {
    let q = (p - center) / radii;
    let (k0, k1) = (q.length(), (q / radii).length());
    // At the center both vanish; the correct value there is the depth of the inscribed sphere.
    if k1 < 1e-12 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

/// An ellipsoid rotated by `rotation` about its center.
pub fn turned_ellipsoid(p: Vec3, center: Vec3, radii: Vec3, rotation: Quat) -> f32 {
    ellipsoid(rotation.inverse() * (p - center), Vec3::ZERO, radii)
}

/// A limb from `a` (radius `ra`) to `b` (radius `rb`): the radius varies linearly along the axis.
pub fn limb(p: Vec3, a: Vec3, ra: f32, b: Vec3, rb: f32) -> f32 {
    let (ap, ab) = (p - a, b - a);
    let t = (ap.dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (ap - ab * t).length() - (ra + (rb - ra) * t)
}

/// An almond in the plane, `half_width` by `half_height` (the smaller), with its tips on the x axis: two
/// equal circular arcs.
pub fn almond(p: Vec2, half_width: f32, half_height: f32) -> f32 {
    // Distance of the arcs' centers from the x axis.
    let drop = (half_width * half_width - half_height * half_height) / (2.0 * half_height);
    Vec2::new(p.x, p.y.abs() + drop).length() - (drop + half_height)
}

/// A ring about the z axis: `radii` of its elliptic center line, and the tube's radius `thickness`.
pub fn elliptic_ring(p: Vec3, radii: Vec2, thickness: f32) -> f32 {
    let q = p.xy() / radii;
    let (k0, k1) = (q.length(), (q / radii).length());
    let plane = if k1 < 1e-12 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 };
    Vec2::new(plane, p.z).length() - thickness
}
