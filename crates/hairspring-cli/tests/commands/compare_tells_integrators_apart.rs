//! Promise: `hairspring compare --methods` simulates the same hair with each integrator and reports the results under
//! stable keys. Its report is one self-contained file.

use crate::common::{fail, json, names, succeed};
use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::write_groom;
use std::path::Path;

const KEYS: [&str; 10] = [
    "integrator",
    "stable",
    "reset_strands",
    "stretch_mean",
    "stretch_max",
    "swing_stretch_max",
    "energy_drift",
    "ns_per_point_substep",
    "longest_stable_step_s",
    "points_in_real_time",
];

/// A folder with a file of 24 hairs that hang straight down.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let hair = |s: usize| (0..11).map(move |i| Vec3::new(0.002 * s as f32, 1.0 - 0.02 * i as f32, 0.0));
    let groom = Groom::from_strands((0..24).map(|s| hair(s).collect::<Vec<_>>()), 4e-5);
    write_groom(&folder.path().join("few.tfx"), &groom).unwrap();
    folder
}

#[test]
fn explicit_steps_are_a_thousand_times_shorter_than_implicit_ones() {
    let folder = folder();
    let arguments = [
        "compare",
        "few.tfx",
        "--methods",
        "--seconds",
        "0.1",
        "--integrators",
        "verlet,backward-euler",
        "--json",
    ];
    let found = json(&succeed(folder.path(), &arguments));
    assert_eq!((&found["simulated_strands"], &found["substeps"]), (&24.into(), &4.into()));
    let list = found["integrators"].as_array().unwrap();
    let [verlet, implicit] = &list[..] else { panic!("{list:?}") };
    for (trial, name) in [(verlet, "verlet"), (implicit, "backward-euler")] {
        let keys: Vec<&str> = trial.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, KEYS);
        assert_eq!(trial["integrator"], name);
    }
    println!("{found:#}");
    assert_eq!((&implicit["stable"], &implicit["reset_strands"]), (&true.into(), &0.into()));
    assert!(implicit["stretch_max"].as_f64().unwrap() < 0.011);
    assert!(implicit["energy_drift"].as_f64().unwrap().abs() < 0.5);
    assert_eq!(verlet["energy_drift"], serde_json::Value::Null, "verlet is stable at a step of 4 ms");
    let longest = |t: &serde_json::Value| t["longest_stable_step_s"].as_f64().unwrap();
    assert!(longest(implicit) > 1000.0 * longest(verlet));
}

#[test]
fn the_page_is_one_file() {
    let folder = folder();
    let arguments = [
        "compare",
        "few.tfx",
        "--methods",
        "--seconds",
        "0.1",
        "--integrators",
        "dftl,bdf2",
        "--report",
        "page.html",
    ];
    let stdout = succeed(folder.path(), &arguments);
    assert!(stdout.contains("dftl") && stdout.contains("bdf2") && stdout.contains("page.html"), "{stdout}");
    assert_eq!(names(folder.path()), ["few.tfx", "page.html"]);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    for part in
        ["<!doctype html>", "Dynamic follow the leader", "data:image/png;base64,", "<polyline", "</html>"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(
        !page.contains("src=\"http") && !page.contains("verlet</a>"),
        "the page loads other files or lists an integrator that was not requested"
    );
}

#[test]
fn invalid_arguments_are_refused() {
    for (arguments, code, part) in [
        (&["compare", "--methods", "--integrators", "magic"][..], 2, "'magic'"),
        (&["compare", "--methods", "--seconds", "1e9"], 2, "--seconds"),
        (&["compare", "--methods", "--scale", "2"], 2, "--scale"),
        (&["compare", "nowhere.hair", "--methods"], 3, "nowhere.hair"),
        (&["compare", "--methods", "--report", "no/where.html"], 5, "no"),
        (&["compare", "--methods", "--report", "shot.toml"], 2, "a name that ends in .html"),
    ] {
        let stderr = fail(Path::new("."), arguments, code);
        assert!(stderr.lines().count() == 1 && stderr.contains(part), "{arguments:?}: {stderr}");
    }
}
