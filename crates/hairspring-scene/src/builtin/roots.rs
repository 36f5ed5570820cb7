//! Distributes roots evenly over the scalp.

use super::{random::Random, shape};
use glam::Vec3;
use hairspring::body::Mesh;

/// Returns `count` points on the scalp of `mesh` [m] with their outward normals, evenly spread. The number of
/// roots on each triangle is proportional to its area to within one root. Inside a triangle they follow a
/// low-discrepancy sequence.
pub fn roots(mesh: &Mesh, count: usize, seed: u32) -> Vec<(Vec3, Vec3)> {
    // Subtriangles on the scalp, small enough that the hairline is accurate to about a millimeter.
    let mut pieces: Vec<[Vec3; 6]> = Vec::new();
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        if (a + b + c).y < -0.4 {
            continue;
        }
        let n = t.map(|i| mesh.normals[i as usize]);
        split(&mut pieces, [a, b, c, n[0], n[1], n[2]], 2);
    }
    let area = |p: &[Vec3; 6]| (p[1] - p[0]).cross(p[2] - p[0]).length() as f64 * 0.5;
    let total: f64 = pieces.iter().map(area).sum();
    let mut roots = Vec::with_capacity(count);
    // Systematic sampling: root k is where the accumulated area passes (k + ½)/count of the total.
    let mut covered = 0.0;
    for (i, piece) in pieces.iter().enumerate() {
        covered += area(piece);
        let until =
            if i + 1 == pieces.len() { count } else { (covered / total * count as f64 + 0.5) as usize };
        let mut random = Random::new(seed, 1, i as u32);
        let (mut u, mut v) = (random.unit(), random.unit());
        while roots.len() < until.min(count) {
            // R2 sequence (Roberts 2018) from a random start, folded into the triangle.
            u = (u + 0.754_877_7).fract();
            v = (v + 0.569_840_3).fract();
            let (s, t) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = piece[0] + (piece[1] - piece[0]) * s + (piece[2] - piece[0]) * t;
            let n = piece[3] + (piece[4] - piece[3]) * s + (piece[5] - piece[3]) * t;
            roots.push((p, n.normalize_or(Vec3::Y)));
        }
    }
    roots
}

/// Adds the parts of a triangle (corners, then normals) that are on the scalp, with up to `depth`
/// subdivisions.
fn split(pieces: &mut Vec<[Vec3; 6]>, t: [Vec3; 6], depth: u32) {
    let inside = (0..3).filter(|i| shape::scalp(t[*i]) > 0.0).count();
    if inside == 3 || (depth == 0 && shape::scalp((t[0] + t[1] + t[2]) / 3.0) > 0.0) {
        pieces.push(t);
    } else if inside > 0 && depth > 0 {
        let middle = |a: usize, b: usize| ((t[a] + t[b]) * 0.5, (t[a + 3] + t[b + 3]) * 0.5);
        let (ab, bc, ca) = (middle(0, 1), middle(1, 2), middle(2, 0));
        split(pieces, [t[0], ab.0, ca.0, t[3], ab.1, ca.1], depth - 1);
        split(pieces, [ab.0, t[1], bc.0, ab.1, t[4], bc.1], depth - 1);
        split(pieces, [ca.0, bc.0, t[2], ca.1, bc.1, t[5]], depth - 1);
        split(pieces, [ab.0, bc.0, ca.0, ab.1, bc.1, ca.1], depth - 1);
    }
}
