//! Triangulation of polygons.

use glam::{Vec2, Vec3};

/// Maximum number of corners of a polygon that ears are cut from. Their number enters squared, so that the limit
/// bounds the work for each corner of a file.
const MAX_EARS: usize = 1024;

/// Appends the triangles of the polygon with the given corners, which are indices in `positions`. A polygon that its
/// first corner sees all of becomes a fan around that corner. Any other loses one ear after the other (Meisters 1975,
/// *Polygons have ears*) in the plane that fits it best. Returns false if it has too many corners for that, and is a
/// fan nevertheless.
pub(crate) fn triangulate(positions: &[Vec3], polygon: &[u32], triangles: &mut Vec<[u32; 3]>) -> bool {
    let fan = |triangles: &mut Vec<[u32; 3]>| {
        for w in polygon.get(1..).unwrap_or_default().windows(2) {
            triangles.push([polygon[0], w[0], w[1]]);
        }
    };
    if polygon.len() < 4 {
        fan(triangles);
        return true;
    }
    let at = |corner: u32| positions.get(corner as usize).copied().unwrap_or_default();
    let origin = at(polygon[0]);
    // The sum of the fan's area vectors is that of any triangulation (Newell's normal).
    let areas = || {
        let rest = polygon[1..].windows(2);
        rest.map(move |w| (at(w[0]) - origin).cross(at(w[1]) - origin))
    };
    let Some(normal) = areas().sum::<Vec3>().try_normalize() else {
        fan(triangles);
        return true;
    };
    let size = areas().map(|area| area.length()).fold(0.0, f32::max);
    if areas().all(|area| area.dot(normal) >= -1e-5 * size) {
        fan(triangles);
        return true;
    }
    if polygon.len() > MAX_EARS {
        fan(triangles);
        return false;
    }
    let (x, y) = normal.any_orthonormal_pair();
    // `x × y` is the normal, or its opposite: the polygon must be counter-clockwise.
    let y = if x.cross(y).dot(normal) < 0.0 { -y } else { y };
    let flat: Vec<Vec2> =
        polygon.iter().map(|c| at(*c) - origin).map(|p| Vec2::new(p.dot(x), p.dot(y))).collect();
    cut_ears(&flat, polygon, triangles);
    true
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn area(a: Vec2, b: Vec2, c: Vec2) -> f32 {
    (b - a).perp_dot(c - a)
}

/// Cuts ears from the counter-clockwise polygon `flat` until a triangle is left. `names` are the corners' indices in
/// the mesh.
fn cut_ears(flat: &[Vec2], names: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let n = flat.len();
    // The remaining corners as a ring.
    let mut next: Vec<usize> = (0..n).map(|i| (i + 1) % n).collect();
    let mut previous: Vec<usize> = (0..n).map(|i| (i + n - 1) % n).collect();
    // Only corners that bend inwards can lie in an ear, and a corner that bends outwards keeps doing so.
    let bends_in =
        |previous: &[usize], next: &[usize], i: usize| area(flat[previous[i]], flat[i], flat[next[i]]) <= 0.0;
    let mut inward: Vec<usize> = (0..n).filter(|i| bends_in(&previous, &next, *i)).collect();
    let is_ear = |previous: &[usize], next: &[usize], inward: &[usize], i: usize| {
        let [a, b, c] = [previous[i], i, next[i]].map(|k| flat[k]);
        // Two corners of a bridge to a hole have the same place: they do not count as inside.
        let inside = |p: Vec2| {
            p != a && p != b && p != c && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0
        };
        area(a, b, c) > 0.0 && !inward.iter().any(|k| inside(flat[*k]))
    };
    // Corners to be tested. Only the neighbors of an ear that is cut may become ears.
    let mut candidates: Vec<usize> = (0..n).rev().collect();
    let mut cut = vec![false; n];
    let (mut left, mut some) = (n, 0);
    while left > 3 {
        let Some(i) = candidates.pop() else { break };
        if cut[i] || !is_ear(&previous, &next, &inward, i) {
            continue;
        }
        let (a, c) = (previous[i], next[i]);
        triangles.push([names[a], names[i], names[c]]);
        (next[a], previous[c], cut[i]) = (c, a, true);
        left -= 1;
        inward.retain(|k| !cut[*k] && bends_in(&previous, &next, *k));
        // The farther neighbor first, so that ears are not all cut at one corner.
        candidates.extend([c, a]);
        some = a;
    }
    // A polygon that crosses itself may have no ear left: the rest becomes a fan.
    let first = if left < n { some } else { 0 };
    let (mut b, mut c) = (next[first], next[next[first]]);
    while c != first {
        triangles.push([names[first], names[b], names[c]]);
        (b, c) = (c, next[c]);
    }
}
