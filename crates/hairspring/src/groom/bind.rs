//! Where a strand's root sits on the scalp.

use crate::body::Mesh;
use glam::Vec3;

use super::Groom;

/// A root's place on a triangle mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootBinding {
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric coordinates on it; sum 1.
    pub barycentric: Vec3,
    /// Distance from the surface to the root along the triangle's normal, kept while the skin moves [m].
    pub offset: f32,
}

/// Binds every strand that has no binding yet to the nearest place of `mesh`.
pub fn bind_roots(groom: &mut Groom, mesh: &Mesh) {
    let _ = (groom, mesh);
}
