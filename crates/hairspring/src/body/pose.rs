//! A body: mesh, skeleton and skin, and where its vertices are in a pose.

use super::{Mesh, Trs, mesh::vertex_normals};
use glam::{Affine3A, Vec3, Vec3A};

/// One joint of a skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The file's name for it.
    pub name: String,
    /// Index of the parent, always smaller than the joint's own; `None` for a root.
    pub parent: Option<u32>,
    /// Transform relative to the parent in the rest pose.
    pub rest: Trs,
}

/// How a mesh follows its joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Up to four joints of each vertex; shape `[vertices]`.
    pub joints: Vec<[u16; 4]>,
    /// Their weights, summing to 1; shape `[vertices]`.
    pub weights: Vec<[f32; 4]>,
    /// Takes a rest-pose vertex into each joint's space; shape `[joints]`.
    pub inverse_bind: Vec<Affine3A>,
}

/// A mesh with its skeleton. Without a skin the whole mesh is rigid and moves with joint 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The surface.
    pub mesh: Mesh,
    /// Joints, parents before children; empty: the body never moves.
    pub joints: Vec<Joint>,
    /// Weights; `None`: rigid.
    pub skin: Option<Skin>,
}

impl Body {
    /// A body that does not deform, with one joint at the origin to move it by.
    pub fn rigid(mesh: Mesh) -> Self {
        let joints = vec![Joint {
            name: "root".into(),
            parent: None,
            rest: Trs::default(),
        }];
        Self {
            mesh,
            joints,
            skin: None,
        }
    }

    /// Index of the joint of this name, upper and lower case alike.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints
            .iter()
            .position(|j| j.name.eq_ignore_ascii_case(name))
    }

    /// Model-space matrix of every joint for local transforms `pose` of shape `[joints]`.
    pub fn world(&self, pose: &[Trs]) -> Vec<Affine3A> {
        let mut world: Vec<Affine3A> = Vec::with_capacity(self.joints.len());
        for (joint, local) in self.joints.iter().zip(pose) {
            let local = local.to_affine();
            world.push(joint.parent.map_or(local, |p| world[p as usize] * local));
        }
        world
    }

    /// Local transforms of the rest pose; shape `[joints]`.
    pub fn rest_pose(&self) -> Vec<Trs> {
        self.joints.iter().map(|j| j.rest).collect()
    }

    /// Writes vertex positions [m] and unit normals of the pose whose joint matrices are `world`
    /// (linear blend skinning).
    pub fn skinned(&self, world: &[Affine3A], positions: &mut Vec<Vec3>, normals: &mut Vec<Vec3>) {
        positions.clear();
        normals.clear();
        let Some(skin) = &self.skin else {
            let m = world.first().copied().unwrap_or(Affine3A::IDENTITY);
            positions.extend(self.mesh.positions.iter().map(|p| m.transform_point3(*p)));
            normals.extend(
                self.mesh
                    .normals
                    .iter()
                    .map(|n| m.transform_vector3(*n).normalize_or(Vec3::Y)),
            );
            return;
        };
        let matrices: Vec<Affine3A> = world
            .iter()
            .zip(&skin.inverse_bind)
            .map(|(w, b)| *w * *b)
            .collect();
        for ((p, joints), weights) in self
            .mesh
            .positions
            .iter()
            .zip(&skin.joints)
            .zip(&skin.weights)
        {
            let mut at = Vec3A::ZERO;
            for (j, w) in joints.iter().zip(weights) {
                if *w > 0.0 {
                    at += matrices[*j as usize].transform_point3a(Vec3A::from(*p)) * *w;
                }
            }
            positions.push(at.into());
        }
        *normals = vertex_normals(positions, &self.mesh.triangles);
    }
}
