//! Promise: `hairspring compare` shows two scenes, or one scene with two settings, side by side with labels,
//! and reports their differences under stable keys.

use crate::common::{contents, fail, json, names, play, program, succeed, write_groom, write_scene};
use hairspring_view::{Image, read_png};
use serde_json::Value;
use std::path::Path;

const KEYS: [&str; 10] =
    ["a", "b", "settings", "files", "distance", "frames", "fps", "threads", "simd", "output"];

const SIDE_KEYS: [&str; 17] = [
    "file",
    "scene",
    "strands",
    "points",
    "simulated_strands",
    "simulated_points",
    "substeps",
    "reset_strands",
    "stretch_mean",
    "stretch_max",
    "speed_max_m_s",
    "max_depth_m",
    "segment_depth_m",
    "energy_start_j",
    "energy_end_j",
    "kinetic_energy_mean_j",
    "ms_per_frame",
];

const DISTANCE_KEYS: [&str; 6] = ["mean_m", "max_m", "max_frame", "max_strand", "end_mean_m", "end_max_m"];

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The JSON of a comparison without a picture.
fn compare(folder: &Path, arguments: &[&str]) -> Value {
    json(&succeed(folder, &[&["compare", "--no-picture", "--json"], arguments].concat()))
}

/// Number of light pixels, which only letters have, in a caption of 28 rows that ends at row `bottom`.
fn letters(image: &Image, bottom: u32, columns: std::ops::Range<u32>) -> usize {
    let pixels = (bottom - 28..bottom).flat_map(|y| columns.clone().map(move |x| (x, y)));
    pixels.filter(|&(x, y)| image.pixel(x, y)[0] > 150).count()
}

#[test]
fn two_settings_of_one_scene() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 60);
    let sets = ["scene.toml", "--set-a", "solver.substeps=4", "--set-b", "solver.substeps=8"];
    let found = compare(f, &[&sets[..], &["--seconds", "0.4"]].concat());
    assert_eq!(keys(&found), KEYS);
    assert_eq!((keys(&found["a"]), keys(&found["b"])), (SIDE_KEYS.to_vec(), SIDE_KEYS.to_vec()));
    assert_eq!(keys(&found["distance"]), DISTANCE_KEYS);
    let settings = serde_json::json!([{ "key": "solver.substeps", "a": 4, "b": 8 }]);
    assert_eq!((&found["settings"], &found["files"]), (&settings, &serde_json::json!([])));
    assert_eq!((&found["frames"], &found["output"]), (&13.into(), &Value::Null));
    let number = |v: &Value| v.as_f64().unwrap();
    let [a, b] = [&found["a"], &found["b"]];
    // A frame of 1/30 s has twice the substeps of 1/60 s.
    assert_eq!((number(&a["substeps"]), number(&b["substeps"])), (8.0, 16.0));
    assert_eq!((&a["strands"], &a["simulated_strands"]), (&60.into(), &60.into()));
    for side in [a, b] {
        assert!(number(&side["speed_max_m_s"]) > 0.05 && number(&side["kinetic_energy_mean_j"]) > 0.0);
        assert!(number(&side["stretch_mean"]) <= number(&side["stretch_max"]));
        assert!(number(&side["ms_per_frame"]) > 0.0 && side["reset_strands"] == 0);
    }
    let distance = &found["distance"];
    assert!(number(&distance["max_m"]) > 0.0, "{distance}");
    assert!(number(&distance["max_m"]) < 0.2, "{distance}");
    assert!(number(&distance["mean_m"]) <= number(&distance["max_m"]));
    assert!(number(&distance["end_mean_m"]) <= number(&distance["end_max_m"]));
    assert!((1..60).contains(&distance["max_strand"].as_u64().unwrap().max(1)));
    assert_eq!(names(f), ["groom.hair", "scene.toml"], "a picture was written");

    // The default in words, and the same settings on both sides.
    let found = compare(f, &["scene.toml", "--set-b", "solver.substeps=4", "--seconds", "0.2"]);
    assert_eq!(found["settings"], serde_json::json!([]));
    assert_eq!(
        (&found["distance"]["max_m"], &found["a"]["energy_end_j"]),
        (&0.0.into(), &found["b"]["energy_end_j"])
    );
    // A name needs no quotes, and --set changes both sides.
    let sets = ["--set", "wind.gust=0.0", "--set-b", "solver.integrator=bdf2"];
    let found = compare(f, &[&["scene.toml", "--seconds", "0.1"], &sets[..]].concat());
    assert_eq!(found["settings"].as_array().unwrap().len(), 1);
    assert_eq!(found["settings"][0]["b"], "bdf2");
}

#[test]
fn reversed_strands_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    write_groom(folder.path(), 20);
    let turned = ["groom.hair", "--set-b", "groom[0].reverse=true", "--seconds", "0.1"];
    let apart = |arguments: &[&str]| compare(folder.path(), arguments)["distance"]["max_m"].as_f64().unwrap();
    assert!(apart(&turned) > 1e-3);
    assert_eq!(apart(&[&turned[..], &["--reverse"]].concat()), 0.0);
}

