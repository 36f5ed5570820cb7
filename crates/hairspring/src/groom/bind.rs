//! Binding of strand roots to the scalp.

use super::Groom;
use crate::body::{Mesh, NearestTree, place_on};
use crate::parallel::prelude::*;
use glam::{Mat3, Quat, Vec3};

/// Binding of a root to a triangle of a mesh: the root moves with the triangle.
///
/// For an example, see [`bind_roots`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootBinding {
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric coordinates on the triangle, each 0 to 1; sum 1.
    pub barycentric: Vec3,
    /// Offset from that point on the surface to the root, in the triangle's frame ([`RootBinding::frame`]; y
    /// along the normal) [m]. It stays constant while the skin moves. Its tangential components are 0 except
    /// for roots beyond an edge of the mesh.
    pub offset: Vec3,
}

impl RootBinding {
    /// Binds the root `p` [m] to the point `barycentric` of the triangle with these `corners` and the index
    /// `triangle`.
    pub fn new(triangle: u32, barycentric: Vec3, corners: [Vec3; 3], p: Vec3) -> Self {
        let offset = triangle_frame(corners).inverse() * (p - place_on(barycentric, corners));
        Self { triangle, barycentric, offset }
    }

    /// Returns the position of the root when its triangle has these corners [m].
    pub fn position(&self, corners: [Vec3; 3]) -> Vec3 {
        place_on(self.barycentric, corners) + self.frame(corners) * self.offset
    }

    /// Returns the orientation of a triangle with these corners: x along its first edge, y along its normal.
    /// Between two poses the root rotates by `frame(posed) * frame(rest).inverse()`.
    pub fn frame(&self, corners: [Vec3; 3]) -> Quat {
        triangle_frame(corners)
    }
}

/// Returns the orientation of a triangle: x along the first edge, y along the normal. A degenerate triangle
/// gets an arbitrary frame.
fn triangle_frame([a, b, c]: [Vec3; 3]) -> Quat {
    let x = (b - a).try_normalize().or((c - a).try_normalize()).unwrap_or(Vec3::X);
    let y = (b - a).cross(c - a).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y))).normalize()
}

/// Binds every root to the nearest point of `mesh`, unless the groom already has bindings. A mesh without
/// triangles binds nothing. A root that is not finite has no nearest point: it is bound to the first corner of the first
/// triangle.
///
/// ```
/// use glam::Vec3;
/// use hairspring::{body::Mesh, groom::{Groom, bind_roots}};
///
/// let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
/// let mesh = Mesh { positions, triangles: vec![[0, 2, 1]], ..Default::default() };
/// let root = Vec3::new(0.2, 0.0, 0.2);
/// let mut groom = Groom::from_strands([[root, root + Vec3::Y, root + Vec3::Y * 2.0]], 35e-6);
/// bind_roots(&mut groom, &mesh);
/// assert!(groom.roots[0].position(mesh.corners(0)).distance(root) < 1e-6);
/// ```
///
/// # Panics
/// If a triangle names a vertex that does not exist.
pub fn bind_roots(groom: &mut Groom, mesh: &Mesh) {
    bind_roots_where(groom, mesh, |_, _| true);
}

/// Like [`bind_roots`], but strand `s` is bound only to triangles `t` with `allowed(s, t)`, if there are any.
///
/// For an example, see [`bind_roots`].
pub fn bind_roots_where(groom: &mut Groom, mesh: &Mesh, allowed: impl Fn(usize, usize) -> bool + Sync) {
    if !groom.roots.is_empty() || mesh.triangles.is_empty() {
        return;
    }
    let tree = NearestTree::new(mesh);
    let lost = RootBinding { triangle: 0, barycentric: Vec3::X, offset: Vec3::ZERO };
    groom.roots = (0..groom.strand_count())
        .into_par_iter()
        .map(|s| {
            let root = groom.strand(s).first().copied().unwrap_or(Vec3::ZERO);
            let place = tree.nearest(root, |t| allowed(s, t)).or_else(|| tree.nearest(root, |_| true));
            place.map_or(lost, |place| {
                let corners = mesh.corners(place.triangle as usize);
                RootBinding::new(place.triangle, place.barycentric, corners, root)
            })
        })
        .collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square() -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, -1.0), Vec3::NEG_Z],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    }

    fn groom_at(roots: &[Vec3]) -> Groom {
        Groom::from_strands(roots.iter().map(|r| [*r, *r + Vec3::Y * 0.1, *r + Vec3::Y * 0.2]), 4e-5)
    }

    #[test]
    fn a_root_above_the_surface_keeps_its_height() {
        let mesh = square();
        let mut groom = groom_at(&[Vec3::new(0.75, 0.02, -0.25)]);
        bind_roots(&mut groom, &mesh);
        let root = groom.roots[0];
        assert_eq!(root.triangle, 0);
        assert!(root.offset.distance(Vec3::Y * 0.02) < 1e-6, "{}", root.offset);
    }

    #[test]
    fn a_filter_chooses_the_surface_and_gives_way_where_nothing_passes() {
        let mesh = square();
        let mut groom = groom_at(&[Vec3::new(0.75, 0.0, -0.25), Vec3::new(0.75, 0.0, -0.25)]);
        bind_roots_where(&mut groom, &mesh, |s, t| s == 0 && t == 1);
        assert_eq!([groom.roots[0].triangle, groom.roots[1].triangle], [1, 0]);
    }

    #[test]
    fn bindings_that_are_there_stay_and_an_empty_mesh_binds_nothing() {
        let mut groom = groom_at(&[Vec3::ZERO]);
        bind_roots(&mut groom, &Mesh::default());
        assert!(groom.roots.is_empty());
        bind_roots(&mut groom, &square());
        let bound = groom.roots.clone();
        groom.points[0] = Vec3::new(0.9, 0.0, -0.1);
        bind_roots(&mut groom, &square());
        assert_eq!(groom.roots, bound);
    }

    fn point(size: f32) -> impl Strategy<Value = Vec3> {
        (-size..size, -size..size, -size..size).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn the_binding_gives_the_root_back_and_moves_rigidly(
            corners in [point(1.0), point(1.0), point(1.0)],
            root in point(2.0),
            axis in point(1.0),
            angle in -3.0f32..3.0,
            shift in point(1.0),
        ) {
            let mesh = Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Mesh::default() };
            let mut groom = groom_at(&[root]);
            bind_roots(&mut groom, &mesh);
            let binding = groom.roots[0];
            let back = binding.position(corners);
            prop_assert!(back.distance(root) < 1e-5, "{back} is not {root}");
            // Slivers have no stable frame.
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            prop_assume!(area > 1e-2);
            let turn = Quat::from_axis_angle(axis.normalize_or(Vec3::Y), angle);
            let posed = corners.map(|c| turn * c + shift);
            let moved = binding.position(posed);
            prop_assert!(moved.distance(turn * root + shift) < 2e-4, "{moved}");
            let turned = binding.frame(posed) * binding.frame(corners).inverse();
            prop_assert!(turned.dot(turn).abs() > 0.9999, "{turned} is not {turn}");
        }
    }
}
