//! The few signed distance shapes that the bust is modelled from, and their smooth blends
//! (after I. Quilez, "Distance functions" and "Smooth minimum", iquilezles.org, 2008 to 2024).
//!
//! Unitless: whatever the lengths are in, so are the distances. Negative inside.

use glam::{Quat, Vec2, Vec3, Vec3Swizzles, vec3};

/// Smooth union: the smaller of `a` and `b`, rounded where they differ by less than `k` (quadratic polynomial).
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

/// Unit outward normal of a distance at `p`, by central differences over `step` each way.
pub fn normal(distance: impl Fn(Vec3) -> f32, p: Vec3, step: f32) -> Vec3 {
    let along = |axis: Vec3| distance(p + axis * step) - distance(p - axis * step);
    vec3(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
}

/// 0 below `lo`, 1 above `hi`, an S between (`lo` may be above `hi`: then it falls).
pub fn smoothstep(lo: f32, hi: f32, x: f32) -> f32 {
    let t = ((x - lo) / (hi - lo)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A ball.
pub fn sphere(p: Vec3, center: Vec3, radius: f32) -> f32 {
    p.distance(center) - radius
}

/// An ellipsoid along the axes, to first order exact near its surface.
pub fn ellipsoid(p: Vec3, center: Vec3, radii: Vec3) -> f32 {
    let q = (p - center) / radii;
    let (k0, k1) = (q.length(), (q / radii).length());
    // At the very middle both vanish; the inscribed ball's depth is the right value there.
    if k1 < 1e-12 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

/// An ellipsoid turned by `rotation` about its middle.
pub fn turned_ellipsoid(p: Vec3, center: Vec3, radii: Vec3, rotation: Quat) -> f32 {
    ellipsoid(rotation.inverse() * (p - center), Vec3::ZERO, radii)
}

/// A limb from `a` (radius `ra`) to `b` (radius `rb`): the radius runs linearly along the axis.
pub fn limb(p: Vec3, a: Vec3, ra: f32, b: Vec3, rb: f32) -> f32 {
    let (ap, ab) = (p - a, b - a);
    let t = (ap.dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (ap - ab * t).length() - (ra + (rb - ra) * t)
}

/// An almond in the plane, `half_width` by `half_height` (the smaller), tips on the x axis: two arcs of one circle.
pub fn almond(p: Vec2, half_width: f32, half_height: f32) -> f32 {
    // Radius of the arcs and how far their centres lie from the x axis.
    let drop = (half_width * half_width - half_height * half_height) / (2.0 * half_height);
    Vec2::new(p.x, p.y.abs() + drop).length() - (drop + half_height)
}

/// A ring about the z axis: `radii` of its elliptic centre line, `thickness` the tube's radius.
pub fn elliptic_ring(p: Vec3, radii: Vec2, thickness: f32) -> f32 {
    let q = p.xy() / radii;
    let (k0, k1) = (q.length(), (q / radii).length());
    let plane = if k1 < 1e-12 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 };
    Vec2::new(plane, p.z).length() - thickness
}
