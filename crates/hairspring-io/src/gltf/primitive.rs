//! Primitives of meshes, and the way in which messages name them.

use super::{given, json};
use crate::{Problem, text};
use glam::Affine3A;

/// A node that holds a mesh, and the primitive of the mesh that is read.
pub(super) struct NodeOf<'a> {
    pub node: &'a json::Node,
    pub index: usize,
    pub mesh: &'a json::Mesh,
    pub mesh_index: usize,
    /// Transform of the copy of the mesh, in the space of the node.
    pub copy: Affine3A,
    /// Index of the primitive.
    pub primitive: usize,
}

impl NodeOf<'_> {
    /// The default weights of its morph targets.
    pub fn weights(&self) -> &[f32] {
        let weights = self.node.weights.as_ref().or(self.mesh.weights.as_ref());
        weights.map_or(&[][..], |w| w)
    }

    /// The primitive in a sentence.
    pub fn place(&self) -> String {
        place(self.mesh, self.mesh_index, self.primitive)
    }

    /// Creates a problem of the primitive.
    pub fn wrong(&self, text: &str) -> Problem {
        Problem::whole(format!("{}: {text}", self.place()))
    }
}

/// The name of the mesh with this index.
pub(super) fn name(mesh: &json::Mesh, index: usize) -> String {
    given(&mesh.name).map_or_else(|| format!("mesh{index}"), text::name)
}

/// A primitive of the mesh with this index, as error messages name it.
pub(super) fn place(mesh: &json::Mesh, index: usize, primitive: usize) -> String {
    format!("mesh {:?}, primitive {primitive}", name(mesh, index))
}
