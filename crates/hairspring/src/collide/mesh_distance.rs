//! Distance to the mesh that a field was made from, for reports. The field rounds sharp edges off, which would
//! hide how deep hair is there.

use super::{ColliderShape, SignedDistanceField, voxelize::BAND};
use crate::body::{nearest_on_triangle, place_on};
use glam::Vec3;

/// Largest difference between a field and its mesh at which both describe the same surface [cells]. At a sharp edge
/// they differ by a third of a cell.
const SAME_SURFACE: f32 = 0.5;

impl ColliderShape {
    /// Returns the distance from `p` [m] in the collider's own space to its exact surface, negative inside. For
    /// a field within a cell of the surface, that is its mesh. Otherwise it is the distance that the solver
    /// uses, [`ColliderShape::distance`].
    pub fn distance_to_surface(&self, p: Vec3) -> f32 {
        match self {
            ColliderShape::Field(grid) => grid.distance_to_mesh(p),
            _ => self.distance(p),
        }
    }
}

impl SignedDistanceField {
    /// Returns the distance from `p` [m] to the mesh, negative inside. Farther than a cell from the surface, it
    /// returns the field's own distance.
    ///
    /// The candidates are the triangles nearest to the eight nodes around `p`. At sharp edges, the result is
    /// within a twentieth of a cell of the true distance; the field is off by up to a third. In a cell whose
    /// corners are all inside, `p` is inside too: a triangle there may be a wall between two overlapping
    /// pieces. In other cells, the sign is that of the triangle's plane. Of equally near triangles, at an edge
    /// or a corner, the one whose plane is farthest counts (compare Bærentzen and Aanæs 2005, *Signed Distance
    /// Computation Using the Angle Weighted Pseudonormal*). Where the result differs from the field by more than
    /// half a cell, the two describe different surfaces, and the field's distance is returned: the field closes
    /// holes of the mesh (`holes.rs`) and removes walls inside of it.
    pub fn distance_to_mesh(&self, p: Vec3) -> f32 {
        let own = self.distance_and_normal(p).0;
        let cell = self.lattice.cell;
        if own.abs() >= cell || self.triangles.is_empty() {
            return own;
        }
        let (_, low, _) = self.lattice.locate(p);
        let first = self.lattice.index(low);
        let (dy, dz) = (self.lattice.size.x as usize, (self.lattice.size.x * self.lattice.size.y) as usize);
        let nodes = [0, 1, dy, dy + 1, dz, dz + 1, dz + dy, dz + dy + 1].map(|step| first + step);
        let enclosed = nodes.iter().all(|node| self.distances[*node] < 0.0);
        // Squared distance, and how far from the triangle's plane.
        let mut best = (f32::MAX, 0.0f32);
        for (k, node) in nodes.iter().enumerate() {
            let triangle = self.nearest[*node];
            let known = self.distances[*node].abs() < 0.99 * BAND * cell;
            if !known || nodes[..k].iter().any(|before| self.nearest[*before] == triangle) {
                continue;
            }
            let corners = self.triangles[triangle as usize];
            let foot = place_on(nearest_on_triangle(p, corners), corners);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
            let (squared, off) = (p.distance_squared(foot), normal.dot(p - foot));
            // Feet on a shared edge or corner differ by rounding.
            let tie = 1e-4 * squared + 1e-8 * cell * cell;
            if squared < best.0 - tie || (squared <= best.0 + tie && off.abs() > best.1.abs()) {
                best = (squared.min(best.0), off);
            }
        }
        if !best.0.is_finite() || best.0 == f32::MAX {
            return own;
        }
        let outside = best.1 > 0.0 && !enclosed;
        let exact = if outside { best.0.sqrt() } else { -best.0.sqrt() };
        if (exact - own).abs() > SAME_SURFACE * cell { own } else { exact }
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        body::{Mesh, NearestTree},
        collide::{sdf::tests::balls, voxelize},
    };
    use glam::{Quat, Vec3};

    /// Numbers from 0 to 1 (the finalizer of MurmurHash3).
    fn hash(k: u32) -> f32 {
        let k = (k ^ k >> 16).wrapping_mul(0x85EB_CA6B);
        let k = (k ^ k >> 13).wrapping_mul(0xC2B2_AE35);
        ((k ^ k >> 16) >> 8) as f32 / (1 << 24) as f32
    }

    /// A cube with edges of 40 mm, turned so that none lies along the grid.
    fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>, Quat) {
        let turn = Quat::from_scaled_axis(Vec3::new(0.4, -0.7, 0.3));
        let corners = (0..8u32)
            .map(|k| turn * (Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32) - 0.5) * 0.04);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        (corners.collect(), triangles, turn)
    }

    #[test]
    fn at_the_edges_of_a_cube_it_is_the_distance_to_the_cube() {
        let (positions, triangles, turn) = cube();
        let grid = voxelize(&positions, &triangles, 0.004);
        let (mut worst, mut of_field) = (0.0f32, 0.0f32);
        for k in 0..20_000 {
            let local = (Vec3::new(hash(3 * k), hash(3 * k + 1), hash(3 * k + 2)) - 0.5) * 0.048;
            let q = local.abs() - Vec3::splat(0.02);
            let exact = q.max(Vec3::ZERO).length() + q.max_element().min(0.0);
            if exact.abs() < 0.002 {
                let p = turn * local;
                worst = worst.max((grid.distance_to_mesh(p) - exact).abs());
                of_field = of_field.max((grid.distance_and_normal(p).0 - exact).abs());
            }
        }
        // A twentieth of a cell: here and there the nearest triangle is nearest to no node around.
        assert!(worst < 2e-4, "off by up to {worst} m");
        assert!(
            of_field > 5e-4,
            "the field itself is exact there, and this test shows nothing: {of_field} m"
        );
    }

    #[test]
    fn on_round_bodies_it_is_the_distance_to_the_nearest_triangle() {
        for seed in 0..6 {
            let (positions, triangles) = balls(seed, true);
            let grid = voxelize(&positions, &triangles, 0.004);
            let mesh = Mesh { positions, triangles, ..Mesh::default() };
            let tree = NearestTree::new(&mesh);
            let (mut looked_at, mut off) = (0, 0);
            for k in 0..20_000 {
                let p = Vec3::new(hash(3 * k), hash(3 * k + 1), hash(3 * k + 2)) * 0.22 - 0.06;
                let own = grid.distance_and_normal(p).0;
                let exact = grid.distance_to_mesh(p);
                // Equal: the field describes another surface there.
                if own.abs() < 0.002 && exact != own {
                    looked_at += 1;
                    let nearest = tree.nearest(p, |_| true).unwrap().distance_squared.sqrt();
                    // The next triangle is nearest here and there.
                    off += usize::from((exact.abs() - nearest).abs() > 1e-4);
                }
            }
            assert!(looked_at > 200, "balls {seed}: {looked_at} places near the surface");
            assert!(
                off * 100 <= looked_at,
                "balls {seed}: off by over 0.1 mm at {off} of {looked_at} places"
            );
        }
    }
}
