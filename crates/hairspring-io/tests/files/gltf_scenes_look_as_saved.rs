//! Promise: a glTF file without a motion is read as it was saved: in the pose of its joints, with the skins of the meshes
//! in its scene only, and without hidden objects.

use crate::{
    gltf_checks::{assert_noted_once, read, read_tetrahedron, refused, skin, weights},
    gltf_file::{GltfFile, TETRAHEDRON},
};
use glam::{Affine3A, Quat, Vec3};
use hairspring_io::gltf;
use serde_json::json;

/// A face with a skin of the joints Hips and Head, which follows the head, and is saved with the head turned by `turn`.
fn face(turn: Quat) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    file.json["nodes"] = json!([
        {"name": "Hips", "translation": [0, 1, 0], "children": [1]},
        {"name": "Head", "translation": [0, 0.5, 0], "rotation": turn.to_array()},
        {"name": "Face", "mesh": 0, "skin": 0}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 2]);
    let rest = [1.0, 1.5].map(|y| Affine3A::from_translation(Vec3::Y * y).inverse());
    skin(&mut file, &[0, 1], &rest);
    follow(&mut file, [1; 4]);
    file
}

/// Gives each vertex of the tetrahedron a joint.
fn follow(file: &mut GltfFile, joints: [u8; 4]) {
    let (j, w) = weights(file, joints.map(|j| [j, 0, 0, 0]), [[1.0, 0.0, 0.0, 0.0]; 4]);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
}

/// Where a joint at `y` that is turned by `turn` has a corner that was bound with it at `y`.
fn turned(turn: Quat, corner: [f32; 3], y: f32) -> Vec3 {
    turn * (Vec3::from(corner) - Vec3::Y * y) + Vec3::Y * y
}

#[test]
fn a_file_that_is_saved_in_a_pose_is_in_that_pose() {
    let turn = Quat::from_rotation_x(1.2);
    let (character, notes) = read(&face(turn));
    assert_noted_once(&notes, &["saved in another pose than the bind pose"]);
    let body = character.body;
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&body.world(&body.rest_pose()), &mut positions, &mut normals);
    for (v, corner) in TETRAHEDRON.into_iter().enumerate() {
        let expected = turned(turn, corner, 1.5);
        for p in [body.mesh.positions[v], positions[v]] {
            assert!(p.distance(expected) < 1e-5, "{v}: {p} instead of {expected}");
        }
    }
    let head = body.joint("Head").unwrap();
    assert!(body.joints[head].rest.rotation.abs_diff_eq(turn, 1e-6));
    // The normals turn with the vertices.
    let straight = read(&face(Quat::IDENTITY));
    assert!(straight.1.is_empty(), "{:?}", straight.1);
    for (n, of_bind) in body.mesh.normals.iter().zip(&straight.0.body.mesh.normals) {
        assert!(n.distance(turn * *of_bind) < 1e-5, "{n}");
    }
}

#[test]
fn a_skin_without_bind_matrices_does_not_collapse() {
    let mut file = face(Quat::IDENTITY);
    file.json["skins"] = json!([{"joints": [0, 1]}]);
    follow(&mut file, [0, 0, 1, 1]);
    let positions = read(&file).0.body.mesh.positions;
    for ((p, corner), y) in positions.iter().zip(TETRAHEDRON).zip([1.0, 1.0, 1.5, 1.5]) {
        let expected = Vec3::from(corner) + Vec3::Y * y;
        assert!(p.distance(expected) < 1e-6, "{p} instead of {expected}");
    }
}

#[test]
fn a_skin_without_a_bind_pose_moves_from_the_saved_pose() {
    let turn = Quat::from_rotation_x(0.5);
    for binds in [None, Some([Affine3A::IDENTITY; 2])] {
        let mut file = face(turn);
        file.json["skins"] = json!([]);
        match binds {
            Some(binds) => _ = skin(&mut file, &[0, 1], &binds),
            None => _ = file.push("skins", json!({"joints": [0, 1]})),
        }
        follow(&mut file, [0, 0, 1, 1]);
        animate_hips(&mut file);
        let (character, notes) = read(&file);
        assert_noted_once(
            &notes,
            &["skin 0 has no bind pose, because its inverse bind matrices are missing"],
        );
        let body = character.body;
        let saved: Vec<Vec3> = (0..4)
            .map(|v| {
                let corner = Vec3::from(TETRAHEDRON[v]);
                if v < 2 { corner + Vec3::Y } else { turn * corner + Vec3::Y * 1.5 }
            })
            .collect();
        assert!(hairspring_test::farthest(&body.mesh.positions, &saved) < 1e-6, "{:?}", body.mesh.positions);
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        for time in [0.0, 1.0] {
            body.skinned(&body.world(&character.clips[0].sample(time)), &mut positions, &mut normals);
            let moved: Vec<Vec3> = saved.iter().map(|p| *p + Vec3::Y * time as f32).collect();
            assert!(hairspring_test::farthest(&positions, &moved) < 1e-5, "at {time} s: {positions:?}");
        }
    }
}

