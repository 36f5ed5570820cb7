//! Where a line first crosses a thin shell, and the shell at another size.

use super::{ThinShell, thin_shell::REACH};
use glam::Vec3;

/// The place where a line crosses a [`ThinShell`].
///
/// ```
/// use glam::Vec3;
/// use hairspring::collide::ThinShell;
///
/// let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
/// let leaf = ThinShell::new(&corners, &[[0, 1, 2]], 0.01);
/// let crossing = leaf.crossing(Vec3::new(0.2, 0.3, 0.2), Vec3::new(0.2, -0.3, 0.2)).unwrap();
/// assert!((crossing.fraction - 0.5).abs() < 1e-6 && crossing.normal.y > 0.99);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Fraction of the line before the crossing, 0 to 1.
    pub fraction: f32,
    /// Unit normal of the triangle, on the side that the line comes from.
    pub normal: Vec3,
}

/// How far a line may pass outside of a triangle and still cross it, as a fraction of the triangle [1], and how far
/// before its plane it may end, as a fraction of the line. It closes the gaps that rounding leaves between triangles.
const RIM: f32 = 1e-5;

/// Maximum number of cells along the longest side of an enlarged shell. It exists for a moment, and most of the hair is
/// far from it. With 128, a hat that closed in on three hairs took 19 s and half a gigabyte.
const CELLS_OF_ENLARGED: f32 = 32.0;

impl ThinShell {
    /// Returns the first crossing of the line from `from` to `to` [m] with one of its triangles; `None` if the
    /// line crosses none.
    pub fn crossing(&self, from: Vec3, to: Vec3) -> Option<Crossing> {
        let way = to - from;
        let length = way.length();
        let (center, radius) = self.bounds();
        let near = from.midpoint(to).distance(center) <= radius + 0.5 * length;
        if self.triangles().is_empty() || !near || !length.is_finite() {
            return None;
        }
        // A cell lists all triangles within reach of it, so no crossing is farther from a sample than that.
        let samples = (0.5 * length / (REACH * self.thickness())).ceil().max(1.0);
        let mut first: Option<Crossing> = None;
        for k in 0..samples as usize {
            for &t in self.listed_at(from + way * ((k as f32 + 0.5) / samples)) {
                if self.misses_plane(t as usize, [from, to], RIM * length) {
                    continue;
                }
                let before = first.map_or(1.0, |first| first.fraction);
                let crossing = cross(from, way, self.triangles()[t as usize]);
                first = crossing.filter(|crossing| crossing.fraction < before).or(first);
            }
            if first.is_some_and(|first| first.fraction * samples <= (k + 1) as f32) {
                break;
            }
        }
        first
    }

    /// Rebuilds this shell as `shell`, enlarged by `factor` about `center` [m]. It moved there from the size
    /// `before`.
    pub fn update_scaled(&mut self, shell: &ThinShell, center: Vec3, (factor, before): (f32, f32)) {
        let scaled = |factor: f32| -> Vec<Vec3> {
            shell.triangles().iter().flatten().map(|p| center + (*p - center) * factor).collect()
        };
        let triangles: Vec<[u32; 3]> =
            (0..shell.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let positions = (&scaled(factor)[..], Some(&scaled(before)[..]));
        self.rebuild(positions, &triangles, None, shell.thickness(), CELLS_OF_ENLARGED);
    }
}

/// Returns the crossing of a line with a triangle, from either side (Möller & Trumbore 1997, *Fast, Minimum
/// Storage Ray/Triangle Intersection*).
fn cross(from: Vec3, way: Vec3, [a, b, c]: [Vec3; 3]) -> Option<Crossing> {
    let (ab, ac, ap) = (b - a, c - a, from - a);
    let normal = ab.cross(ac);
    let against = -way.dot(normal);
    if against == 0.0 {
        return None;
    }
    let aside = ap.cross(way) / against;
    let (u, v) = (ac.dot(aside), -ab.dot(aside));
    let fraction = ap.dot(normal) / against;
    let hits = u >= -RIM && v >= -RIM && u + v <= 1.0 + RIM && (0.0..1.0).contains(&fraction);
    hits.then(|| Crossing { fraction, normal: normal.normalize_or_zero() * against.signum() })
}
