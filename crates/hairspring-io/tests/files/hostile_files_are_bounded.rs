//! Promise: a file cannot make a reader wait, work without bound, or write to the terminal. Only regular files are
//! read, a glTF's buffers once each; the cost of animations and hulls is linear in the file; names are shown without
//! control characters.

use crate::gltf_file::GltfFile;
use hairspring_io::{
    ErrorKind, ReadOptions, Result, gltf, read_body, read_bones, read_groom, read_motion, read_scene,
};
use serde_json::json;
use std::{
    cell::Cell,
    fs,
    path::Path,
    time::{Duration, Instant},
};

/// Time that a test may take, many times what it takes without optimization on a busy machine.
const ENOUGH: Duration = Duration::from_secs(60);

type ReadFile = fn(&Path) -> Result<()>;

/// A reader for each extension.
fn readers() -> Vec<(&'static str, ReadFile)> {
    let groom: ReadFile = |path| read_groom(path, &ReadOptions::default()).map(drop);
    let body: ReadFile = |path| read_body(path, &ReadOptions::default()).map(drop);
    vec![
        ("hair", groom),
        ("tfx", groom),
        ("data", groom),
        ("obj", groom),
        ("csv", groom),
        ("ply", groom),
        ("glb", groom),
        ("obj", body),
        ("tfxmesh", body),
        ("glb", body),
        ("gltf", body),
        ("vrm", body),
        ("bvh", |path| read_motion(path, None, &ReadOptions::default()).map(drop)),
        ("tfxbone", |path| read_bones(path).map(drop)),
        ("toml", |path| read_scene(path).map(drop)),
    ]
}

#[cfg(unix)]
fn make_pipe(path: &Path) {
    assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let folder = tempfile::tempdir().unwrap();
    for (extension, read) in readers() {
        let path = |name: &str| folder.path().join(name).with_extension(extension);
        let _ = [path("pipe"), path("zero"), path("folder")]
            .map(|old| fs::remove_file(&old).or(fs::remove_dir(&old)));
        make_pipe(&path("pipe"));
        std::os::unix::fs::symlink("/dev/zero", path("zero")).unwrap();
        fs::create_dir(path("folder")).unwrap();
        for (name, why) in [("pipe", "a pipe"), ("zero", "a device"), ("folder", "a folder")] {
            let error = read(&path(name)).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Unreadable, "{error}");
            assert!(error.to_string().contains(why) && !error.to_string().contains('\n'), "{error}");
        }
    }
    // A file next to a glTF, and a file of a scene.
    let path = folder.path().join("pipe.gltf");
    fs::remove_file(&path).unwrap();
    make_pipe(&folder.path().join("pipe.bin"));
    fs::write(&path, r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"pipe.bin","byteLength":4}]}"#).unwrap();
    let error = read_body(&path, &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("no file that can be read"), "{error}");
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, "[[groom]]\nfile = \"pipe.hair\"\n").unwrap();
    let error = read_scene(&scene).unwrap_err();
    assert!(error.to_string().contains("a pipe"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_without_a_size_is_read_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("maps.obj");
    std::os::unix::fs::symlink("/proc/self/maps", &path).unwrap();
    assert_eq!(fs::metadata(&path).unwrap().len(), 0);
    let error = read_body(&path, &ReadOptions::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Malformed, "{error}");
}

#[test]
fn a_buffer_that_is_named_many_times_is_read_once() {
    let file = GltfFile::tetrahedron();
    let mut json = file.json.clone();
    let buffer = |uri: String| json!({"uri": uri, "byteLength": 4});
    let mut buffers = vec![json!({"uri": "self.gltf", "byteLength": file.bin.len()})];
    buffers.extend(
        (0..16_000)
            .map(|i| buffer(["self.gltf", "./self.gltf", "%73elf.gltf", ".//self.gltf"][i % 4].into())),
    );
    json["buffers"] = json!(buffers);
    let reads = Cell::new(0);
    gltf::parse(json.to_string().as_bytes(), &|_| {
        reads.set(reads.get() + 1);
        Some(file.bin.clone())
    })
    .unwrap();
    assert_eq!(reads.get(), 1);
}

/// A glTF whose animation lasts `seconds`, and has `channels` channels of one joint.
fn animated(seconds: f32, channels: usize) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let times = file.floats("SCALAR", &[0.0, seconds]);
    let values = file.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let channel = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
    let channels = vec![channel; channels];
    file.push("animations", json!({"samplers": [{"input": times, "output": values}], "channels": channels}));
    file
}

