//! Promise: a glTF file is read as exporters write it. What is not used is skipped, also if it is required. What is
//! left out is in a note, and what cannot be read is refused with a sentence that names the export option.
//!
//! Every case is made in code, after files that exporters write.

use crate::{
    gltf_checks::{assert_noted_once, read, read_tetrahedron, refused},
    gltf_file::{GltfFile, TETRAHEDRON},
};
use glam::Vec3;
use hairspring_io::{ErrorKind, ReadOptions, gltf, read_body};
use serde_json::json;
use std::{cell::RefCell, fs};

#[test]
fn custom_attributes_are_skipped() {
    let mut file = GltfFile::tetrahedron();
    let custom = file.floats("SCALAR", &[0.0, 1.0, 2.0, 3.0]);
    for name in ["_ROOT_DENSITY", "_0", "TANGENT", "TEXCOORD_7", "COLOR_3", "FROM_THE_FUTURE"] {
        file.primitive()["attributes"][name] = json!(custom);
    }
    assert!(read_tetrahedron(&file).is_empty());
    // Not even a missing accessor matters, since it is not read.
    file.primitive()["attributes"]["_LOST"] = json!(99);
    assert!(read_tetrahedron(&file).is_empty());
}

#[test]
fn textures_and_materials_of_any_extension_are_skipped() {
    for name in [
        "EXT_texture_webp",
        "KHR_texture_basisu",
        "KHR_texture_transform",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_lights_punctual",
        "KHR_mesh_quantization",
        "VRMC_vrm",
        "GOOGLE_texture_basis",
        "NV_materials_mdl",
        "EXT_mesh_features",
        "EXT_structural_metadata",
    ] {
        let mut file = GltfFile::tetrahedron();
        file.json["extensionsUsed"] = json!([name]);
        file.json["extensionsRequired"] = json!([name]);
        file.json["extensions"] = json!({name: {"lights": [{"type": "neon"}]}});
        file.json["images"] = json!([{"uri": "skin.webp"}, {"mimeType": "image/ktx2", "bufferView": 77}]);
        file.json["samplers"] = json!([{"magFilter": 1}]);
        file.json["textures"] = json!([{"sampler": 0, "extensions": {name: {"source": 0}}}, {}]);
        file.json["materials"] = json!([{
            "name": "skin", "alphaMode": "DITHER", "extensions": {name: {}}, "normalTexture": {"index": 9},
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {name: {"scale": [2, 2]}}},
                "baseColorFactor": [0.25, 0.5, 1.0, 1.0]}
        }]);
        file.json["cameras"] = json!([{"type": "fisheye"}]);
        file.primitive()["material"] = json!(0);
        file.primitive()["extensions"] = json!({name: {"mappings": []}});
        assert!(read_tetrahedron(&file).is_empty(), "{name}");
        assert_eq!(read(&file).0.body.mesh.parts[0].color, Vec3::new(0.25, 0.5, 1.0));
    }
    let mut file = GltfFile::tetrahedron();
    file.json["extensionsRequired"] = json!(["ACME_nurbs"]);
    assert!(refused(&file).text.contains("\"ACME_nurbs\""), "{}", refused(&file));
}

#[test]
fn compressed_meshes_are_refused_with_their_export_option() {
    for (name, option) in [
        ("KHR_draco_mesh_compression", "without Draco"),
        ("EXT_meshopt_compression", "without meshopt"),
        ("KHR_meshopt_compression", "without meshopt"),
    ] {
        let mut file = GltfFile::tetrahedron();
        file.json["extensionsRequired"] = json!(["KHR_texture_transform", name]);
        let text = refused(&file).text;
        assert!(text.contains(name) && text.contains(option) && !text.contains('\n'), "{text}");
    }
    // Draco that is used but not required: accessors without bytes.
    let mut file = GltfFile::tetrahedron();
    file.primitive()["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    assert!(read_tetrahedron(&file).is_empty());
    for accessor in file.json["accessors"].as_array_mut().unwrap() {
        accessor.as_object_mut().unwrap().remove("bufferView");
    }
    assert!(refused(&file).text.contains("without Draco"), "{}", refused(&file));
    // Meshopt with the uncompressed copy in the file, and without it.
    let mut file = GltfFile::tetrahedron();
    for view in file.json["bufferViews"].as_array_mut().unwrap() {
        view["extensions"] =
            json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 4, "mode": "TRIANGLES"}});
    }
    assert!(read_tetrahedron(&file).is_empty());
    for view in file.json["bufferViews"].as_array_mut().unwrap() {
        view["buffer"] = json!(1);
    }
    file.json["buffers"] = json!([{"byteLength": file.bin.len()}, {"byteLength": file.bin.len()}]);
    assert!(refused(&file).text.contains("without meshopt"), "{}", refused(&file));
}

