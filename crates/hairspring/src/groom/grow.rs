//! Grows hair from a surface, for a character without a groom: fur, a fringe, a test.

use super::{DEFAULT_RADIUS, Groom, RootBinding};
use crate::body::{Mesh, place_on};
use crate::settings::define_settings;
use glam::{Quat, Vec2, Vec3};

define_settings! {
    /// Settings of [`grow()`].
    ///
    /// For an example, see [`grow`].
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Growth {
        /// Number of strands, uniform by area.
        strands: u32 = 1_000, "strands", {1 to 10000000};
        /// Points per strand. More points bend more finely, at a proportional cost.
        points: u32 = 16, "points", {3 to 256};
        /// Length of the longest strand.
        length: f32 = 0.1, ["m"], {above 0};
        /// Variation of the length: the shortest strand is shorter by this fraction.
        spread: f32 = 0.2, "fraction", {0 to 1};
        /// How far a strand bends down toward its tip: 0 follows the surface's normal, 1 ends pointing down.
        fall: f32 = 0.5, "fraction", {0 to 1};
    }
}

/// Grows strands from the triangles `t` of `mesh` with `allowed(t)`, uniformly by area. Each is a smooth arc
/// from the normal toward −Y, bound to the point that it grows from. Returns no strands if the allowed area
/// is zero.
///
/// ```
/// use glam::Vec3;
/// use hairspring::{body::Mesh, groom::{Growth, grow}};
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
/// let mut mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Default::default() };
/// mesh.compute_normals();
/// let fur = grow(&mesh, &Growth { strands: 100, points: 8, ..Default::default() }, |_| true);
/// assert_eq!((fur.strand_count(), fur.point_count()), (100, 800));
/// ```
///
/// # Panics
/// If a triangle names a vertex that does not exist or has no normal.
pub fn grow(mesh: &Mesh, growth: &Growth, allowed: impl Fn(usize) -> bool) -> Groom {
    grow_along(mesh, growth, allowed, |_, _, _, normal| normal)
}

/// Like [`grow()`], with a direction for each strand: `direction(k, t, weights, normal)` returns the unit vector along
/// which strand `k` leaves the surface, at the barycentric coordinates `weights` of the triangle `t`.
///
/// ```
/// use glam::Vec3;
/// use hairspring::{body::Mesh, groom::{Growth, grow_along}};
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
/// let mut mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Default::default() };
/// mesh.compute_normals();
/// let growth = Growth { strands: 100, fall: 0.0, ..Default::default() };
/// let combed = grow_along(&mesh, &growth, |_| true, |_, _, _, normal| (normal + Vec3::X).normalize());
/// let strand = combed.strand(0);
/// assert!((strand[15] - strand[0]).normalize().distance((Vec3::Y + Vec3::X).normalize()) < 1e-5);
/// ```
///
/// # Panics
/// If a triangle names a vertex that does not exist or has no normal.
pub fn grow_along(
    mesh: &Mesh,
    growth: &Growth,
    allowed: impl Fn(usize) -> bool,
    direction: impl Fn(usize, usize, Vec3, Vec3) -> Vec3,
) -> Groom {
    let area = |t: usize| {
        let [a, b, c] = mesh.corners(t);
        0.5 * (b - a).cross(c - a).length() as f64
    };
    let skin: Vec<(usize, f64)> = (0..mesh.triangles.len())
        .filter(|t| allowed(*t))
        .map(|t| (t, area(t)))
        .filter(|t| t.1 > 0.0)
        .collect();
    let total: f64 = skin.iter().map(|t| t.1).sum();
    let count = growth.strands as usize;
    let mut roots = Vec::with_capacity(count);
    let mut strands = Vec::with_capacity(count);
    let mut covered = 0.0;
    for (t, area) in skin {
        covered += area;
        // Systematic sampling: root k is where the accumulated area passes (k + ½)/count of the total.
        while strands.len() < count && (strands.len() as f64 + 0.5) * total <= covered * count as f64 {
            let k = strands.len();
            let uv = evenly(k);
            let uv = if uv.x + uv.y > 1.0 { Vec2::ONE - uv } else { uv };
            let weights = Vec3::new(1.0 - uv.x - uv.y, uv.x, uv.y);
            let corners = mesh.corners(t);
            let root = place_on(weights, corners);
            let normal = mesh.triangles[t].iter().zip(weights.to_array());
            let normal: Vec3 = normal.map(|(v, w)| mesh.normals[*v as usize] * w).sum();
            roots.push(RootBinding::new(t as u32, weights, corners, root));
            let along = direction(k, t, weights, normal.normalize_or(Vec3::Y));
            strands.push(arc(root, along, k, growth));
        }
    }
    Groom { roots, ..Groom::from_strands(strands, DEFAULT_RADIUS) }
}

