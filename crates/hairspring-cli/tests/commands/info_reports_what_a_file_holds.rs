//! Promise: `hairspring info` reports the content of a file in numbers that a script can rely on.
//!
//! The keys are part of the interface: pipelines count strands and check bounds with them. The values are
//! compared with the groom that the test wrote. Repairs made during reading are counted.

use crate::common::{fail, groom, json, succeed, text, write_groom, write_scene};
use glam::Vec3;

#[test]
fn json_of_a_groom() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 50);
    let found = json(&succeed(folder.path(), &["info", "groom.hair", "--json"]));
    let keys: Vec<&str> = found.as_object().unwrap().keys().map(String::as_str).collect();
    let promised =
        ["format", "strands", "points", "points_min", "points_max", "length_m", "bounds_m", "repaired"];
    assert_eq!(keys[..promised.len()], promised);

    let groom = groom(50);
    assert_eq!(found["format"], "hair");
    assert_eq!(found["strands"], 50);
    assert_eq!(found["points"], groom.point_count());
    assert_eq!((found["points_min"].as_u64(), found["points_max"].as_u64()), (Some(8), Some(11)));
    assert_eq!(found["repaired"], 0);
    let mut lengths: Vec<f32> = (0..50).map(|s| groom.strand_length(s)).collect();
    lengths.sort_by(f32::total_cmp);
    let found_lengths = found["length_m"].as_array().unwrap();
    assert_eq!(found_lengths.len(), 3, "expected the shortest, the median and the longest");
    for (got, want) in found_lengths.iter().zip([lengths[0], lengths[25], lengths[49]]) {
        assert!((got.as_f64().unwrap() - f64::from(want)).abs() < 1e-6, "{got} instead of {want}");
    }
    let (low, high) = groom.bounds().unwrap();
    let found_bounds = found["bounds_m"].as_array().unwrap();
    assert_eq!(found_bounds.len(), 2, "expected two corners");
    for (got, want) in found_bounds.iter().zip([low, high]) {
        let got: Vec<f32> = got.as_array().unwrap().iter().map(|n| n.as_f64().unwrap() as f32).collect();
        assert!(Vec3::from_slice(&got).distance(want) < 1e-6, "{got:?} instead of {want}");
    }
}

#[test]
fn a_bald_head_has_no_lengths() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bald.toml"), "[builtin]\nstrands = 0\n").unwrap();
    let found = json(&succeed(folder.path(), &["info", "bald.toml", "--json"]));
    let scalp = &found["grooms"][0];
    assert_eq!(scalp["strands"], 0);
    assert!(["length_m", "bounds_m", "points_min"].iter().all(|key| scalp[key].is_null()), "{scalp}");
}

#[test]
fn text_output_has_the_same_values() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 1200);
    let lines = succeed(folder.path(), &["info", "groom.hair"]);
    assert!(lines.lines().any(|l| l.split_whitespace().eq(["strands", "1,200"])), "{lines}");
}

#[test]
fn repairs_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut broken = groom(10);
    broken.points[3] = Vec3::NAN;
    broken.points[20] = Vec3::splat(f32::INFINITY);
    hairspring_io::write_groom(&folder.path().join("broken.hair"), &broken).unwrap();
    let output = crate::common::run(folder.path(), &["info", "broken.hair", "--json"]);
    assert!(output.status.success());
    assert_eq!(json(&String::from_utf8(output.stdout).unwrap())["repaired"], 2);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(notes.contains("repaired 2 points that were not finite"), "{notes}");
}

#[test]
fn scenes_and_bodies() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 70);
    let scene = json(&succeed(folder.path(), &["info", "scene.toml", "--json"]));
    assert_eq!((&scene["format"], &scene["strands"]), (&"toml".into(), &70.into()));
    assert_eq!((&scene["grooms"][0]["simulated"], &scene["colliders"]), (&60.into(), &1.into()));

    let body = folder.path().join("body.obj");
    std::fs::write(&body, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let body = json(&succeed(folder.path(), &["info", text(&body), "--json"]));
    assert_eq!((&body["vertices"], &body["triangles"]), (&3.into(), &1.into()));
}

/// Every group has a guide, also where the scene asks for fewer.
#[test]
fn the_number_of_simulated_strands_is_that_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let rows = (0..90).flat_map(|s| {
        (0..4).map(move |i| format!("{s},{},{},0,{}\n", 0.001 * f64::from(s), 0.02 * f64::from(i), s.min(30)))
    });
    let table = format!("strand,x,y,z,group\n{}", rows.collect::<String>());
    std::fs::write(folder.path().join("hair.csv"), table).unwrap();
    for (guides, simulated, noted) in [
        ("2", 31, true),
        ("40", 57, true),
        // A third of a guide more for each of 30 groups is rounding.
        ("60", 70, false),
        ("\"all\"", 90, false),
        ("\"file\"", 90, false),
    ] {
        let scene = format!("[[groom]]\nfile = \"hair.csv\"\nscale = 1.0\nguides = {guides}\n");
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        let info = json(&succeed(folder.path(), &["info", "scene.toml", "--json"]));
        let bake = ["bake", "scene.toml", "-o", "out.hair", "--frames", "1", "--json"];
        let output = crate::common::run(folder.path(), &bake);
        let run = json(&String::from_utf8(output.stdout).unwrap());
        let counts = [&info["grooms"][0]["simulated"], &run["simulated_strands"]].map(|n| n.as_u64());
        assert_eq!(counts, [Some(simulated); 2], "guides = {guides}");
        let notes = String::from_utf8(output.stderr).unwrap();
        let note = format!(
            "{simulated} strands are simulated instead of {guides}, because each of the 31 groups has at least one"
        );
        assert_eq!(notes.contains(&note), noted, "{notes}");
    }
}

