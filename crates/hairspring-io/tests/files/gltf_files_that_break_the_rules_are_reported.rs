//! Promise: a glTF file that violates the specification is refused, or read with a note, in a sentence that names the
//! object and the remedy.

use crate::{
    gltf_checks::{assert_noted_once, read, read_tetrahedron, refused, skin, weights},
    gltf_file::{GltfFile, TETRAHEDRON},
};
use glam::{Affine3A, Quat, Vec3};
use hairspring_io::gltf;
use serde_json::json;

#[test]
fn a_version_that_the_file_needs_is_refused_above_2_0() {
    let mut file = GltfFile::tetrahedron();
    for version in ["1.0", "2.0"] {
        file.json["asset"]["minVersion"] = json!(version);
        assert!(read_tetrahedron(&file).is_empty());
    }
    file.json["asset"] = json!({"version": "2.1", "minVersion": "2.1"});
    assert!(refused(&file).text.contains("glTF \"2.1\" (asset.minVersion)"), "{}", refused(&file));
}

#[test]
fn a_default_scene_that_does_not_exist_is_refused() {
    let mut file = GltfFile::tetrahedron();
    file.json["scene"] = json!(3);
    assert!(
        refused(&file).text.contains("the default scene is 3, but the file has 1 scenes"),
        "{}",
        refused(&file)
    );
}

#[test]
fn a_buffer_without_bytes_is_named() {
    let mut file = GltfFile::tetrahedron();
    file.json["buffers"] = json!([{"byteLength": file.bin.len()}]);
    let text = gltf::parse(file.json.to_string().as_bytes(), &|_| None).unwrap_err().text;
    assert!(
        text.starts_with("buffer 0 has no `uri`, so its bytes are missing: the file is the JSON of a .glb"),
        "{text}"
    );
    // In a .glb, the first buffer is the binary chunk.
    assert!(read_tetrahedron(&file).is_empty());
}

#[test]
fn a_matrix_with_shear_is_refused_and_another_is_read() {
    let mut file = GltfFile::tetrahedron();
    let turned = Affine3A::from_scale_rotation_translation(
        Vec3::new(2.0, 0.5, -1.0),
        Quat::from_rotation_y(0.7) * Quat::from_rotation_x(1.1),
        Vec3::new(3.0, -2.0, 1.0),
    );
    file.json["nodes"][0]["matrix"] = json!(glam::Mat4::from(turned).to_cols_array());
    let positions = read(&file).0.body.mesh.positions;
    for (p, corner) in positions.iter().zip(TETRAHEDRON) {
        assert!(p.distance(turned.transform_point3(corner.into())) < 1e-5, "{p}");
    }
    let mut sheared = glam::Mat4::IDENTITY.to_cols_array();
    sheared[4] = 0.5;
    file.json["nodes"][0]["matrix"] = json!(sheared);
    assert!(refused(&file).text.contains("the matrix of node 0 has shear"), "{}", refused(&file));
}

#[test]
fn a_matrix_without_size_and_a_rotation_of_zero_are_named() {
    let mut file = GltfFile::tetrahedron();
    let mut flat = glam::Mat4::IDENTITY.to_cols_array();
    flat[5] = 0.0;
    file.json["nodes"][0]["matrix"] = json!(flat);
    let text = refused(&file).text;
    assert!(
        text.contains("the matrix of node 0 has a scale of 0 along y") && text.contains("above 0"),
        "{text}"
    );
    file.json["nodes"][0] = json!({"mesh": 0, "rotation": [0, 0, 0, 0]});
    assert!(refused(&file).text.contains("the rotation of node 0 is 0, 0, 0, 0"), "{}", refused(&file));
}

#[test]
fn what_is_scaled_to_nothing_is_noted_and_carries_hair_rigidly() {
    for (scale, skinned) in
        [([1.0, 0.0, 1.0], false), ([0.0; 3], false), ([0.0; 3], true), ([1.0, 1.0, 0.0], true)]
    {
        let mut file = GltfFile::tetrahedron();
        file.json["nodes"][0]["scale"] = json!(scale);
        let mut texts = vec!["the joint \"Head\" has a scale of 0"];
        if skinned {
            file.json["nodes"] = json!([
                {"name": "Head", "translation": [0, 1, 0], "scale": scale},
                {"mesh": 0, "skin": 0},
                {"name": "Neck", "translation": [0, -1, 0], "children": [0]}
            ]);
            file.json["scenes"][0]["nodes"] = json!([1, 2]);
            skin(&mut file, &[2, 0], &[Affine3A::from_translation(Vec3::Y), Affine3A::IDENTITY]);
            let (j, w) = weights(&mut file, [[1, 0, 0, 0]; 4], [[1.0, 0.0, 0.0, 0.0]; 4]);
            file.primitive()["attributes"]["JOINTS_0"] = json!(j);
            file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
            texts.push("saved in another pose");
        }
        let (character, notes) = read(&file);
        assert_noted_once(&notes, &texts);
        // The vertices are as saved, and the joint has a size.
        let body = character.body;
        let world = body.world(&body.rest_pose());
        let (mut positions, mut normals) = (Vec::new(), Vec::new());
        body.skinned(&world, &mut positions, &mut normals);
        for (p, corner) in positions.iter().zip(TETRAHEDRON) {
            let saved = Vec3::from(corner) * Vec3::from(scale);
            assert!(p.distance(saved) < 1e-6, "{scale:?}: {p} instead of {saved}");
        }
        let head = world[body.joint("Head").unwrap()];
        assert!(head.abs_diff_eq(Affine3A::IDENTITY, 1e-6), "{scale:?}: {head:?}");
    }
}

