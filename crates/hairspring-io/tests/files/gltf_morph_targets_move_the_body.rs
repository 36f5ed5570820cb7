//! Promise: a motion of a glTF file that animates morph targets moves the vertices of the body, with every interpolation,
//! together with its joints. The scene selects it as any other motion of the body's file.

use crate::{
    gltf_file::{GltfFile, TETRAHEDRON},
    samples::{glb_morph, glb_strands},
};
use glam::{Affine3A, Mat4, Quat, Vec3};
use hairspring_io::{Character, ReadOptions, gltf, read_body, read_motion, read_scene};
use hairspring_scene::stage::Stage;
use serde_json::json;
use std::{fs, path::Path};

/// A tetrahedron with targets that move its vertices 1 and 2 by 1 along Z, and a motion "nod" of their weights.
fn face(interpolation: &str, times: &[f32], weights: &[f32]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let targets: Vec<_> = (1..3)
        .map(|v| {
            let mut by = [[0.0f32; 3]; 4];
            by[v][2] = 1.0;
            let position = file.floats("VEC3", &by.concat());
            json!({"POSITION": position})
        })
        .collect();
    file.primitive()["targets"] = json!(targets);
    let (input, output) = (file.floats("SCALAR", times), file.floats("SCALAR", weights));
    file.push(
        "animations",
        json!({"name": "nod",
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}),
    );
    file
}

fn read(file: &GltfFile) -> Character {
    let (character, notes) = gltf::parse(&file.glb(), &|_| None).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    character
}

/// What the two targets add in frame `frame` of the first motion.
fn added(character: &Character, frame: usize) -> [f32; 2] {
    let cache = character.morphed(0).unwrap().unwrap();
    assert_eq!(cache.rate, 60.0);
    [1, 2].map(|v| cache.frames[frame][v].z)
}

fn near(a: [f32; 2], b: [f32; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5)
}

#[test]
fn weights_follow_the_interpolation_of_the_file() {
    let linear = read(&face("LINEAR", &[0.0, 1.0], &[0.0, 1.0, 1.0, 0.0]));
    assert_eq!((linear.clips[0].name.as_str(), linear.clips[0].frame_count()), ("nod", 61));
    for (frame, expected) in [(0, [0.0, 1.0]), (15, [0.25, 0.75]), (60, [1.0, 0.0])] {
        assert!(near(added(&linear, frame), expected), "{frame}: {:?}", added(&linear, frame));
    }
    let step = read(&face("STEP", &[0.0, 0.5, 1.0], &[0.0, 1.0, 0.5, 2.0, 1.0, 0.0]));
    for (frame, expected) in [(29, [0.0, 1.0]), (30, [0.5, 2.0]), (59, [0.5, 2.0]), (60, [1.0, 0.0])] {
        assert!(near(added(&step, frame), expected), "{frame}: {:?}", added(&step, frame));
    }
    // For each key the in-tangents, the values and the out-tangents. At a quarter of two seconds, the Hermite factors are
    // 0.84375, 0.140625, 0.15625 and -0.046875, those of tangents times 2 s.
    let keys = [[9.0, 9.0, 1.0, 0.0, 0.5, 0.0], [0.0, 2.0, 0.0, 1.0, 9.0, 9.0]];
    let cubic = read(&face("CUBICSPLINE", &[0.0, 2.0], &keys.concat()));
    let expected = [0.84375 + 2.0 * 0.140625 * 0.5, 0.15625 - 2.0 * 0.046875 * 2.0];
    assert!(near(added(&cubic, 30), expected), "{:?}", added(&cubic, 30));
}

#[test]
fn default_weights_are_the_rest_pose_and_sparse_targets_are_read() {
    let (character, notes) = gltf::parse(&glb_morph(), &|_| None).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(character.body.mesh.positions[0], Vec3::Z * 0.25);
    let cache = character.morphed(0).unwrap().unwrap();
    assert_eq!(cache.frames.len(), 31);
    // Weights 0 and 0 at first, 0 and 0.5 at last; the second target moves vertices 1 and 2.
    assert_eq!(cache.frames[0], [Vec3::ZERO, Vec3::X, Vec3::Y]);
    let last = &cache.frames[30];
    assert!(last[0].length() < 1e-6 && last[1].distance(Vec3::new(1.0, 0.25, 0.0)) < 1e-6, "{last:?}");
    assert!(last[2].distance(Vec3::new(0.0, 1.25, 0.05)) < 1e-6, "{last:?}");
}