#[test]
fn uris_are_percent_decoded_and_each_file_is_read_once() {
    let mut file = GltfFile::tetrahedron();
    for (uri, name) in [
        ("My%20Head.bin", "My Head.bin"),
        ("./My%20Head.bin", "My Head.bin"),
        ("parts/./K%C3%B6pfe.bin", "parts/Köpfe.bin"),
        ("100%.bin", "100%.bin"),
        ("parts/../head.bin", "head.bin"),
        ("parts\\head.bin", "parts/head.bin"),
        ("not%20encoded.bin", "not%20encoded.bin"),
    ] {
        let length = file.bin.len();
        file.json["buffers"] =
            json!([{"uri": uri, "byteLength": length}, {"uri": format!("./{uri}"), "byteLength": 4}]);
        let found = RefCell::new(0);
        let (character, _) = gltf::parse(file.json.to_string().as_bytes(), &|asked| {
            let is_found = asked == name;
            *found.borrow_mut() += usize::from(is_found);
            is_found.then(|| file.bin.clone())
        })
        .unwrap_or_else(|e| panic!("{uri}: {e}"));
        assert_eq!((character.body.mesh.positions.len(), found.into_inner()), (4, 1), "{uri}");
    }
}

#[test]
fn buffers_outside_of_the_folder_are_refused_and_missing_ones_are_not_found() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = GltfFile::tetrahedron();
    fs::write(folder.path().join("secret.bin"), &file.bin).unwrap();
    let path = folder.path().join("inner/head.gltf");
    fs::create_dir_all(folder.path().join("inner/a")).unwrap();
    let secret = format!("file://{}/secret.bin", folder.path().display());
    for (uri, wanted) in [
        ("/etc/passwd", "is an absolute path"),
        ("%2Fetc%2Fpasswd", "is an absolute path"),
        ("c:\\a.bin", "is an absolute path"),
        (&secret, "is an absolute path"),
        ("../secret.bin", "is outside of the folder"),
        ("..\\secret.bin", "is outside of the folder"),
        ("a/%2e%2e/../secret.bin", "is outside of the folder"),
        ("https://example.com/a.bin", "is on a network"),
        ("a", "its buffer \"a\" was not found next to it, or is no file"),
        ("parts/../lost.bin", "lost.bin was not found; "),
    ] {
        file.json["buffers"] = json!([{"uri": uri, "byteLength": file.bin.len()}]);
        fs::write(&path, file.json.to_string()).unwrap();
        let error = read_body(&path, &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().contains(wanted), "{uri}: {error}");
        let is_missing = uri.ends_with("lost.bin");
        assert_eq!(error.kind() == ErrorKind::NotFound, is_missing, "{uri}: {error}");
        if is_missing {
            let lost = path.with_file_name("lost.bin");
            let text = format!("{} was not found; {} names it as a buffer", lost.display(), path.display());
            assert_eq!(error.to_string(), text);
        }
    }
}

