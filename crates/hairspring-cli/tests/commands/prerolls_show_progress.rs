//! Promise: a pre-roll, which may take longer than the scene, shows its progress.

use crate::common::{json, program, write_groom};
use std::path::Path;

/// Standard output and standard error of a bake.
fn bake(folder: &Path, options: &[&str]) -> (String, String) {
    let bake = ["bake", "scene.toml", "-o", "f.#.hair", "--frames", "1-2"];
    let output = program(folder, &[&bake[..], options].concat()).output().unwrap();
    let [stdout, stderr] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(output.status.success(), "{stderr}");
    (stdout, stderr)
}

#[test]
fn a_preroll_shows_its_progress() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 10);
    let groom = "[[groom]]\nfile = \"groom.hair\"\nscale = 1.0\n";
    std::fs::write(f.join("scene.toml"), groom).unwrap();
    assert!(!bake(f, &[]).1.contains("pre-roll"));
    std::fs::write(f.join("scene.toml"), format!("{groom}[solver]\npreroll = 0.2\n")).unwrap();
    let (_, stderr) = bake(f, &[]);
    for line in ["pre-roll of 12 frames", "pre-roll 6/12 frames", "pre-roll 12/12 frames"] {
        assert_eq!(stderr.lines().filter(|l| *l == line).count(), 1, "{line}: {stderr}");
    }
    assert_eq!(bake(f, &["--quiet"]).1, "");
    // As JSON, every line is an event.
    let (_, stderr) = bake(f, &["--progress", "json"]);
    let events: Vec<_> = stderr.lines().map(json).filter(|event| event["what"] == "pre-roll").collect();
    assert_eq!(events.len(), 12);
    assert_eq!((&events[11]["done"], &events[11]["total"]), (&12.into(), &12.into()));
    // The number of Open Job Description is that of the run.
    let (stdout, _) = bake(f, &["--progress", "openjd"]);
    assert!(stdout.contains("openjd_status: pre-roll, 12 of 12 frames"), "{stdout}");
    assert_eq!(stdout.matches("openjd_progress: ").count(), 2, "{stdout}");
}
