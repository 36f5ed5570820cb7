//! Adds follow hairs around the strands of a sparse groom, as its authoring tool shows it (TressFX: "follow
//! hairs per guide").

use super::{Groom, GuideWeights, grow::evenly};
use crate::body::{Mesh, NearestTree};
use crate::settings::{When, define_settings};
use glam::Vec3;

/// The condition under which the placement of the copies has an effect.
const HAS_COPIES: When = When::Above0("groom.thicken.copies");

define_settings! {
    /// Settings of [`thicken()`].
    ///
    /// For an example, see [`thicken`].
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Thicken {
        /// Number of follow hairs that are added around each strand.
        copies: u32 = 0, "hairs", {0 to 1000};
        /// Radius of the disc on the skin in which the copies grow.
        radius: f32 = 0.001, ["m"], {0 or more}, when HAS_COPIES;
        /// Distance of a copy from its strand at the tip, relative to that at the root.
        tip: f32 = 1.0, "factor", {0 or more}, when HAS_COPIES;
    }
}

/// Adds `copies` strands around each strand of a groom that is not yet bound. Each copy has its strand as its
/// only guide, or shares the guides that the strand already has. Strand `s` of `n` has the copies `s + n`, `s
/// + 2n`, ….
///
/// The copies grow in a disc on the triangle nearest to the root. Without a mesh, the disc is perpendicular
/// to the strand's direction at the root.
///
/// ```
/// use glam::Vec3;
/// use hairspring::groom::{Groom, Thicken, thicken};
///
/// let mut groom = Groom::from_strands([[Vec3::ZERO, Vec3::NEG_Y, Vec3::NEG_Y * 2.0]], 35e-6);
/// thicken(&mut groom, &Thicken { copies: 5, ..Default::default() }, None);
/// assert_eq!(groom.strand_count(), 6);
/// ```
///
/// # Panics
/// If the arrays of the groom do not fit together.
pub fn thicken(groom: &mut Groom, thicken: &Thicken, mesh: Option<&Mesh>) {
    let n = groom.strand_count();
    if thicken.copies == 0 || n == 0 {
        return;
    }
    debug_assert!(groom.roots.is_empty(), "bindings are made for all strands at once");
    let tree = mesh.filter(|m| !m.triangles.is_empty()).map(|m| (m, NearestTree::new(m)));
    let normals: Vec<Vec3> = (0..n)
        .map(|s| {
            let points = groom.strand(s);
            let skin = tree.as_ref().and_then(|(mesh, tree)| {
                let [a, b, c] = mesh.corners(tree.nearest(points[0], |_| true)?.triangle as usize);
                (b - a).cross(c - a).try_normalize()
            });
            skin.unwrap_or_else(|| (points[1.min(points.len() - 1)] - points[0]).normalize_or(Vec3::Y))
        })
        .collect();
    if groom.guides.is_empty() {
        groom.guides =
            (0..n as u32).map(|s| GuideWeights { guides: [s; 3], weights: [1.0, 0.0, 0.0] }).collect();
    }
    for copy in 1..=thicken.copies as usize {
        for (s, normal) in normals.iter().enumerate() {
            let uv = evenly(copy * n + s);
            let (sin, cos) = (std::f32::consts::TAU * uv.y).sin_cos();
            let (x, z) = normal.any_orthonormal_pair();
            let aside = (x * cos + z * sin) * (thicken.radius * uv.x.sqrt());
            let range = groom.range(s);
            let last = (range.len() - 1).max(1) as f32;
            for (i, k) in range.enumerate() {
                let p = groom.points[k] + aside * (1.0 + (thicken.tip - 1.0) * i as f32 / last);
                groom.points.push(p);
            }
            groom.offsets.push(groom.points.len() as u32);
        }
    }
    let times = 1 + thicken.copies as usize;
    repeat(&mut groom.radii, times);
    repeat(&mut groom.colors, times);
    repeat(&mut groom.groups, times);
    repeat(&mut groom.root_uvs, times);
    repeat(&mut groom.scales, times);
    repeat(&mut groom.guides, times);
}

/// Repeats `array` `times` times. An empty array stays empty.
fn repeat<T: Clone>(array: &mut Vec<T>, times: usize) {
    let n = array.len();
    array.reserve(n * (times - 1));
    for _ in 1..times {
        array.extend_from_within(..n);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_stand_on_the_skin_around_their_strand_and_follow_it() {
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, -1.0), Vec3::NEG_Z],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        mesh.compute_normals();
        // The strands lie flat: a disc perpendicular to them would put half of the copies below the skin.
        let strand = |x: f32| {
            (0..4)
                .map(move |i| Vec3::new(x, 0.01 * (i > 0) as u8 as f32, -0.1 * i as f32 - 0.3))
                .collect::<Vec<_>>()
        };
        let mut groom = Groom::from_strands([strand(0.3), strand(0.7)], 4e-5);
        groom.groups = vec![0, 1];
        let settings = Thicken { copies: 50, radius: 0.02, tip: 3.0 };
        thicken(&mut groom, &settings, Some(&mesh));
        assert_eq!((groom.strand_count(), groom.radii.len(), groom.groups.len()), (102, 408, 102));
        for s in 2..102 {
            let (copy, parent) = (groom.strand(s), groom.strand(s % 2));
            let (root, tip) = (copy[0].distance(parent[0]), copy[3].distance(parent[3]));
            assert!(copy[0].y.abs() < 1e-6 && root <= 0.02, "the root of copy {s} is at {}", copy[0]);
            assert!((tip - 3.0 * root).abs() < 1e-5);
            assert_eq!(groom.guides[s].guides[0] as usize, s % 2);
            assert_eq!(groom.group(s), (s % 2) as u16);
        }
    }
}
