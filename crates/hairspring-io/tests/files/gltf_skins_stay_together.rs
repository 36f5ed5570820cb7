//! Promise: meshes of several skins of a glTF file stay together (0.01 mm), also if their joints have been bound in
//! different poses. Vertices without joints move with their node.

use crate::{
    gltf_checks::{animate, assert_noted_once, read, read_tetrahedron, refused, skin, weights},
    gltf_file::{GltfFile, TETRAHEDRON},
};
use glam::{Affine3A, Quat, Vec3};
use serde_json::json;

#[test]
fn unused_joint_slots_may_hold_any_number() {
    let mut file = GltfFile::tetrahedron();
    skin(&mut file, &[0], &[Affine3A::IDENTITY]);
    file.json["nodes"][0]["skin"] = json!(0);
    let one = [1.0, 0.0, 0.0, 0.0];
    let (j, w) = weights(&mut file, [[0, 255, 255, 255]; 4], [one, one, one, [0.0; 4]]);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
    assert_noted_once(&read_tetrahedron(&file), &["1 vertices of skinned meshes have no weight"]);
    assert_eq!(read(&file).0.body.skin.unwrap().weights, [one; 4]);
    let (j, _) = weights(&mut file, [[255, 0, 0, 0]; 4], [one; 4]);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    assert!(refused(&file).text.contains("joint 255 of a skin of 1"), "{}", refused(&file));
}

#[test]
fn a_primitive_without_joints_in_a_skinned_mesh_moves_with_its_node() {
    let mut file = GltfFile::tetrahedron();
    file.json["nodes"] = json!([{"name": "Hips", "children": [1]},
        {"name": "Body", "translation": [0, 1, 0], "mesh": 0, "skin": 0}]);
    skin(&mut file, &[0], &[Affine3A::IDENTITY]);
    let (character, notes) = read(&file);
    assert_noted_once(&notes, &["1 primitives of a skinned mesh have no joints"]);
    let body = character.body;
    let node = body.joint("Body").unwrap();
    assert!(body.skin.as_ref().unwrap().joints.iter().all(|j| usize::from(j[0]) == node));
    assert_eq!(body.mesh.positions[1], Vec3::new(0.1, 1.0, 0.0));
}

/// A body and a face with skins of their own, in which the joints Spine and Head have been bound in different poses,
/// by the transforms `posed` on top of the rest pose of the first.
fn two_skins(posed: [Affine3A; 2]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let turn = Quat::from_rotation_z(0.7);
    file.json["nodes"] = json!([
        {"name": "Hips", "translation": [0, 1, 0], "children": [1]},
        {"name": "Spine", "translation": [0, 0.3, 0], "rotation": turn.to_array(), "children": [2]},
        {"name": "Head", "translation": [0, 0.25, 0], "rotation": turn.to_array()},
        {"name": "Body", "mesh": 0, "skin": 0}, {"name": "Face", "mesh": 1, "skin": 1}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 3, 4]);
    let rest = [1.0, 1.3, 1.55].map(|y| Affine3A::from_translation(Vec3::Y * y));
    skin(&mut file, &[0, 1, 2], &rest.map(|r| r.inverse()));
    let [spine, head] = posed;
    skin(&mut file, &[1, 2], &[(spine * rest[1]).inverse(), (head * rest[2]).inverse()]);
    let one = [1.0, 0.0, 0.0, 0.0];
    let at = |p: Vec3| TETRAHEDRON.map(|t| p + Vec3::from(t));
    let body = at(Vec3::Y * 1.6);
    let face = body.map(|p| head.transform_point3(p));
    for (corners, joint) in [(body, 2), (face, 1)] {
        let positions = file.floats("VEC3", corners.map(|p| p.to_array()).as_flattened());
        let (j, w) = weights(&mut file, [[joint, 0, 0, 0]; 4], [one; 4]);
        let primitive =
            json!({"attributes": {"POSITION": positions, "JOINTS_0": j, "WEIGHTS_0": w}, "indices": 1});
        file.push("meshes", json!({"primitives": [primitive]}));
    }
    file.json["nodes"][3]["mesh"] = json!(1);
    file.json["nodes"][4]["mesh"] = json!(2);
    animate(&mut file);
    file
}

#[test]
fn meshes_of_several_skins_stay_together() {
    let none = Affine3A::IDENTITY;
    let bent = Affine3A::from_rotation_translation(Quat::from_rotation_x(0.5), Vec3::new(0.1, -0.2, 0.3));
    let turned = Affine3A::from_rotation_translation(Quat::from_rotation_z(-0.8), Vec3::new(0.4, 0.1, 0.0));
    for (posed, notes_wanted) in
        [([none, none], 0), ([bent, bent], 0), ([bent, turned], 1), ([none, turned], 1)]
    {
        let (character, notes) = read(&two_skins(posed));
        assert_eq!(notes.len(), notes_wanted, "{notes:?}");
        let body = &character.body;
        let apart =
            |positions: &[Vec3]| (0..4).map(|v| positions[v].distance(positions[v + 4])).fold(0.0, f32::max);
        assert!(apart(&body.mesh.positions) < 1e-5, "at rest: {}", apart(&body.mesh.positions));
        assert!(
            body.mesh.positions[0].distance(Vec3::Y * 1.6) < 1e-5,
            "the rest pose is that of the first skin"
        );
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        for time in [0.0, 0.2, 0.5] {
            body.skinned(&body.world(&character.clips[0].sample(time)), &mut positions, &mut normals);
            assert!(apart(&positions) < 1e-5, "at {time} s: {}", apart(&positions));
        }
    }
}

#[test]
fn a_skin_below_the_joints_of_another_is_placed_at_them() {
    // The face has a skin of the head alone, and that of the body does not bind the head.
    let mut file = two_skins([Affine3A::IDENTITY; 2]);
    let rest = [1.0, 1.3, 1.55].map(|y| Affine3A::from_translation(Vec3::Y * y).inverse());
    file.json["skins"] = json!([]);
    skin(&mut file, &[2], &rest[2..]);
    skin(&mut file, &[0, 1, 1], &[rest[0], rest[1], rest[1]]);
    file.json["nodes"][3]["skin"] = json!(1);
    file.json["nodes"][4]["skin"] = json!(0);
    let joints = file.bytes(5121, "VEC4", 4, &[0; 16]);
    file.json["meshes"][2]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    let (character, notes) = read(&file);
    let body = &character.body;
    let spine = body.joint("Spine").unwrap();
    // The head keeps its own rotation below a spine that stands upright in the rest pose of the body.
    let head = body.world(&body.rest_pose())[spine + 1].translation;
    assert!(Vec3::from(head).distance(Vec3::Y * 1.55) < 1e-5, "{head} {notes:?}");
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&body.world(&body.rest_pose()), &mut positions, &mut normals);
    assert!(hairspring_test::farthest(&positions, &body.mesh.positions) < 1e-5);
}