/// Returns the points of strand `k`, an arc that leaves `root` along the unit vector `normal`.
fn arc(root: Vec3, normal: Vec3, k: usize, growth: &Growth) -> Vec<Vec3> {
    // A third low-discrepancy coordinate, independent of the two for the position.
    let shorter = (k as f64 * 0.618_033_988_749_895).fract() as f32;
    let n = growth.points as usize;
    let step = growth.length * (1.0 - growth.spread * shorter) / (n - 1) as f32;
    let side = normal.cross(Vec3::NEG_Y).try_normalize().unwrap_or_else(|| {
        // The normal points straight up or down, so no direction is preferred: each strand gets its own.
        Quat::from_axis_angle(normal, std::f32::consts::TAU * shorter) * normal.any_orthonormal_vector()
    });
    let over = normal.angle_between(Vec3::NEG_Y) * growth.fall;
    let mut p = root;
    let mut points = vec![root];
    for i in 1..n {
        let s = (i as f32 - 0.5) / (n - 1) as f32;
        p += Quat::from_axis_angle(side, over * s) * normal * step;
        points.push(p);
    }
    points
}

/// Returns element `i` of a low-discrepancy sequence in the unit square (Roberts 2018, R2).
pub(super) fn evenly(i: usize) -> Vec2 {
    let i = i as f64;
    Vec2::new(
        (0.5 + i * 0.754_877_666_246_692_7).fract() as f32,
        (0.5 + i * 0.569_840_290_998_053_2).fract() as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_squares() -> Mesh {
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, -3.0), Vec3::new(0.0, 0.0, -3.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        mesh.compute_normals();
        mesh
    }

    #[test]
    fn strands_have_their_length_stand_on_the_skin_and_are_spread_by_area() {
        let growth = Growth { strands: 500, length: 0.3, spread: 0.5, fall: 0.7, ..Growth::default() };
        let mesh = two_squares();
        let groom = grow(&mesh, &growth, |_| true);
        assert_eq!((groom.strand_count(), groom.point_count()), (500, 500 * 16));
        for s in 0..500 {
            let length = groom.strand_length(s);
            assert!((0.149..=0.3001).contains(&length), "strand {s} is {length} m long");
            let root = groom.strand(s)[0];
            assert!(
                root.y == 0.0
                    && groom.roots[s].position(mesh.corners(groom.roots[s].triangle as usize)).distance(root)
                        < 1e-6
            );
            assert!(groom.strand(s)[1].y > 0.0, "strand {s} leaves into the skin");
        }
        // Each of twelve equal fields has the same number of strands, within sampling.
        let mut fields = [0; 12];
        for s in 0..500 {
            let p = groom.strand(s)[0];
            fields[((p.x * 2.0) as usize).min(1) * 6 + ((-p.z * 2.0) as usize).min(5)] += 1;
        }
        assert!(fields.iter().all(|n| (30..55).contains(n)), "{fields:?}");
    }

    #[test]
    fn nothing_grows_where_nothing_is_allowed() {
        assert_eq!(grow(&two_squares(), &Growth::default(), |_| false).strand_count(), 0);
        let half = grow(&two_squares(), &Growth::default(), |t| t == 1);
        assert!(half.strand_count() == 1000 && half.roots.iter().all(|r| r.triangle == 1));
    }
}
