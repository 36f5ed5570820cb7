//! Promise: an animation of a glTF file moves the nodes that its channels or pointers name. Channels of anything else
//! are left out with a note. A file with a motion alone needs no mesh.

use crate::{
    gltf_checks::{animate, assert_noted_once, read, read_tetrahedron, refused},
    gltf_file::GltfFile,
};
use glam::Quat;
use hairspring_io::{ReadOptions, read_body, read_motion};
use serde_json::json;
use std::fs;

#[test]
fn animation_channels_without_a_joint_are_left_out_and_noted_once() {
    let mut file = GltfFile::tetrahedron();
    animate(&mut file);
    assert!(read_tetrahedron(&file).is_empty());
    animate(&mut file);
    let pointer = json!({"sampler": 1, "target": {"path": "pointer",
        "extensions": {"KHR_animation_pointer": {"pointer": "/materials/0/alphaCutoff"}}}});
    let nothing = json!({"sampler": 1, "target": {"path": "translation"}});
    let future = json!({"sampler": 1, "target": {"node": 0, "path": "visibility"}});
    let morph = json!({"sampler": 1, "target": {"node": 0, "path": "weights"}});
    for animation in 0..2 {
        let channels = file.json["animations"][animation]["channels"].as_array_mut().unwrap();
        channels.extend([pointer.clone(), nothing.clone(), future.clone(), morph.clone()]);
    }
    file.json["extensionsRequired"] = json!(["KHR_animation_pointer"]);
    let notes = read_tetrahedron(&file);
    assert_noted_once(
        &notes,
        &[
            "6 animation channels are left out",
            "2 animation channels are left out, because they move morph targets",
        ],
    );
    let clips = read(&file).0.clips;
    assert_eq!((clips.len(), clips[0].frame_count()), (2, 31));
    let last = clips[0].sample(0.5)[0].rotation;
    assert!(last.abs_diff_eq(Quat::from_rotation_y(std::f32::consts::FRAC_PI_2), 1e-6), "{last}");
}

#[test]
fn pointers_to_nodes_are_channels() {
    let mut file = GltfFile::tetrahedron();
    animate(&mut file);
    let plain = read(&file).0.clips;
    let target = |pointer: &str| json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}});
    file.json["animations"][0]["channels"][0]["target"] = target("/nodes/0/rotation");
    let (character, notes) = read(&file);
    assert_eq!((character.clips, notes.len()), (plain, 0), "{notes:?}");
    for pointer in ["/nodes/0/name", "/nodes/x/rotation", "/cameras/0/perspective/yfov", ""] {
        file.json["animations"][0]["channels"][0]["target"] = target(pointer);
        assert_noted_once(&read_tetrahedron(&file), &["1 animation channel is left out"]);
    }
    file.json["animations"][0]["channels"][0]["target"] = target("/nodes/9/rotation");
    assert!(refused(&file).text.contains("refers to node 9"), "{}", refused(&file));
}

#[test]
fn a_motion_needs_no_mesh_but_a_body_does() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.glb");
    let mut file = GltfFile::tetrahedron();
    animate(&mut file);
    file.json["meshes"] = json!([]);
    file.json["nodes"] = json!([{"name": "Head"}]);
    fs::write(&path, file.glb()).unwrap();
    let motion = read_motion(&path, None, &ReadOptions::default()).unwrap().value;
    assert_eq!((motion.joints.len(), motion.clip.frame_count()), (1, 31));
    let error = read_body(&path, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("no triangles"), "{error}");
}