#[test]
fn data_uris_are_read_in_every_form() {
    use base64::Engine;
    let mut file = GltfFile::tetrahedron();
    let base64 = base64::engine::general_purpose::STANDARD.encode(&file.bin);
    let encoded = base64.replace('+', "%2B").replace('/', "%2f").replace('=', "%3D");
    let broken: String = base64.as_bytes().chunks(20).map(|l| String::from_utf8_lossy(l) + "\r\n").collect();
    let bytes: String = file.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
    for uri in [
        format!("data:application/octet-stream;base64,{base64}"),
        format!("data:;base64,{}", base64.trim_end_matches('=')),
        format!("DATA:application/gltf-buffer;charset=x;BASE64,{encoded}"),
        format!("data:application/octet-stream;base64,{broken}"),
        format!("data:application/octet-stream,{bytes}"),
    ] {
        file.json["buffers"] = json!([{"uri": uri, "byteLength": file.bin.len()}]);
        let (character, _) =
            gltf::parse(file.json.to_string().as_bytes(), &|_| None).unwrap_or_else(|e| panic!("{uri}: {e}"));
        assert_eq!(character.body.mesh.positions, TETRAHEDRON.map(Vec3::from), "{uri}");
    }
    for uri in ["data:;base64,AAA$SECRET", "data:SECRET"] {
        file.json["buffers"] = json!([{"uri": uri, "byteLength": file.bin.len()}]);
        let text = gltf::parse(file.json.to_string().as_bytes(), &|_| None).unwrap_err().text;
        assert!(text.starts_with("the data URI of buffer 0") && text.contains("export"), "{text}");
        assert!(!text.contains("SECRET"), "{text}");
    }
}

#[test]
fn blank_names_are_as_missing_ones() {
    let mut file = GltfFile::tetrahedron();
    file.json["meshes"][0]["name"] = json!("");
    file.json["nodes"][0]["name"] = json!(" ");
    file.json["materials"] = json!([{"name": ""}]);
    file.primitive()["material"] = json!(0);
    let body = read(&file).0.body;
    assert_eq!((body.mesh.parts[0].name.as_str(), body.joints[0].name.as_str()), ("mesh0", "node0"));
}

#[test]
fn quantized_meshes_are_read() {
    let mut file = GltfFile::tetrahedron();
    let corners: [[i16; 4]; 4] = [[0, 0, 0, 0], [100, 0, 0, 0], [0, 100, 0, 0], [0, 0, 100, 0]];
    let bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let positions = file.bytes(5122, "VEC3", 4, &bytes);
    let view = file.json["accessors"][positions]["bufferView"].as_u64().unwrap() as usize;
    file.json["bufferViews"][view]["byteStride"] = json!(8);
    let normals = file.bytes(5120, "VEC3", 4, &[127, 0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 129, 0, 0, 0]);
    let view = file.json["accessors"][normals]["bufferView"].as_u64().unwrap() as usize;
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    file.json["accessors"][normals]["normalized"] = json!(true);
    file.primitive()["attributes"] = json!({"POSITION": positions, "NORMAL": normals});
    file.json["nodes"][0]["scale"] = json!([0.001, 0.001, 0.001]);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let mesh = read(&file).0.body.mesh;
    for (p, want) in mesh.positions.iter().zip(TETRAHEDRON) {
        assert!(p.distance(want.into()) < 1e-7, "{p}");
    }
    let normals = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X];
    assert!(hairspring_test::farthest(&mesh.normals, &normals) < 1e-6, "{:?}", mesh.normals);
}

#[test]
fn a_scene_without_nodes_gives_all_nodes() {
    let mut file = GltfFile::tetrahedron();
    file.json["scenes"] = json!([{"name": "empty"}]);
    assert_noted_once(&read_tetrahedron(&file), &["lists no objects"]);
    file.json["scenes"] = json!([]);
    file.json.as_object_mut().unwrap().remove("scene");
    assert!(read_tetrahedron(&file).is_empty());
}

#[test]
fn objects_outside_of_the_default_scene_are_noted() {
    let mut file = GltfFile::tetrahedron();
    let nodes = file.json["nodes"].as_array_mut().unwrap();
    let other = nodes.len();
    nodes.push(json!({"mesh": 0}));
    let own: Vec<usize> = (0..other).collect();
    for scenes in [json!([{"nodes": own}, {"nodes": [other]}]), json!([{"nodes": own}])] {
        file.json["scene"] = json!(0);
        file.json["scenes"] = scenes;
        let notes = read_tetrahedron(&file);
        assert_noted_once(&notes, &["1 objects with meshes are not in the file's default scene"]);
    }
}

