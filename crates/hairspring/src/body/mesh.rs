//! A triangle mesh in its rest pose.

use glam::{Vec2, Vec3};

/// A triangle mesh [m], counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions in the rest pose [m]; shape `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals; shape `[vertices]`. Readers fill them by [`Mesh::compute_normals`] where the file has none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates; shape `[vertices]`, or empty.
    pub uvs: Vec<Vec2>,
    /// Vertex indices of each triangle; shape `[triangles]`.
    pub triangles: Vec<[u32; 3]>,
    /// Named parts (groups, primitives), each a run of triangles, in order and covering all of them; or empty: one part.
    pub parts: Vec<Part>,
}

/// A named run of a mesh's triangles with its own colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The file's name for it.
    pub name: String,
    /// Which triangles.
    pub triangles: std::ops::Range<u32>,
    /// Linear RGB base colour, 0 to 1.
    pub color: Vec3,
    /// Specular sharpness, 0 (glossy) to 1 (matt).
    pub roughness: f32,
}

impl Mesh {
    /// Corner positions of triangle `t` [m].
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|i| self.positions[i as usize])
    }

    /// Fills `normals` from the positions: the mean of the adjoining faces' normals weighted by area.
    pub fn compute_normals(&mut self) {
        self.normals = vertex_normals(&self.positions, &self.triangles);
    }

    /// Adds the vertices, triangles and parts of `other` after its own. A mesh without parts among ones with parts is drawn as
    /// triangles of no part; missing texture coordinates are 0 where the other mesh has some.
    pub fn append(&mut self, other: Mesh) {
        let (vertices, triangles) = (self.positions.len(), self.triangles.len() as u32);
        if !(self.uvs.is_empty() && other.uvs.is_empty()) {
            self.uvs.resize(vertices, Vec2::ZERO);
            self.uvs.extend(other.uvs);
            self.uvs.resize(vertices + other.positions.len(), Vec2::ZERO);
        }
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + vertices as u32)));
        let moved =
            |p: Part| Part { triangles: p.triangles.start + triangles..p.triangles.end + triangles, ..p };
        self.parts.extend(other.parts.into_iter().map(moved));
    }

    /// Smallest box around all vertices, `(min, max)` [m]; `None` without vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p))))
    }
}

/// Area-weighted unit vertex normals; +Y for vertices of no triangle.
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
