//! Notes about data of a glTF mesh that is ignored or changed.

/// Counts of objects that are ignored or changed while reading.
#[derive(Default)]
pub(super) struct LeftOut {
    /// Nodes that draw copies of a mesh with a skin.
    pub copies: usize,
    /// Primitives of points and lines.
    pub lines: usize,
    /// Primitives without positions.
    pub positionless: usize,
    /// Primitives without joints in a mesh with a skin.
    pub rigid: usize,
    /// Vertices with a weight that is negative or not finite.
    pub wrong_weights: usize,
    /// Vertices whose weights do not sum to 1.
    pub unnormalized: usize,
    /// Vertices with a skin but without a weight.
    pub unweighted: usize,
    /// Vertices that follow more than four joints.
    pub crowded: usize,
    /// Primitives of triangles with a number of indices that is no multiple of three.
    pub incomplete: usize,
    /// Primitives whose colors cannot be read, or are not one for each vertex.
    pub colors: usize,
}

impl LeftOut {
    pub(super) fn note(&self, notes: &mut Vec<String>) {
        let mut note = |count: usize, text: &str| {
            if count > 0 {
                notes.push(format!("{count} {text}"));
            }
        };
        note(
            self.lines,
            "primitives of lines or points are left out; convert them to triangles to keep them",
        );
        note(
            self.positionless,
            "primitives have no positions (POSITION) and are left out; export the file again",
        );
        note(
            self.copies,
            "nodes draw copies of a mesh with a skin (EXT_mesh_gpu_instancing), of which one is read; export without instancing",
        );
        note(
            self.rigid,
            "primitives of a skinned mesh have no joints and move rigidly with their node; weight them to joints",
        );
        note(
            self.wrong_weights,
            "vertices of skinned meshes have weights that are below 0 or not finite, which count as 0; normalize the weights in the modeling program",
        );
        note(
            self.unnormalized,
            "vertices of skinned meshes have weights that do not sum to 1 and are scaled to that sum; normalize the weights in the modeling program",
        );
        note(
            self.unweighted,
            "vertices of skinned meshes have no weight and follow one joint; weight them in the modeling program",
        );
        note(
            self.incomplete,
            "primitives end with an incomplete triangle, which is left out; export the file again",
        );
        note(
            self.colors,
            "primitives have a COLOR_0 that is not one color of three or four components for each vertex; it is left out",
        );
        note(
            self.crowded,
            "vertices follow more than four joints, and the four largest weights are kept; limit the weights to four to choose them",
        );
    }
}
