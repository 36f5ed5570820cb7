//! Measures the thickness of a closed mesh along rays through it, and finds parts that are too thin for its
//! distance field.

use glam::Vec3;
use hairspring::body::Mesh;
use parry3d::{
    query::{Ray, RayCast},
    shape::TriMesh,
};
use rayon::prelude::*;
use std::{collections::HashSet, fmt};

/// A triangle with its center and normal.
pub(super) type Place = (u32, Vec3, Vec3);

/// Returns a sample of the triangles of a `mesh`: in each cube of edge `spacing` [m], one for each direction
/// they face.
pub(super) fn places(mesh: &Mesh, spacing: f32) -> Vec<Place> {
    let mut seen = HashSet::new();
    let place = |triangle: usize| {
        let corners = mesh.corners(triangle);
        let (middle, normal) = (corners.iter().sum::<Vec3>() / 3.0, normal(corners)?);
        // Truncated to −1, 0 or 1 along each axis: at most 26 directions.
        let faces = (normal * 1.999).as_ivec3();
        let new = seen.insert(((middle / spacing).floor().as_ivec3(), faces));
        new.then_some((triangle as u32, middle, normal))
    };
    (0..mesh.triangles.len()).filter_map(place).collect()
}

/// Returns the unit normal of a triangle; `None` if it has no area.
pub(super) fn normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    (b - a).cross(c - a).try_normalize()
}

/// Returns the thickness of a closed `mesh` behind samples `spacing` [m] apart: each sample with the distance
/// to the opposite side [m]. Distances below `skip` [m] are ignored. Samples without an opposite side, as in
/// an open shell, are omitted.
pub(super) fn thicknesses(mesh: &Mesh, spacing: f32, skip: f32) -> Vec<(Place, f32)> {
    if !mesh.positions.iter().all(|p| p.is_finite()) {
        return Vec::new();
    }
    // Relative to the mesh, so that a ray starts below its triangle far from the origin too.
    let origin = mesh.positions.first().copied().unwrap_or_default();
    let vertices = mesh.positions.iter().map(|p| (*p - origin).to_array().into()).collect();
    let Ok(solid) = TriMesh::new(vertices, mesh.triangles.clone()) else { return Vec::new() };
    let thickness = |place: Place| {
        let (triangle, _, normal) = place;
        let middle = mesh.corners(triangle as usize).iter().map(|p| *p - origin).sum::<Vec3>() / 3.0;
        // Starts just below the surface, so that the ray does not hit the triangle itself.
        let from = middle - normal * skip;
        let ray = Ray::new(from.to_array().into(), (-normal).to_array().into());
        Some((place, solid.cast_local_ray(&ray, f32::MAX, false)? + skip))
    };
    places(mesh, spacing).into_par_iter().filter_map(thickness).collect()
}

/// Report of a collision mesh that is partly thinner than a cell of its distance field, so that hair may pass
/// through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinMesh {
    /// Fraction of the surface within reach of the hair that is too thin [1].
    pub share: f32,
    /// Minimum thickness [m].
    pub thickness: f32,
    /// Edge of the field's cells [m].
    pub cell: f32,
}

impl ThinMesh {
    /// Fraction of the surface above which it is reported [1]. Sharp edges of any mesh are thin.
    const TOLD: f32 = 0.01;

    /// Checks a closed `mesh` whose field has this `cell` [m], within the box that hair can reach.
    pub(super) fn find(mesh: &Mesh, cell: f32, within: Option<(Vec3, Vec3)>) -> Option<Self> {
        let reached = |p: Vec3| within.is_none_or(|(lo, hi)| p.cmpge(lo).all() && p.cmple(hi).all());
        let all = thicknesses(mesh, cell, 1e-3 * cell);
        let (mut seen, mut thin, mut least) = (0, 0, f32::MAX);
        for (_, thickness) in all.iter().filter(|((_, middle, _), _)| reached(*middle)) {
            seen += 1;
            if *thickness < cell {
                thin += 1;
                least = least.min(*thickness);
            }
        }
        let share = thin as f32 / seen.max(1) as f32;
        (share > Self::TOLD).then_some(Self { share, thickness: least, cell })
    }
}

impl fmt::Display for ThinMesh {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{:.0} % of the collision mesh near the hair is thinner (down to {:.1} mm) than the cells of its distance field ({:.1} mm), and hair may pass through it: \
             make it a [[sheet]], or add a [[collider]] with a capsule, box or hull in its place",
            100.0 * self.share,
            1e3 * self.thickness,
            1e3 * self.cell
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with these half-extents [m], each side divided into `n`² quads.
    fn cuboid(half: Vec3, n: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1.0f32), (axis, -1.0)]) {
            let first = mesh.positions.len() as u32;
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                let mut p = [0.0; 3];
                p[axis] = sign;
                p[(axis + 1) % 3] = sign * (2.0 * i as f32 / n as f32 - 1.0);
                p[(axis + 2) % 3] = 2.0 * j as f32 / n as f32 - 1.0;
                mesh.positions.push(Vec3::from(p) * half);
            }
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let [a, b] = [first + i * (n + 1) + j, first + (i + 1) * (n + 1) + j];
                mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
        mesh
    }

    #[test]
    fn a_mesh_thinner_than_a_cell_is_reported_if_it_is_near_hair() {
        let bar = cuboid(Vec3::new(0.2, 0.005, 0.001), 8);
        let thin = ThinMesh::find(&bar, 0.003, None).expect("2 mm are thinner than 3 mm");
        assert!((thin.thickness - 0.002).abs() < 1e-4 && thin.share > 0.3, "{thin:?}");
        assert_eq!(ThinMesh::find(&bar, 0.0015, None), None);
        let elsewhere = Some((Vec3::splat(1.0), Vec3::splat(2.0)));
        assert_eq!(ThinMesh::find(&bar, 0.003, elsewhere), None);
        assert_eq!(ThinMesh::find(&cuboid(Vec3::splat(0.1), 8), 0.003, None), None);
    }
}
