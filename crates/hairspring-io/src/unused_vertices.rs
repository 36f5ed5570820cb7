//! Vertices of a mesh that no triangle uses.

use glam::Vec3;
use hairspring::body::Mesh;

/// Moves vertices that no triangle uses into the box around the others, so that they do not decide the size of the mesh.
/// They keep their numbers, by which weights and caches name them. Returns a note if there are any outside. If most of the
/// vertices are, they stay: a hull is made of them.
pub(crate) fn keep_inside(mesh: &mut Mesh) -> Option<String> {
    let mut used = vec![false; mesh.positions.len()];
    mesh.triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
    let corners = || mesh.positions.iter().zip(&used).filter(|(_, used)| **used).map(|(p, _)| *p);
    let (lo, hi) = crate::units::bounds(corners());
    if !(lo.is_finite() && hi.is_finite()) {
        return None;
    }
    let is_outside = |(p, used): (&Vec3, &bool)| !(*used || p.cmpge(lo).all() && p.cmple(hi).all());
    let count = mesh.positions.iter().zip(&used).filter(|pair| is_outside(*pair)).count();
    // A cloud of points, of which a hull is made.
    if count == 0 || count * 2 > used.len() {
        return None;
    }
    for (p, _) in mesh.positions.iter_mut().zip(&used).filter(|(_, used)| !**used) {
        *p = p.max(lo).min(hi);
    }
    Some(format!("{count} vertices that no face uses lie outside of the mesh and do not count; remove them"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_vertices_without_a_face_move() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 5.0, Vec3::splat(0.5).with_z(0.0)];
        let mut mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        assert!(keep_inside(&mut mesh).unwrap().starts_with("1 vertices"));
        assert_eq!(mesh.positions[..4], [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X]);
        assert_eq!(keep_inside(&mut mesh), None);
        assert_eq!(keep_inside(&mut Mesh::default()), None);
    }
}