#[test]
fn two_scenes_with_other_files_and_strands() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    for (name, strands) in [("a", 30), ("b", 50)] {
        std::fs::create_dir(f.join(name)).unwrap();
        write_scene(&f.join(name), strands);
    }
    let found = compare(f, &["a/scene.toml", "b/scene.toml", "--seconds", "0.1"]);
    assert_eq!((&found["files"], &found["distance"]), (&serde_json::json!(["groom.hair"]), &Value::Null));
    assert_eq!((&found["a"]["strands"], &found["b"]["strands"]), (&30.into(), &50.into()));
    assert_eq!((&found["a"]["file"], &found["b"]["file"]), (&"a/scene.toml".into(), &"b/scene.toml".into()));
    let arguments = ["compare", "a/scene.toml", "b/scene.toml", "--seconds", "0.1", "--no-picture"];
    let text = succeed(f, &arguments);
    for part in
        ["settings the same", "groom.hair", "not measured", "30 hairs", "50 of", "speed, fastest point"]
    {
        assert!(text.contains(part), "'{part}' is missing in: {text}");
    }
    // A groom is compared like a scene that holds only it.
    let found = compare(f, &["a/groom.hair", "b/groom.hair", "--scale", "1", "--seconds", "0.1"]);
    assert_eq!(found["a"]["strands"], 30);
}

#[test]
fn a_clip_shows_both_sides_with_labels() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 60);
    let arguments =
        ["compare", "scene.toml", "--set-b", "wind.gust=0.9", "--seconds", "0.2", "--size", "320x128"];
    let text = succeed(f, &[&arguments[..], &["-o", "pair.mp4"]].concat());
    assert!(text.contains("wind.gust") && text.contains("0.9") && text.contains("pair.mp4"), "{text}");
    assert_eq!(play(&f.join("pair.mp4")), (7, (320, 128)));
}

#[test]
fn a_contact_sheet_is_the_default() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 60);
    let arguments = [
        "compare",
        "scene.toml",
        "--set-b",
        "groom[0].look.roughness=0.9",
        "--seconds",
        "0.3",
        "--size",
        "320x128",
    ];
    succeed(f, &arguments);
    assert_eq!(names(f), ["compare.png", "groom.hair", "scene.toml"]);
    let sheet = read_png(&f.join("compare.png")).unwrap();
    assert_eq!((sheet.width, sheet.height), (320, 4 * 128));
    for row in 1..=4 {
        for columns in [0..158, 162..320] {
            let ink = letters(&sheet, row * 128, columns.clone());
            assert!(ink > 40, "row {row}, {columns:?}: {ink} pixels of letters");
        }
    }
    // The hair moves from row to row.
    let rows: Vec<&[u8]> = sheet.rgb.chunks(3 * 320 * 128).collect();
    assert!(rows[0][..3 * 320 * 100] != rows[3][..3 * 320 * 100]);
    succeed(f, &[&arguments[..], &["-o", "sheet.jpg"]].concat());
    assert!(f.join("sheet.jpg").exists());
}

#[test]
fn wrong_arguments_are_refused_and_write_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 20);
    write_groom(f, 20);
    let before = contents(f);
    for (arguments, code, part) in [
        (&["compare", "scene.toml"][..], 2, "--methods"),
        (&["compare", "scene.toml", "--set-a", "solver.substeps"], 2, "KEY=VALUE"),
        (&["compare", "scene.toml", "--set-b", "solver.substepz=4"], 2, "did you mean `substeps`?"),
        (&["compare", "scene.toml", "--set-b", "groom[3].guides=4"], 2, "groom[3]"),
        (&["compare", "scene.toml", "--set-b", "solver.substeps=-4"], 2, "--set-b solver.substeps=-4"),
        (&["compare", "scene.toml", "none.toml"], 3, "none.toml"),
        (&["compare", "scene.toml", "none.hair"], 3, "none.hair"),
        (&["compare", "scene.toml", "none.xyz"], 2, "none.xyz"),
        (&["compare", "scene.toml", "groom.hair", "-o", "x.gif"], 2, "x.gif"),
        (&["compare", "scene.toml", "groom.hair", "-o", "no/x.mp4"], 5, "does not exist"),
        (&["compare", "scene.toml", "groom.hair", "--size", "32x32"], 2, "64x64"),
        (&["compare", "scene.toml", "groom.hair", "--seconds", "1e9"], 2, "--seconds"),
        (&["compare", "scene.toml", "groom.hair", "--integrators", "verlet"], 2, "--methods"),
        (&["compare", "scene.toml", "groom.hair", "--substeps", "4"], 2, "--methods"),
        (&["compare", "scene.toml", "groom.hair", "--reverse"], 2, "--reverse applies to a groom file"),
        (&["compare", "--methods", "--reverse"], 2, "none is given"),
    ] {
        let stderr = fail(f, arguments, code);
        let errors: Vec<&str> = stderr.lines().filter(|l| !l.starts_with("note: ")).collect();
        assert!(errors.len() == 1 && errors[0].contains(part), "{arguments:?}: {stderr}");
        assert!(contents(f) == before, "{arguments:?} left something behind");
    }
    // Options of the other comparison are refused by the command line.
    for arguments in
        [&["compare", "scene.toml", "--methods", "--set-a", "solver.substeps=2"][..], &["compare"]]
    {
        let output = program(f, arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    // An invalid scene is an error of its content.
    std::fs::write(f.join("bad.toml"), "[solver]\nsubstepz = 4\n").unwrap();
    assert!(fail(f, &["compare", "scene.toml", "bad.toml"], 4).contains("bad.toml"));
}
