//! A triangle mesh in its rest pose.

use glam::{Vec2, Vec3};

/// A triangle mesh [m], counter-clockwise seen from outside.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions in the rest pose [m]; shape `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals; shape `[vertices]`. If a file has none, its reader computes them with
    /// [`Mesh::compute_normals`].
    pub normals: Vec<Vec3>,
    /// Texture coordinates, v upward from the lower edge of the texture; shape `[vertices]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Color of each vertex, 0 to 1, as the file has it: maps over the scalp use it, pictures do not; shape
    /// `[vertices]`, or empty.
    pub colors: Vec<Vec3>,
    /// Vertex indices of each triangle; shape `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// Named parts (groups, primitives). Each is a range of triangles; together they cover all triangles in
    /// order. Empty: the mesh is a single part.
    pub parts: Vec<Part>,
}

/// A named range of a mesh's triangles with its own color.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name of the part in the file.
    pub name: String,
    /// Range of triangle indices.
    pub triangles: std::ops::Range<u32>,
    /// Linear RGB base color, 0 to 1.
    pub color: Vec3,
    /// Roughness, 0 (glossy) to 1 (matte).
    pub roughness: f32,
}

impl Mesh {
    /// Returns the corner positions of triangle `t` [m].
    ///
    /// # Panics
    /// If there is no triangle `t`, or it names a vertex that does not exist.
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|i| self.positions[i as usize])
    }

    /// Sets `normals` to the area-weighted mean of the normals of the adjoining faces.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist.
    pub fn compute_normals(&mut self) {
        self.normals = vertex_normals(&self.positions, &self.triangles);
    }

    /// Appends the vertices, triangles and parts of `other`. If only one of the two meshes has parts, the
    /// triangles of the other belong to no part. If only one has texture coordinates or
    /// colors, those of the other are 0.
    pub fn append(&mut self, other: Mesh) {
        let (vertices, triangles) = (self.positions.len(), self.triangles.len() as u32);
        if !(self.uvs.is_empty() && other.uvs.is_empty()) {
            self.uvs.resize(vertices, Vec2::ZERO);
            self.uvs.extend(other.uvs);
            self.uvs.resize(vertices + other.positions.len(), Vec2::ZERO);
        }
        if !(self.colors.is_empty() && other.colors.is_empty()) {
            self.colors.resize(vertices, Vec3::ZERO);
            self.colors.extend(other.colors);
            self.colors.resize(vertices + other.positions.len(), Vec3::ZERO);
        }
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + vertices as u32)));
        let moved =
            |p: Part| Part { triangles: p.triangles.start + triangles..p.triangles.end + triangles, ..p };
        self.parts.extend(other.parts.into_iter().map(moved));
    }

    /// Returns the bounding box of all vertices, `(min, max)` [m]; `None` if there are no vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p))))
    }
}

/// Returns area-weighted unit vertex normals; +Y for vertices of no triangle.
pub(super) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let n = (b - a).cross(c - a);
        for i in t {
            normals[*i as usize] += n;
        }
    }
    normals.iter_mut().for_each(|n| *n = n.try_normalize().unwrap_or(Vec3::Y));
    normals
}