#[test]
fn a_wrong_stride_is_named() {
    for (stride, wrong) in [(8, true), (13, true), (12, false)] {
        let mut file = GltfFile::tetrahedron();
        file.json["bufferViews"][0]["byteStride"] = json!(stride);
        if wrong {
            let text = refused(&file).text;
            assert!(
                text.contains(&format!("byteStride of {stride}, which must be a multiple of 4")),
                "{text}"
            );
            assert!(text.contains("at least the 12 bytes") && !text.contains("cut short"), "{text}");
        } else {
            assert!(read_tetrahedron(&file).is_empty());
        }
    }
}

#[test]
fn weights_that_are_no_weights_count_as_0_and_are_noted() {
    let mut file = GltfFile::tetrahedron();
    skin(&mut file, &[0], &[Affine3A::IDENTITY]);
    file.json["nodes"][0]["skin"] = json!(0);
    let one = [1.0, 0.0, 0.0, 0.0];
    let wrong = [[1.0, -0.5, 0.0, 0.0], [1.0, f32::NAN, 0.0, 0.0], one, one];
    let (j, w) = weights(&mut file, [[0; 4]; 4], wrong);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
    assert_noted_once(
        &read_tetrahedron(&file),
        &["2 vertices of skinned meshes have weights that are below 0"],
    );
    assert_eq!(read(&file).0.body.skin.unwrap().weights, [one; 4]);
}

#[test]
fn weights_that_do_not_sum_to_1_are_noted_unless_they_are_rounded() {
    let noted = |weight: f32| {
        let mut file = GltfFile::tetrahedron();
        skin(&mut file, &[0], &[Affine3A::IDENTITY]);
        file.json["nodes"][0]["skin"] = json!(0);
        let (j, w) = weights(&mut file, [[0; 4]; 4], [[weight, 0.0, 0.0, 0.0]; 4]);
        file.primitive()["attributes"]["JOINTS_0"] = json!(j);
        file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
        let notes = read_tetrahedron(&file);
        if !notes.is_empty() {
            assert_noted_once(&notes, &["4 vertices of skinned meshes have weights that do not sum to 1"]);
        }
        !notes.is_empty()
    };
    assert_eq!([2.0, 0.5, 1.0, 0.98, 1.02].map(noted), [true, true, false, false, false]);
}

#[test]
fn a_primitive_without_positions_is_noted() {
    let mut file = GltfFile::tetrahedron();
    let primitives = file.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({"attributes": {"NORMAL": 0}}));
    assert_noted_once(&read_tetrahedron(&file), &["1 primitives have no positions (POSITION)"]);
}

#[test]
fn errors_of_a_mesh_name_it_and_its_primitive() {
    let start = |file: &GltfFile, wanted: &str| {
        let text = refused(file).text;
        assert!(text.starts_with(&format!("mesh \"tetra\", primitive 0: {wanted}")), "{text}");
    };
    let mut file = GltfFile::tetrahedron();
    file.bin[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
    start(&file, "the position of vertex 1 is not finite");
    let mut file = GltfFile::tetrahedron();
    let indices = file.bytes(5121, "SCALAR", 3, &[0, 1, 9]);
    file.primitive()["indices"] = json!(indices);
    start(&file, "a triangle names vertex 9 of 4");
    let mut file = GltfFile::tetrahedron();
    let normals = file.floats("VEC3", &[0.0; 6]);
    file.primitive()["attributes"]["NORMAL"] = json!(normals);
    start(&file, "it has 4 positions but 2 normals");
    let mut file = GltfFile::tetrahedron();
    file.primitive()["material"] = json!(7);
    start(&file, "it names material 7");
    let mut file = GltfFile::tetrahedron();
    skin(&mut file, &[0], &[Affine3A::IDENTITY]);
    file.json["nodes"][0]["skin"] = json!(0);
    let (j, w) = weights(&mut file, [[0; 4], [77, 0, 0, 0], [0; 4], [0; 4]], [[1.0, 0.0, 0.0, 0.0]; 4]);
    file.primitive()["attributes"]["JOINTS_0"] = json!(j);
    file.primitive()["attributes"]["WEIGHTS_0"] = json!(w);
    start(&file, "vertex 1 names joint 77 of a skin of 1");
}
