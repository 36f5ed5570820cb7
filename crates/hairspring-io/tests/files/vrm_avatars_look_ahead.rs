//! Promise: a VRM file is read as the glTF file that it is, and an avatar of VRM 0.x, which looks along -Z, is turned to
//! look along +Z with its motion and strands.

use crate::{
    gltf_checks::{animate, assert_noted_once, read},
    gltf_file::GltfFile,
};
use glam::Vec3;
use hairspring_io::{ReadOptions, gltf, read_body};
use serde_json::json;
use std::fs;

#[test]
fn a_vrm_is_a_gltf() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Avatar.VRM");
    let mut file = GltfFile::tetrahedron();
    file.json["extensions"] = json!({"VRM": {"specVersion": "0.0", "humanoid": {"humanBones": []}}});
    file.json["extensionsUsed"] = json!(["VRM", "KHR_materials_unlit"]);
    fs::write(&path, file.glb()).unwrap();
    assert_eq!(read_body(&path, &ReadOptions::default()).unwrap().value.body.mesh.triangles.len(), 4);
}

#[test]
fn an_avatar_that_looks_along_minus_z_is_turned() {
    let mut file = GltfFile::tetrahedron();
    animate(&mut file);
    file.json["nodes"][0]["translation"] = json!([0.2, 1.0, 0.3]);
    let posed = |file: &GltfFile, time: f64| {
        let (character, notes) = read(file);
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        let body = &character.body;
        body.skinned(&body.world(&character.clips[0].sample(time)), &mut positions, &mut normals);
        (body.mesh.positions.clone(), positions, notes)
    };
    let turned =
        |positions: Vec<Vec3>| positions.iter().map(|p| Vec3::new(-p.x, p.y, -p.z)).collect::<Vec<_>>();
    let known: Vec<_> = [0.0, 0.3].map(|time| posed(&file, time)).into();
    file.json["extensions"] = json!({"VRMC_vrm": {"specVersion": "1.0"}});
    assert_eq!(posed(&file, 0.3), known[1]);
    file.json["extensions"] = json!({"VRM": {"specVersion": "0.0"}});
    for (time, (rest, moved, _)) in [0.0, 0.3].into_iter().zip(known) {
        let (of_rest, of_moved, notes) = posed(&file, time);
        assert_noted_once(&notes, &["the file is a VRM 0.x avatar, which looks along -Z"]);
        assert!(hairspring_test::farthest(&of_rest, &turned(rest)) < 1e-6);
        assert!(hairspring_test::farthest(&of_moved, &turned(moved)) < 1e-6, "at {time} s");
    }
    file.primitive()["mode"] = json!(3);
    let strand = gltf::parse_groom(&file.glb(), &|_| None).unwrap().points;
    assert!(strand[1].distance(Vec3::new(-0.2, 1.1, -0.3)) < 1e-6, "{}", strand[1]);
}