#[test]
fn curves_are_a_groom() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("lines.obj", "v 0 0 0\nv 0 0.1 0\nv 0 0.2 0\nl 1 2 3\n");
    write(
        "edges.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n0 0.1 0\n0 0.2 0\n0 1\n1 2\n",
    );
    for name in ["lines.obj", "edges.ply"] {
        let found = json(&succeed(folder.path(), &["info", name, "--json"]));
        assert_eq!(
            (found["strands"].as_u64(), found["points"].as_u64()),
            (Some(1), Some(3)),
            "{name}: {found}"
        );
    }
}

#[test]
fn places_of_joints_and_parts_and_the_distance_of_roots() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("body.obj", "g floor\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\ng wall\nv 0 2 0\nv 1 2 0\nf 1 4 5\n");
    let body = json(&succeed(folder.path(), &["info", "body.obj", "--json", "--scale", "1"]));
    assert_eq!(body["parts"], serde_json::json!(["floor", "wall"]));
    assert_eq!(body["part_bounds_m"][0], serde_json::json!([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]]));
    assert_eq!(body["part_bounds_m"][1], serde_json::json!([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0]]));
    let lines = succeed(folder.path(), &["info", "body.obj", "--scale", "1"]);
    assert!(lines.contains("part bounds m") && lines.contains("wall "), "{lines}");

    write(
        "walk.bvh",
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nJOINT Head\n{\nOFFSET 0 0.5 0\n\
         CHANNELS 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.02\n0 1 0\n",
    );
    let motion = json(&succeed(folder.path(), &["info", "walk.bvh", "--json", "--scale", "1"]));
    assert_eq!(motion["joints"], serde_json::json!(["Hips", "Head"]));
    assert_eq!(motion["joint_positions_m"], serde_json::json!([[0.0, 1.0, 0.0], [0.0, 1.5, 0.0]]));

    write_groom(folder.path(), 20);
    write("scene.toml", "[body]\nfile = \"body.obj\"\nscale = 1.0\n[[groom]]\nfile = \"groom.hair\"\n");
    let output = crate::common::run(folder.path(), &["info", "scene.toml", "--json"]);
    let scene = json(&String::from_utf8(output.stdout).unwrap());
    let distances = &scene["grooms"][0]["root_distance_m"];
    assert!(distances[0].as_f64().unwrap() <= distances[1].as_f64().unwrap(), "{distances}");
    let notes = String::from_utf8(output.stderr).unwrap();
    assert_eq!(notes.contains("from the skin"), distances[1].as_f64().unwrap() > 0.01, "{notes}");
}

#[test]
fn strands_are_reversed_on_request() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 5);
    succeed(folder.path(), &["convert", "groom.hair", "turned.hair", "--reverse"]);
    let path = folder.path().join("turned.hair");
    let turned = hairspring_io::read_groom(&path, &hairspring_io::ReadOptions::default()).unwrap().value;
    let mut groom = groom(5);
    groom.reverse();
    assert_eq!(turned.points, groom.points);
    succeed(folder.path(), &["info", "groom.hair", "--reverse"]);
    write_scene(folder.path(), 70);
    let error = crate::common::fail(folder.path(), &["info", "scene.toml", "--reverse"], 2);
    assert!(error.contains("--reverse applies to a groom file"), "{error}");
}

#[test]
fn a_point_cache_is_described_in_its_own_unit() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    // Three samples of a triangle.
    let mut cache = b"POINTCACHE2\0".to_vec();
    cache.extend([1i32, 3].map(i32::to_le_bytes).concat());
    cache.extend([0f32, 1.0].map(f32::to_le_bytes).concat());
    cache.extend(3i32.to_le_bytes());
    for k in 0..3 {
        let y = 0.5 * k as f32;
        let sample: [f32; 9] = [0.0, y, 0.0, 1.0, y, 0.0, 0.0, y, -1.0];
        cache.extend(sample.map(f32::to_le_bytes).concat());
    }
    std::fs::write(f.join("a.pc2"), cache).unwrap();
    let found = json(&succeed(f, &["info", "a.pc2", "--json"]));
    assert_eq!((&found["samples"], &found["points"]), (&3.into(), &3.into()));
    assert_eq!(found["bounds_file_units"], serde_json::json!([[0.0, 0.0, -1.0], [1.0, 1.0, 0.0]]));
    let stderr = fail(f, &["info", "a.pc2", "--scale", "0.01"], 2);
    assert!(stderr.contains("--scale and --up do not apply to a .pc2 file"), "{stderr}");
    // A scene that it moves has a motion.
    std::fs::write(f.join("skin.obj"), "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n").unwrap();
    let scene = "[body]\nfile = \"skin.obj\"\nscale = 1.0\nvertex_cache = \"a.pc2\"\n[[groom]]\ngrow = { strands = 3 }\n";
    std::fs::write(f.join("a.toml"), scene).unwrap();
    let motion = json(&succeed(f, &["info", "a.toml", "--json"]))["motion"].clone();
    assert_eq!(motion["frames"], 3, "{motion}");
}