#[test]
fn joints_and_targets_move_the_body_together() {
    // The node grows to twice its size and moves, while its targets open.
    let mut file = face("LINEAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.5]);
    let times = file.floats("SCALAR", &[0.0, 1.0]);
    let (sizes, places) = (
        file.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]),
        file.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 3.0, 0.0]),
    );
    let animation = &mut file.json["animations"][0];
    for (k, (output, path)) in [(sizes, "scale"), (places, "translation")].into_iter().enumerate() {
        animation["samplers"].as_array_mut().unwrap().push(json!({"input": times, "output": output}));
        let channel = json!({"sampler": k + 1, "target": {"node": 0, "path": path}});
        animation["channels"].as_array_mut().unwrap().push(channel);
    }
    let last = read(&file).morphed(0).unwrap().unwrap().frames.pop().unwrap();
    assert!(last[1].distance(Vec3::new(0.2, 3.0, 2.0)) < 1e-5, "{last:?}");
    assert!(last[2].distance(Vec3::new(0.0, 3.2, 1.0)) < 1e-5, "{last:?}");
}

#[test]
fn a_skin_moves_the_morphed_mesh() {
    // Two skins of one joint with different bind poses: the mesh of the second is moved to the first one.
    let mut file = face("LINEAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.0]);
    let turn = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
    for bind in [Affine3A::IDENTITY, turn] {
        let matrix = file.floats("MAT4", &Mat4::from(bind).to_cols_array());
        file.push("skins", json!({"joints": [1], "inverseBindMatrices": matrix}));
    }
    let joints = file.bytes(5121, "VEC4", 4, &[0; 16]);
    let weights = file.floats("VEC4", &[[1.0, 0.0, 0.0, 0.0]; 4].concat());
    let attributes = file.primitive()["attributes"].as_object_mut().unwrap();
    attributes.extend([("JOINTS_0".into(), json!(joints)), ("WEIGHTS_0".into(), json!(weights))]);
    file.json["nodes"] =
        json!([{"name": "Head", "mesh": 0, "skin": 1}, {"name": "Neck"}, {"mesh": 0, "skin": 0}]);
    file.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let (input, output) = (file.floats("SCALAR", &[0.0, 1.0]), {
        let end = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
        file.floats("VEC4", &[Quat::IDENTITY.to_array(), end.to_array()].concat())
    });
    let animation = &mut file.json["animations"][0];
    animation["samplers"].as_array_mut().unwrap().push(json!({"input": input, "output": output}));
    let channel = json!({"sampler": 1, "target": {"node": 1, "path": "rotation"}});
    animation["channels"].as_array_mut().unwrap().push(channel);
    let (character, _) = gltf::parse(&file.glb(), &|_| None).unwrap();
    let last = character.morphed(0).unwrap().unwrap().frames.pop().unwrap();
    // By the file: joint × inverse bind × (vertex + target).
    let joint = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    for (v, corner) in TETRAHEDRON.into_iter().map(Vec3::from).enumerate() {
        let morphed = if v == 1 { corner + Vec3::Z } else { corner };
        let expected = joint * turn.transform_point3(morphed);
        assert!(last[v].distance(expected) < 1e-5, "{v}: {} instead of {expected}", last[v]);
        // The second node has no animated weights.
        assert!(last[4 + v].distance(joint * corner) < 1e-5, "{v}: {}", last[4 + v]);
    }
}

/// Writes a scene with hair on the body `face.glb`, and returns its path.
fn scene(folder: &Path, rest: &str) -> std::path::PathBuf {
    let path = folder.join("a.toml");
    let hair = "[[groom]]\nguides = \"all\"\n[groom.grow]\nstrands = 20\nlength = 0.05\n";
    fs::write(&path, format!("{hair}[body]\nfile = \"face.glb\"\n{rest}")).unwrap();
    path
}

#[test]
fn the_clip_of_a_scene_moves_the_targets() {
    let folder = tempfile::tempdir().unwrap();
    let file = face("LINEAR", &[0.0, 1.0], &[0.0, 0.0, 0.1, 0.0]);
    fs::write(folder.path().join("face.glb"), file.glb()).unwrap();
    // Without a [clip], a body is at rest.
    let still = read_scene(&scene(folder.path(), "")).unwrap().value;
    assert!(still.vertex_cache.is_none() && still.body.unwrap().skin.is_some());
    let loaded = read_scene(&scene(folder.path(), "[clip]\nname = \"nod\"\nstart = 12\n")).unwrap();
    let note = "the motion \"nod\" moves morph targets, so 49 frames at 60 Hz move the body's vertices";
    assert!(loaded.notes.iter().any(|n| n.contains(note)), "{:?}", loaded.notes);
    let scene = loaded.value;
    assert!(scene.clip.is_none() && scene.body.as_ref().unwrap().skin.is_none());
    assert_eq!(scene.motion_duration(), Some(0.8));
    let cache = scene.vertex_cache.as_ref().unwrap();
    assert!((cache.frames[0][1].z - 0.02).abs() < 1e-6, "{:?}", cache.frames[0]);
    let mut stage = Stage::new(scene).unwrap();
    for _ in 0..24 {
        stage.step(1.0 / 24.0);
    }
    let z = stage.body().unwrap().positions[1].z;
    assert!((z - 0.1).abs() < 1e-4, "{z}");
}

#[test]
fn units_and_parts_hold_for_the_targets() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = face("LINEAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.0]);
    // A first mesh that the scene leaves out.
    let positions = file.floats("VEC3", &TETRAHEDRON.concat());
    file.push("meshes", json!({"name": "hat", "primitives": [{"attributes": {"POSITION": positions}}]}));
    let nodes = &mut file.json["nodes"];
    *nodes = json!([{"name": "Hat", "mesh": 1}, nodes[0]]);
    file.json["scenes"][0]["nodes"] = json!([0, 1]);
    file.json["animations"][0]["channels"][0]["target"]["node"] = json!(1);
    fs::write(folder.path().join("face.glb"), file.glb()).unwrap();
    let rest = "parts = [\"tetra\"]\nscale = 0.5\nup = \"z\"\n[clip]\n";
    let cache = read_scene(&scene(folder.path(), rest)).unwrap().value.vertex_cache.unwrap();
    let last = cache.frames.last().unwrap();
    assert_eq!(last.len(), 4);
    assert!(last[1].distance(Vec3::new(0.05, 0.5, 0.0)) < 1e-5, "{last:?}");
}

#[test]
fn targets_of_other_files_are_left_out_with_a_note() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("face.glb");
    fs::write(&path, face("LINEAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.0]).glb()).unwrap();
    let notes = read_motion(&path, Some("nod"), &ReadOptions::default()).unwrap().notes;
    assert!(notes.iter().any(|n| n.contains("move only the body of their own file")), "{notes:?}");
    let more = "[[body.more]]\nfile = \"face.glb\"\n";
    let notes = read_scene(&scene(folder.path(), more)).unwrap().notes;
    assert!(
        notes.iter().any(|n| n.contains("targets are left out; name the file as that of [body]")),
        "{notes:?}"
    );
}

#[test]
fn wrong_weights_and_motions_that_are_too_long_are_one_sentence() {
    let error = |file: &GltfFile| gltf::parse(&file.glb(), &|_| None).unwrap_err().text;
    let text = error(&face("LINEAR", &[0.0, 1.0], &[0.0, 1.0, 1.0]));
    let wanted = "animation \"nod\" has 2 keys but 3 weights of 2 morph targets: expected 2 per key";
    assert!(text.starts_with(wanted), "{text}");
    let text = error(&face("CUBICSPLINE", &[0.0, 1.0], &[0.0; 4]));
    assert!(text.contains("2 keys but 4 weights of 2 morph targets of a CUBICSPLINE: expected 6"), "{text}");
    assert!(error(&face("LINEAR", &[0.0, f32::NAN], &[0.0; 4])).contains("not finite"));
    assert!(error(&face("LINEAR", &[1.0, 0.0], &[0.0; 4])).contains("not in order of time"));
    let mut short = face("LINEAR", &[0.0, 1.0], &[0.0; 4]);
    short.json["accessors"][2]["count"] = json!(3);
    assert!(
        error(&short)
            .contains("morph target 0 of mesh \"tetra\", primitive 0 has 3 positions for 4 vertices")
    );

    let mut long = face("LINEAR", &[0.0, 19_000.0], &[0.0; 4]);
    let many: Vec<f32> = (0..600).map(|k| k as f32 / 600.0).collect();
    let many = long.floats("VEC3", &many);
    long.primitive()["attributes"]["POSITION"] = json!(many);
    long.primitive()["targets"] = json!([{"POSITION": many}, {"POSITION": many}]);
    let text = read(&long).morphed(0).unwrap_err();
    assert!(text.contains("has 1140001 frames of 200 vertices") && text.contains("shorten it"), "{text}");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("face.glb"), long.glb()).unwrap();
    let scene = folder.path().join("a.toml");
    fs::write(folder.path().join("hair.glb"), glb_strands()).unwrap();
    fs::write(
        &scene,
        "[[groom]]\nfile = \"hair.glb\"\n[body]\nfile = \"face.glb\"\n[clip]\nname = \"nod\"\n",
    )
    .unwrap();
    let text = read_scene(&scene).unwrap_err().to_string();
    assert!(text.contains("a.toml, line 6: in the body's file the motion \"nod\" has"), "{text}");
    assert!(read_body(&folder.path().join("face.glb"), &ReadOptions::default()).is_ok());
}
