//! Promise: `hairspring info` reports the content of a file in numbers that a script can rely on.
//!
//! The keys are part of the interface: pipelines count strands and check bounds with them. The values are
//! compared with the groom that the test wrote. Repairs made during reading are counted.

use crate::common::{groom, json, succeed, text, write_groom, write_scene};
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
