//! What several promises about glTF files share: reading a file that was made in code, and parts to add to it.

use crate::gltf_file::{GltfFile, TETRAHEDRON};
use glam::{Affine3A, Vec3};
use hairspring_io::{Character, Problem, gltf};
use serde_json::json;

pub(crate) fn read(file: &GltfFile) -> (Character, Vec<String>) {
    gltf::parse(&file.glb(), &|_| None).unwrap_or_else(|e| panic!("{e}"))
}

pub(crate) fn refused(file: &GltfFile) -> Problem {
    gltf::parse(&file.glb(), &|_| None).unwrap_err()
}

/// Reads a file that must give the tetrahedron, and returns its notes.
pub(crate) fn read_tetrahedron(file: &GltfFile) -> Vec<String> {
    let (character, notes) = read(file);
    let mesh = &character.body.mesh;
    assert_eq!(mesh.positions, TETRAHEDRON.map(Vec3::from));
    assert_eq!(mesh.triangles.len(), 4);
    assert!(mesh.positions.iter().zip(&mesh.normals).all(|(_, n)| n.is_normalized()));
    notes
}

/// There is one note with each of `texts`.
pub(crate) fn assert_noted_once(notes: &[String], texts: &[&str]) {
    for text in texts {
        assert_eq!(notes.iter().filter(|n| n.contains(text)).count(), 1, "{text:?}: {notes:?}");
    }
    assert_eq!(notes.len(), texts.len(), "{notes:?}");
}

/// Adds a skin of the nodes `joints` with these inverse bind matrices.
pub(crate) fn skin(file: &mut GltfFile, joints: &[usize], binds: &[Affine3A]) -> usize {
    let matrices: Vec<f32> = binds.iter().flat_map(|b| glam::Mat4::from(*b).to_cols_array()).collect();
    let matrices = file.floats("MAT4", &matrices);
    file.push("skins", json!({"joints": joints, "inverseBindMatrices": matrices}))
}

/// Adds accessors of joints and weights of four vertices.
pub(crate) fn weights(file: &mut GltfFile, joints: [[u8; 4]; 4], weights: [[f32; 4]; 4]) -> (usize, usize) {
    (file.bytes(5121, "VEC4", 4, joints.as_flattened()), file.floats("VEC4", weights.as_flattened()))
}

/// Adds an animation that turns the node `Head` by 90° in half a second.
pub(crate) fn animate(file: &mut GltfFile) {
    let times = file.floats("SCALAR", &[0.0, 0.5]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let rotations = file.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half]);
    let weights = file.floats("SCALAR", &[0.0, 1.0]);
    let turn = json!({
        "name": "turn",
        "samplers": [{"input": times, "output": rotations}, {"input": times, "output": weights}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]
    });
    file.push("animations", turn);
}