/// Adds a motion that lifts the hips from 1 m to 2 m.
fn animate_hips(file: &mut GltfFile) {
    let (times, values) =
        (file.floats("SCALAR", &[0.0, 1.0]), file.floats("VEC3", &[0.0, 1.0, 0.0, 0.0, 2.0, 0.0]));
    let channel = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
    file.push("animations", json!({"samplers": [{"input": times, "output": values}], "channels": [channel]}));
}

#[test]
fn a_motion_moves_the_joints_from_the_bind_pose() {
    let turn = Quat::from_rotation_x(1.2);
    let mut file = face(turn);
    animate_hips(&mut file);
    let (character, notes) = read(&file);
    assert!(notes.is_empty(), "{notes:?}");
    let body = character.body;
    assert!(body.mesh.positions[3].distance(TETRAHEDRON[3].into()) < 1e-6);
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&body.world(&character.clips[0].sample(1.0)), &mut positions, &mut normals);
    let expected = turned(turn, TETRAHEDRON[3], 1.5) + Vec3::Y;
    assert!(positions[3].distance(expected) < 1e-5, "{} instead of {expected}", positions[3]);
}

#[test]
fn only_skins_of_meshes_in_the_scene_matter() {
    // A leftover skin, and one of another scene.
    for used_elsewhere in [false, true] {
        let mut file = GltfFile::tetrahedron();
        file.json["nodes"] =
            json!([{"name": "Head", "mesh": 0}, {"name": "Lost"}, {"name": "Other", "mesh": 0}]);
        skin(&mut file, &[1], &[Affine3A::IDENTITY]);
        if used_elsewhere {
            file.json["nodes"][2]["skin"] = json!(0);
            file.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1, 2]}]);
        }
        assert_noted_once(
            &read_tetrahedron(&file),
            &["1 objects with meshes are not in the file's default scene"],
        );
        file.json["nodes"][0]["skin"] = json!(0);
        let text = refused(&file).text;
        assert!(text.contains("has node 1 as a joint") && text.contains("export the skeleton"), "{text}");
    }
}

#[test]
fn a_bind_matrix_that_cannot_be_inverted_matters_if_a_vertex_uses_it() {
    let mut file = face(Quat::IDENTITY);
    file.json["skins"] = json!([]);
    skin(&mut file, &[0, 1], &[Affine3A::from_scale(Vec3::ZERO), Affine3A::from_translation(Vec3::Y * -1.5)]);
    assert!(read_tetrahedron(&file).is_empty());
    follow(&mut file, [0, 1, 1, 1]);
    let text = refused(&file).text;
    assert!(
        text.contains("the joint \"Hips\" in skin 0 cannot be inverted") && text.contains("bind"),
        "{text}"
    );
}

#[test]
fn hidden_objects_are_left_out_with_their_children() {
    let mut file = GltfFile::tetrahedron();
    let hidden = |visible: bool| json!({"KHR_node_visibility": {"visible": visible}});
    file.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
    file.json["nodes"] = json!([
        {"name": "Head", "mesh": 0, "extensions": hidden(true)},
        {"name": "Hat", "children": [2], "extensions": hidden(false)},
        {"name": "Feather", "mesh": 0, "extensions": hidden(true)}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    assert_noted_once(&read_tetrahedron(&file), &["1 objects with meshes are hidden"]);
    // The same in a groom of lines.
    file.primitive()["mode"] = json!(3);
    let indices = file.bytes(5121, "SCALAR", 3, &[0, 1, 2]);
    file.primitive()["indices"] = json!(indices);
    assert_eq!(gltf::parse_groom(&file.glb(), &|_| None).unwrap().strand_count(), 1);
    file.json["nodes"][0]["extensions"] = hidden(false);
    let text = gltf::parse_groom(&file.glb(), &|_| None).unwrap_err().text;
    assert!(text.starts_with("the file has no lines except in 2 hidden objects"), "{text}");
}