#[test]
fn strips_and_fans_are_triangles_and_lines_are_noted() {
    let mut file = GltfFile::default();
    // A square in a strip of two triangles, and in a fan.
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];
    let positions = file.floats("VEC3", &square);
    let fan = file.bytes(5121, "SCALAR", 4, &[0, 1, 3, 2]);
    // Degenerate triangles join the two strips.
    let strip = file.bytes(5121, "SCALAR", 9, &[0, 1, 2, 2, 1, 1, 1, 3, 2]);
    let primitive = |mode: u32, indices: Option<usize>| {
        let mut p = json!({"attributes": {"POSITION": positions}, "mode": mode});
        if let Some(indices) = indices {
            p["indices"] = json!(indices);
        }
        p
    };
    let primitives = json!([
        primitive(5, None),
        primitive(6, Some(fan)),
        primitive(5, Some(strip)),
        primitive(0, None),
        primitive(3, None)
    ]);
    file.push("meshes", json!({"primitives": primitives}));
    file.json["nodes"] = json!([{"mesh": 0}]);
    file.json["scenes"][0]["nodes"] = json!([0]);
    let (character, notes) = read(&file);
    let mesh = character.body.mesh;
    assert_eq!(mesh.positions.len(), 4, "primitives share their vertices");
    assert_eq!(mesh.triangles[..4], [[0, 1, 2], [2, 1, 3], [0, 1, 3], [0, 3, 2]]);
    assert_eq!(mesh.parts.len(), 3);
    let upward = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).z
    };
    assert!(mesh.triangles.iter().all(|t| upward(t) == 1.0), "{:?}", mesh.triangles);
    assert_noted_once(&notes, &["2 primitives of lines or points"]);
}

#[test]
fn morph_targets_have_their_default_weights() {
    let mut file = GltfFile::tetrahedron();
    let grown: Vec<f32> = TETRAHEDRON.concat().iter().map(|x| 0.6 * x).collect();
    let (grow, lost) = (file.floats("VEC3", &grown), 99);
    file.primitive()["targets"] = json!([{"POSITION": grow}, {"POSITION": lost}]);
    assert!(read_tetrahedron(&file).is_empty(), "without weights there is no change");
    file.json["meshes"][0]["weights"] = json!([1.0, 0.0]);
    assert!(read(&file).0.body.mesh.positions[1].distance(Vec3::X * 0.16) < 1e-7);
    // A node has weights of its own.
    file.json["nodes"][0]["weights"] = json!([0.5, 0.0]);
    let (character, notes) = read(&file);
    assert!(character.body.mesh.positions[1].distance(Vec3::X * 0.13) < 1e-7 && notes.is_empty());
}

#[test]
fn sparse_accessors_are_read() {
    let mut file = GltfFile::tetrahedron();
    let indices = file.view(&[1, 0, 3, 0]);
    let values = [0.1f32, 0.0, 0.0, 0.0, 0.0, 0.2];
    let values = file.view(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>());
    let sparse = json!({"count": 2, "indices": {"bufferView": indices, "componentType": 5123},
        "values": {"bufferView": values}});
    file.json["accessors"][0]["sparse"] = sparse;
    assert_eq!(read(&file).0.body.mesh.positions[3], Vec3::Z * 0.2);
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let positions = read(&file).0.body.mesh.positions;
    assert_eq!(positions, [Vec3::ZERO, Vec3::X * 0.1, Vec3::ZERO, Vec3::Z * 0.2]);
    file.json["accessors"][0]["count"] = json!(2);
    assert!(refused(&file).text.contains("sparse index"), "{}", refused(&file));
}

#[test]
fn other_versions_are_refused_by_their_number() {
    let old = br#"{"asset":{"version":"1.0"},"scenes":{"main":{"nodes":["a"]}},"nodes":{"a":{}}}"#;
    let problem = gltf::parse(old, &|_| None).unwrap_err();
    assert!(problem.text.contains("version \"1.0\" is not supported"), "{problem}");
}
