//! A body: a mesh with its skeleton and skin, and the vertex positions in a pose.

use super::{Mesh, Part, Trs, mesh::vertex_normals};
use glam::{Affine3A, Vec3, Vec3A};

/// One joint of a skeleton.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name of the joint in the file.
    pub name: String,
    /// Index of the parent, always smaller than the joint's own; `None` for a root.
    pub parent: Option<u32>,
    /// Transform relative to the parent in the rest pose.
    pub rest: Trs,
}

/// Skinning data: how the vertices of a mesh follow the joints.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Up to four joints of each vertex; shape `[vertices]`.
    pub joints: Vec<[u16; 4]>,
    /// Weights of those joints, summing to 1; shape `[vertices]`.
    pub weights: Vec<[f32; 4]>,
    /// Transform of a rest-pose vertex into each joint's space; shape `[joints]`.
    pub inverse_bind: Vec<Affine3A>,
}

impl Skin {
    /// Returns the transform of each joint from the rest pose to its matrix in `world`.
    pub fn matrices(&self, world: &[Affine3A]) -> Vec<Affine3A> {
        world.iter().zip(&self.inverse_bind).map(|(w, b)| *w * *b).collect()
    }

    /// Returns the posed position of a vertex whose rest position is `rest` [m] (linear blend skinning).
    /// `matrices` are those of [`Skin::matrices`].
    ///
    /// # Panics
    /// If there is no such vertex, or it names a joint without a matrix.
    pub fn place(&self, vertex: usize, rest: Vec3, matrices: &[Affine3A]) -> Vec3 {
        let mut at = Vec3A::ZERO;
        for (j, w) in self.joints[vertex].iter().zip(self.weights[vertex]) {
            if w > 0.0 {
                at += matrices[*j as usize].transform_point3a(Vec3A::from(rest)) * w;
            }
        }
        at.into()
    }
}

/// A mesh with its skeleton. Without a skin the whole mesh is rigid and moves with joint 0.
///
/// For an example, see [`body`](crate::body).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The surface.
    pub mesh: Mesh,
    /// Joints, parents before children. Empty: the body never moves.
    pub joints: Vec<Joint>,
    /// Skinning data. `None`: the body is rigid.
    pub skin: Option<Skin>,
}

impl Body {
    /// Creates a rigid body with one joint at the origin.
    pub fn rigid(mesh: Mesh) -> Self {
        let joints = vec![Joint { name: "root".into(), parent: None, rest: Trs::default() }];
        Self { mesh, joints, skin: None }
    }

