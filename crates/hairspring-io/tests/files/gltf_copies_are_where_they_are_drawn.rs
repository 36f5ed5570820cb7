//! Promise: the copies that a node of a glTF file draws of its mesh (`EXT_mesh_gpu_instancing`) are all read, where they are drawn.

use crate::{
    gltf_checks::{assert_noted_once, read, refused, skin, weights},
    gltf_file::{GltfFile, TETRAHEDRON},
};
use glam::{Affine3A, Quat, Vec3};
use hairspring_io::gltf;
use serde_json::json;

/// A tetrahedron whose node stands at `at` and draws two copies, and their transforms in the space of the node.
fn copies(at: Vec3) -> (GltfFile, [Affine3A; 2]) {
    let turn = Quat::from_rotation_y(0.7);
    let mut file = GltfFile::tetrahedron();
    let translations = file.floats("VEC3", &[0.0, 1.5, 0.0, 2.0, 0.0, 0.0]);
    let rotations = file.floats("VEC4", [Quat::IDENTITY, turn].map(|q| q.to_array()).as_flattened());
    let scales = file.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, -1.0, 0.5]);
    let attributes = json!({"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales});
    file.json["nodes"][0]["translation"] = json!(at.to_array());
    file.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    file.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let second = Affine3A::from_scale_rotation_translation(Vec3::new(2.0, -1.0, 0.5), turn, Vec3::X * 2.0);
    (file, [Affine3A::from_translation(Vec3::Y * 1.5), second])
}

#[test]
fn copies_of_a_mesh_are_read_and_move_with_their_node() {
    let at = Vec3::new(0.0, 0.2, -0.3);
    let (file, places) = copies(at);
    let (character, notes) = read(&file);
    assert!(notes.is_empty(), "{notes:?}");
    let body = character.body;
    let corners = places.iter().flat_map(|place| TETRAHEDRON.map(|c| at + place.transform_point3(c.into())));
    let corners: Vec<Vec3> = corners.collect();
    assert!(hairspring_test::farthest(&body.mesh.positions, &corners) < 1e-6, "{:?}", body.mesh.positions);
    assert_eq!(body.mesh.triangles.len(), 8);
    // Faces and normals point outward, also those of a mirrored copy.
    for t in &body.mesh.triangles {
        let [a, b, c] = t.map(|v| body.mesh.positions[v as usize]);
        let first = 4 * (t[0] as usize / 4);
        let center = body.mesh.positions[first..first + 4].iter().sum::<Vec3>() / 4.0;
        assert!((b - a).cross(c - a).dot(a - center) > 0.0, "{t:?}");
    }
    let moved =
        body.world(&body.rest_pose()).into_iter().map(|joint| Affine3A::from_translation(Vec3::X) * joint);
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&moved.collect::<Vec<_>>(), &mut positions, &mut normals);
    let expected: Vec<Vec3> = corners.iter().map(|p| *p + Vec3::X).collect();
    assert!(hairspring_test::farthest(&positions, &expected) < 1e-6);
}

#[test]
fn copies_of_lines_are_strands() {
    let (mut file, places) = copies(Vec3::Y);
    file.primitive()["mode"] = json!(3);
    let indices = file.bytes(5121, "SCALAR", 3, &[0, 1, 2]);
    file.primitive()["indices"] = json!(indices);
    let groom = gltf::parse_groom(&file.glb(), &|_| None).unwrap();
    let points = places
        .iter()
        .flat_map(|place| [0, 1, 2].map(|v| Vec3::Y + place.transform_point3(TETRAHEDRON[v].into())));
    assert!(
        hairspring_test::farthest(&groom.points, &points.collect::<Vec<_>>()) < 1e-6,
        "{:?}",
        groom.points
    );
    assert_eq!(groom.strand_count(), 2);
}

#[test]
fn copies_that_cannot_be_placed_are_refused_or_noted() {
    let (mut file, _) = copies(Vec3::ZERO);
    let one = file.floats("VEC3", &[1.0; 3]);
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] = json!(one);
    assert!(
        refused(&file)
            .text
            .starts_with("the copies of node 0 (EXT_mesh_gpu_instancing) have not the same number")
    );
    // A skin moves its mesh, wherever its node is.
    let (mut file, _) = copies(Vec3::ZERO);
    file.push("nodes", json!({"name": "Root"}));
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    file.json["nodes"][0]["skin"] = json!(0);
    skin(&mut file, &[1], &[Affine3A::IDENTITY]);
    let (j, w) = weights(&mut file, [[0; 4]; 4], [[1.0, 0.0, 0.0, 0.0]; 4]);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
    let (character, notes) = read(&file);
    assert_eq!(character.body.mesh.positions, TETRAHEDRON.map(Vec3::from));
    assert_noted_once(&notes, &["1 nodes draw copies of a mesh with a skin"]);
    // Copies of copies are limited, also those without vertices.
    let mut file = GltfFile::tetrahedron();
    let many = file.push("accessors", json!({"componentType": 5126, "count": 400_000, "type": "VEC3"}));
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": many}}});
    file.json["nodes"][0]["extensions"] = instancing;
    assert!(refused(&file).limit, "{}", refused(&file));
    file.json["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {}}); 10_000]);
    assert!(refused(&file).limit, "{}", refused(&file));
}
