//! Promise: a note says which motion of a file a scene plays or leaves out if it does not name one, and which joint it
//! uses if several have the name that it gives.

use crate::gltf_file::GltfFile;
use hairspring_io::{Error, Loaded, ReadOptions, read_motion, read_scene};
use hairspring_scene::Scene;
use serde_json::json;
use std::fs;

/// A tetrahedron with motions of these names.
fn moving(names: &[&str]) -> GltfFile {
    let mut file = GltfFile::tetrahedron();
    let (times, values) =
        (file.floats("SCALAR", &[0.0, 1.0]), file.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.1, 0.0]));
    for name in names {
        let channel = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
        let sampler = json!({"input": times, "output": values});
        file.push("animations", json!({"name": name, "samplers": [sampler], "channels": [channel]}));
    }
    file
}

/// Reads a scene with hair on the body `file`.
fn scene(file: &GltfFile, rest: &str) -> Result<Loaded<Scene>, Error> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("head.glb"), file.glb()).unwrap();
    let path = folder.path().join("a.toml");
    let hair = "[[groom]]\nguides = \"all\"\n[groom.grow]\nstrands = 20\nlength = 0.05\n";
    fs::write(&path, format!("{hair}[body]\nfile = \"head.glb\"\n{rest}")).unwrap();
    read_scene(&path)
}

/// Number of notes with `text` of a scene.
fn noted(file: &GltfFile, rest: &str, text: &str) -> usize {
    let notes = scene(file, rest).unwrap().notes;
    notes.iter().filter(|note| note.contains(text)).count()
}

#[test]
fn motions_that_are_not_played_are_noted() {
    let text = "head.glb: the file has 2 motions (walk, run), which are not played; add [clip]";
    assert_eq!(noted(&moving(&["walk", "run"]), "", text), 1);
    for rest in ["[clip]\n", "[clip]\nname = \"run\"\n"] {
        assert_eq!(noted(&moving(&["walk", "run"]), rest, "not played"), 0, "{rest}");
    }
    assert_eq!(noted(&moving(&[]), "", "motion"), 0);
}

#[test]
fn motions_of_other_meshes_and_of_hair_are_noted() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("head.glb"), moving(&[]).glb()).unwrap();
    fs::write(path("other.glb"), moving(&["swing"]).glb()).unwrap();
    let mut lines = GltfFile::default();
    let points = lines.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, -0.1, 0.0, 0.0, -0.2, 0.0]);
    lines.push("meshes", json!({"primitives": [{"mode": 3, "attributes": {"POSITION": points}}]}));
    lines.json["nodes"] = json!([{"mesh": 0}]);
    lines.json["scenes"][0]["nodes"] = json!([0]);
    lines.push("animations", json!({"name": "swing", "samplers": [], "channels": []}));
    fs::write(path("hair.glb"), lines.glb()).unwrap();
    let hair = "[[groom]]\nguides = \"all\"\n[groom.grow]\nstrands = 20\nlength = 0.05\n";
    let notes = |rest: &str| {
        fs::write(path("a.toml"), format!("{hair}[body]\nfile = \"head.glb\"\n{rest}\n")).unwrap();
        read_scene(&path("a.toml")).unwrap().notes
    };
    let text = "the file has 1 motion (swing), which is not played";
    let rigid = "file = \"other.glb\"\njoint = \"Head\"";
    for (rest, file, end) in [
        (format!("[[body.more]]\n{rigid}"), "other.glb", "; the mesh moves with the joints of the [body]"),
        (format!("[collision]\n{rigid}"), "other.glb", "; the mesh moves with the joints of the [body]"),
        (format!("[[sheet]]\n{rigid}"), "other.glb", "; the mesh moves with the joints of the [body]"),
        (
            "[[prop]]\nname = \"Rope\"\nmesh = { file = \"other.glb\" }".into(),
            "other.glb",
            "; the [[prop]] moves by its `keys`",
        ),
        (
            "[[collider]]\nshape = { hull = { file = \"other.glb\" } }".into(),
            "other.glb",
            "; the hull moves with the `joint` of its [[collider]]",
        ),
        ("[[groom]]\nfile = \"hair.glb\"".into(), "hair.glb", " on the strands; they follow the [body]"),
    ] {
        let found = notes(&rest);
        let wanted = format!("{file}: {text}{end}");
        assert_eq!(found.iter().filter(|note| **note == wanted).count(), 1, "{rest}: {found:?}");
        assert_eq!(found.iter().filter(|note| note.contains("not played")).count(), 1, "{rest}: {found:?}");
    }
    // The motion of that file is played.
    let found = notes(&format!("[[body.more]]\n{rigid}\n[clip]\nfile = \"other.glb\""));
    assert!(found.iter().all(|note| !note.contains("not played")), "{found:?}");
}

#[test]
fn the_first_of_several_motions_is_noted() {
    let text = "the file has 2 motions, and the first, \"walk\", is used; set `name` to use another: run";
    let file = moving(&["walk", "run"]);
    assert_eq!(noted(&file, "[clip]\n", text), 1);
    assert_eq!(noted(&file, "[clip]\nfile = \"head.glb\"\n", text), 1);
    assert_eq!(noted(&file, "[clip]\nname = \"walk\"\n", "is used"), 0);
    assert_eq!(noted(&moving(&["walk"]), "[clip]\n", "is used"), 0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.glb");
    fs::write(&path, file.glb()).unwrap();
    assert!(read_motion(&path, None, &ReadOptions::default()).unwrap().notes.contains(&text.to_owned()));
}

#[test]
fn a_clip_without_a_motion_names_the_remedy() {
    let error = scene(&moving(&[]), "[clip]\n").unwrap_err().to_string();
    assert!(
        error.contains("[clip] names no `file`, and the body's own file holds no motion; name"),
        "{error}"
    );
}

#[test]
fn joints_of_the_same_name_are_noted() {
    let mut file = moving(&[]);
    file.json["nodes"] = json!([
        {"name": "Root", "children": [1]}, {"name": "Head", "mesh": 0}, {"name": "Head", "mesh": 0}
    ]);
    file.json["scenes"][0]["nodes"] = json!([0, 2]);
    let collider = "[[collider]]\nshape.sphere = { center = [0.0, 1.0, 0.0], radius = 0.1 }\njoint = ";
    let text = "the body has 2 joints called \"Head\", and the first, below \"Root\", is used";
    assert_eq!(noted(&file, &format!("{collider}\"Head\"\n"), text), 1);
    assert_eq!(noted(&file, &format!("{collider}\"Root\"\n"), "is used"), 0);
}