    /// Returns the index of the joint with this name, ignoring ASCII case.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|j| j.name.eq_ignore_ascii_case(name))
    }

    /// Keeps only the triangles of the parts for which `keep` returns true, and the vertices that they use.
    pub fn keep_parts(&mut self, keep: impl Fn(&str) -> bool) {
        let mesh = &mut self.mesh;
        let parts = std::mem::take(&mut mesh.parts);
        let old = std::mem::take(&mut mesh.triangles);
        for part in parts.into_iter().filter(|p| keep(&p.name)) {
            let first = mesh.triangles.len() as u32;
            mesh.triangles
                .extend_from_slice(&old[part.triangles.start as usize..part.triangles.end as usize]);
            mesh.parts.push(Part { triangles: first..mesh.triangles.len() as u32, ..part });
        }
        self.drop_unused();
    }

    /// Returns a copy of the body with only the triangles whose index `keep` accepts, and the vertices that
    /// they use. The copy has no parts.
    pub fn with_triangles(&self, keep: impl Fn(usize) -> bool) -> Self {
        let mut body = self.clone();
        body.mesh.parts.clear();
        let mut index = 0..;
        body.mesh.triangles.retain(|_| index.next().is_some_and(&keep));
        body.drop_unused();
        body
    }

    /// Drops vertices that no triangle uses.
    fn drop_unused(&mut self) {
        let mesh = &mut self.mesh;
        let mut used = vec![false; mesh.positions.len()];
        mesh.triangles.iter().flatten().for_each(|i| used[*i as usize] = true);
        let mut next = 0;
        let moved: Vec<u32> = used
            .iter()
            .map(|u| {
                next += u32::from(*u);
                next.wrapping_sub(1)
            })
            .collect();
        mesh.triangles.iter_mut().flatten().for_each(|i| *i = moved[*i as usize]);
        retain_used(&mut mesh.positions, &used);
        retain_used(&mut mesh.normals, &used);
        retain_used(&mut mesh.uvs, &used);
        retain_used(&mut mesh.colors, &used);
        if let Some(skin) = &mut self.skin {
            retain_used(&mut skin.joints, &used);
            retain_used(&mut skin.weights, &used);
        }
    }

    /// Returns the model-space matrix of every joint for the local transforms `pose` of shape `[joints]`.
    ///
    /// # Panics
    /// If a parent does not precede its joint.
    pub fn world(&self, pose: &[Trs]) -> Vec<Affine3A> {
        let mut world: Vec<Affine3A> = Vec::with_capacity(self.joints.len());
        for (joint, local) in self.joints.iter().zip(pose) {
            let local = local.to_affine();
            world.push(joint.parent.map_or(local, |p| world[p as usize] * local));
        }
        world
    }

    /// Returns the local transforms of the rest pose; shape `[joints]`.
    pub fn rest_pose(&self) -> Vec<Trs> {
        self.joints.iter().map(|j| j.rest).collect()
    }

    /// Writes the vertex positions [m] and unit normals of the pose with joint matrices `world` (linear blend
    /// skinning).
    ///
    /// # Panics
    /// If the skin has fewer vertices than the mesh, or names a joint without a matrix.
    pub fn skinned(&self, world: &[Affine3A], positions: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        positions.clear();
        normals.clear();
        let Some(skin) = &self.skin else {
            let m = world.first().copied().unwrap_or(Affine3A::IDENTITY);
            positions.extend(self.mesh.positions.iter().map(|p| m.transform_point3(*p)));
            normals.extend(self.mesh.normals.iter().map(|n| m.transform_vector3(*n).normalize_or(Vec3::Y)));
            return;
        };
        let matrices = skin.matrices(world);
        let rest = self.mesh.positions.iter().enumerate();
        positions.extend(rest.map(|(vertex, p)| skin.place(vertex, *p, &matrices)));
        *normals = vertex_normals(positions, &self.mesh.triangles);
    }
}

/// Removes the elements that are not used. An empty array stays empty.
fn retain_used<T>(array: &mut Vec<T>, used: &[bool]) {
    let mut used = used.iter();
    array.retain(|_| used.next().copied().unwrap_or(false));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeping_a_part_keeps_its_triangles_and_vertices_only() {
        let part =
            |name: &str, triangles| Part { name: name.into(), triangles, color: Vec3::ONE, roughness: 1.0 };
        let mut body = Body::rigid(Mesh {
            positions: (0..6).map(|i| Vec3::splat(i as f32)).collect(),
            normals: vec![Vec3::Y; 6],
            uvs: Vec::new(),
            colors: (0..6).map(|i| Vec3::splat(i as f32)).collect(),
            triangles: vec![[0, 1, 2], [3, 4, 5], [5, 3, 4]],
            parts: vec![part("helper", 0..1), part("body", 1..3)],
        });
        body.keep_parts(|name| name == "body");
        assert_eq!(body.mesh.triangles, [[0, 1, 2], [2, 0, 1]]);
        assert_eq!(body.mesh.positions, [Vec3::splat(3.0), Vec3::splat(4.0), Vec3::splat(5.0)]);
        assert_eq!(body.mesh.colors, body.mesh.positions);
        assert_eq!((body.mesh.normals.len(), body.mesh.parts[0].triangles.clone()), (3, 0..2));
    }
}
