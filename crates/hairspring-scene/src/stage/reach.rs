//! The region of space that hair can reach.

use crate::Scene;
use glam::Vec3;

/// The region that hair can reach: points no farther from a root than the longest strand.
pub(super) struct Reach {
    /// Vertices of the skin around the roots.
    vertices: Vec<u32>,
    /// Distance from those to the farthest tip, with a margin for the strain limit [m].
    length: f32,
}

impl Reach {
    pub(super) fn new(scene: &Scene) -> Self {
        let mut reach = Self { vertices: Vec::new(), length: 0.0 };
        let Some(mesh) = scene.body.as_ref().map(|b| &b.mesh) else { return reach };
        for groom in scene.grooms.iter().map(|g| &g.groom) {
            for (s, root) in groom.roots.iter().enumerate() {
                reach.vertices.extend(mesh.triangles[root.triangle as usize]);
                reach.length = reach.length.max(1.02 * groom.strand_length(s) + root.offset.length());
            }
            if groom.roots.is_empty() && groom.strand_count() > 0 {
                // Roots that are not bound to the skin may be anywhere.
                return Self { vertices: Vec::new(), length: 0.0 };
            }
        }
        reach.vertices.sort_unstable();
        reach.vertices.dedup();
        reach
    }

    /// Returns the bounding box (min, max) of the hair, in the space that `to` maps the skin's `positions`
    /// to; `None` if there is no bound.
    pub(super) fn bounds(&self, positions: &[Vec3], to: impl Fn(Vec3) -> Vec3) -> Option<(Vec3, Vec3)> {
        let mut roots = self.vertices.iter().map(|v| to(positions[*v as usize]));
        let first = roots.next()?;
        let (lo, hi) = roots.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some((lo - self.length, hi + self.length))
    }
}