#[test]
fn the_cost_of_an_animation_is_linear_in_the_file() {
    let read = |file: &GltfFile| gltf::parse(&file.glb(), &|_| None);
    let problem = read(&animated(200_000.0, 1)).unwrap_err();
    assert!(problem.limit && problem.text.contains("shorten it"), "{problem}");
    let start = Instant::now();
    let (character, notes) = read(&animated(600.0, 20_000)).unwrap();
    assert_eq!(character.clips[0].frame_count(), 36_001);
    assert_eq!(character.clips[0].sample(300.0)[0].translation.x, 0.5);
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("19999 animation channels are left out"), "{notes:?}");
    assert!(start.elapsed() < ENOUGH, "took {:?}", start.elapsed());
}

#[test]
fn arrays_that_are_used_over_and_over_are_limited() {
    let start = Instant::now();
    // Large indices in many primitives, and a large mesh in many nodes.
    let mut file = GltfFile::tetrahedron();
    let indices = file.bytes(5121, "SCALAR", 300_000, &vec![1; 300_000]);
    let primitive = json!({"attributes": {"POSITION": 0}, "indices": indices});
    file.json["meshes"][0]["primitives"] = json!(vec![primitive; 5_000]);
    let problem = gltf::parse(&file.glb(), &|_| None).unwrap_err();
    assert!(problem.limit, "{problem}");
    let mut file = GltfFile::tetrahedron();
    let positions = file.floats("VEC3", &vec![0.0; 90_000]);
    file.primitive()["attributes"]["POSITION"] = json!(positions);
    file.json["nodes"] = json!(vec![json!({"mesh": 0}); 1_000]);
    file.json["scenes"][0]["nodes"] = json!((0..1_000).collect::<Vec<_>>());
    let problem = gltf::parse(&file.glb(), &|_| None).unwrap_err();
    assert!(problem.limit && problem.text.contains("fewer copies"), "{problem}");
    // Many joints that use one track.
    let mut file = animated(1.0, 0);
    let times: Vec<f32> = (0..100_000).map(|i| i as f32 * 1e-5).collect();
    let times = file.floats("SCALAR", &times);
    let values = file.floats("VEC3", &vec![0.0; 300_000]);
    file.json["nodes"] = json!(vec![json!({}); 3_000]);
    file.json["scenes"][0]["nodes"] = json!((0..3_000).collect::<Vec<_>>());
    let samplers: Vec<_> = (0..3_000).map(|_| json!({"input": times, "output": values})).collect();
    let channels: Vec<_> =
        (0..3_000).map(|i| json!({"sampler": i, "target": {"node": i, "path": "scale"}})).collect();
    file.json["animations"] = json!([{"samplers": samplers, "channels": channels}]);
    gltf::parse(&file.glb(), &|_| None).unwrap();
    assert!(start.elapsed() < ENOUGH, "took {:?}", start.elapsed());
}

#[test]
fn a_hull_of_many_vertices_is_made_of_the_outermost() {
    let folder = tempfile::tempdir().unwrap();
    let count = 20_000;
    let mut text: String = (0..count)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f32 / count as f32;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            let r = (1.0 - z * z).sqrt();
            format!("v {} {} {z}\n", r * cos, r * sin)
        })
        .collect();
    text += "f 1 2 3\n";
    fs::write(folder.path().join("ball.obj"), text).unwrap();
    fs::write(folder.path().join("hair.obj"), "v 0 1 0\nv 0 1.1 0\nv 0 1.2 0\nl 1 2 3\n").unwrap();
    let groom = "[[groom]]\nfile = \"hair.obj\"\nscale = 1.0\n[[collider]]\n";
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, format!("{groom}shape.hull = {{ file = \"ball.obj\", scale = 1.0 }}\n")).unwrap();
    let start = Instant::now();
    let loaded = read_scene(&scene).unwrap();
    assert!(loaded.notes.iter().any(|n| n.contains("the hull of its 20000 vertices")), "{:?}", loaded.notes);
    let shape = &loaded.value.colliders[0].shape;
    let hairspring::collide::ColliderShape::Hull(hull) = shape.collider_shape().unwrap() else {
        panic!("no hull")
    };
    let deepest = hull.planes().map(|(_, offset)| offset).fold(f32::MAX, f32::min);
    assert!(deepest > 0.995, "a face of the hull is {deepest} of the radius from the center");
    assert!(start.elapsed() < ENOUGH, "took {:?}", start.elapsed());
    let points: Vec<String> = (0..3_000).map(|i| format!("[{i}.0, {}.0, {}.0]", i * i % 97, i % 7)).collect();
    fs::write(&scene, format!("{groom}shape.hull = {{ points = [{}] }}\n", points.join(", "))).unwrap();
    assert!(read_scene(&scene).unwrap_err().to_string().contains("at most 2048"));
}

#[test]
fn no_control_character_reaches_the_terminal() {
    const EVIL: &str = "\u{1b}]0;owned\u{7}\u{202e}";
    let is_plain =
        |text: &str| !text.chars().any(|c| c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c));
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let options = ReadOptions::default();

    let mut file = GltfFile::tetrahedron();
    file.json["nodes"][0]["name"] = json!(EVIL);
    file.json["meshes"][0]["name"] = json!(EVIL);
    file.json["materials"] = json!([{"name": EVIL}]);
    file.primitive()["material"] = json!(0);
    let times = file.floats("SCALAR", &[0.0, 1.0]);
    let values = file.floats("VEC3", &[0.0; 6]);
    file.json["animations"] = json!([{"name": EVIL, "samplers": [{"input": times, "output": values}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}]}]);
    fs::write(path("evil.glb"), file.glb()).unwrap();
    let character = read_body(&path("evil.glb"), &options).unwrap().value;
    let names =
        [&character.body.joints[0].name, &character.body.mesh.parts[0].name, &character.clips[0].name];
    assert!(names.iter().all(|n| is_plain(n) && n.contains("owned")), "{names:?}");

    fs::write(path("evil.obj"), format!("v 0 0 0\nv 1 0 0\nv 0 1 0\ng {EVIL}\nf 1 2 3\n")).unwrap();
    let parts = read_body(&path("evil.obj"), &options).unwrap().value.body.mesh.parts;
    assert!(is_plain(&parts[0].name) && parts[0].name.contains("owned"), "{parts:?}");

    fs::write(
        path("evil.bvh"),
        format!(
            "HIERARCHY\nROOT {EVIL}\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\nMOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n0 0 0\n"
        ),
    )
    .unwrap();
    let joints = read_motion(&path("evil.bvh"), None, &options).unwrap().value.joints;
    assert!(is_plain(&joints[0].name), "{joints:?}");

    // Messages: words of text files, URIs, extensions, and paths that a scene names.
    fs::write(path("a.obj"), format!("v 0 0 {EVIL}\n")).unwrap();
    fs::write(path("b.bvh"), format!("HIERARCHY\n{EVIL} a\n")).unwrap();
    let gltf = |json: serde_json::Value| json.to_string();
    let uri = json!({"asset": {"version": "2.0"}, "buffers": [{"uri": EVIL, "byteLength": 1}]});
    fs::write(path("c.gltf"), gltf(uri)).unwrap();
    let required = json!({"asset": {"version": "2.0"}, "extensionsRequired": [EVIL]});
    fs::write(path("d.gltf"), gltf(required)).unwrap();
    fs::write(path("e.toml"), "[[groom]]\nfile = \"\\u001b]0;owned\\u0007.hair\"\n").unwrap();
    fs::write(path("f.toml"), "[[groom]]\nfile = \"hair.obj\"\n[body]\nfile = \"evil.glb\"\n[[collider]]\njoint = \"\\u001b]0;\"\nshape.sphere = {center = [0, 0, 0], radius = 1}\n").unwrap();
    fs::write(path("hair.obj"), "v 0 1 0\nv 0 1.1 0\nv 0 1.2 0\nl 1 2 3\n").unwrap();
    fs::write(path("g.toml"), "\"\\u001b[31m\" = 1\n").unwrap();
    let errors = [
        read_body(&path("a.obj"), &options).unwrap_err(),
        read_motion(&path("b.bvh"), None, &options).unwrap_err(),
        read_body(&path("c.gltf"), &options).unwrap_err(),
        read_body(&path("d.gltf"), &options).unwrap_err(),
        read_scene(&path("e.toml")).unwrap_err(),
        read_scene(&path("f.toml")).unwrap_err(),
        read_scene(&path("g.toml")).unwrap_err(),
        read_groom(&path("\u{1b}[2J.hair"), &options).unwrap_err(),
    ];
    for error in errors {
        assert!(is_plain(&error.to_string()), "{:?}", error.to_string());
    }
}
