//! Promise: `--resume` continues only a run of the same inputs, options, version and instruction set, and
//! skips only frames that have the length and checksum of the finished ones.
//!
//! Frames of two different runs in one sequence flicker, and nobody sees why. A refusal is one sentence that
//! names the file, option or version that differs, and changes nothing.

use crate::common::{contents, fail, json, names, program, succeed, write_groom, write_scene};
use std::path::Path;

const BAKE: [&str; 5] = ["bake", "scene.toml", "-o", "hair.##.hair", "--json"];
const MANIFEST: &str = "hair.bake.hair.json";

fn bake(folder: &Path, more: &[&str]) -> serde_json::Value {
    json(&succeed(folder, &[&BAKE[..], more].concat()))
}

/// Runs the command with `--resume`. It must succeed; returns standard error.
fn resume(folder: &Path, arguments: &[&str]) -> String {
    let output = program(folder, arguments).arg("--resume").output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{stderr}");
    stderr
}

/// Replaces `from` by `to` in a text file.
fn edit(path: &Path, from: &str, to: &str) {
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains(from), "{text}");
    std::fs::write(path, text.replacen(from, to, 1)).unwrap();
}

/// Runs the bake with `--resume`. It must be refused with one sentence that contains `words`, and change
/// nothing.
fn refuse(folder: &Path, more: &[&str], code: i32, words: &[&str]) {
    let before = contents(folder);
    let stderr = fail(folder, &[&BAKE[..], &["--frames", "1-3", "--resume"], more].concat(), code);
    let errors: Vec<&str> = stderr.lines().filter(|l| !l.starts_with("note: ")).collect();
    assert!(errors.len() == 1 && errors[0].starts_with("error: "), "{stderr}");
    for word in words {
        assert!(errors[0].contains(word), "'{word}' is missing in: {stderr}");
    }
    assert!(contents(folder) == before, "something has changed");
}

#[test]
fn resuming_another_run_is_refused_with_the_difference() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    bake(f, &["--frames", "1-3"]);
    refuse(f, &["--fps", "24"], 2, &["--fps was 30 and is 24", MANIFEST]);
    refuse(f, &["--substeps", "8"], 2, &["--substeps was the default and is 8"]);
    refuse(f, &["--guides", "all", "--fps", "25"], 2, &["--guides was the default and is all", "--fps"]);

    let [scene, manifest] = ["scene.toml", MANIFEST].map(|name| f.join(name));
    edit(&scene, "gust = 0.5", "gust = 0.6");
    refuse(f, &[], 2, &["scene.toml has changed"]);
    edit(&scene, "gust = 0.6", "gust = 0.5");
    // The order of the grooms' points is another one, the length of the file is the same.
    let groom = std::fs::read(f.join("groom.hair")).unwrap();
    let mut changed = groom.clone();
    let last = changed.len() - 4;
    changed[last..].copy_from_slice(&0.01f32.to_le_bytes());
    std::fs::write(f.join("groom.hair"), &changed).unwrap();
    refuse(f, &[], 2, &["groom.hair has changed"]);
    std::fs::write(f.join("groom.hair"), &groom).unwrap();

    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    edit(&manifest, &version, "\"version\": \"0.0.9\"");
    refuse(f, &[], 2, &["hairspring was 0.0.9 and is"]);
    edit(&manifest, "\"version\": \"0.0.9\"", &version);
    edit(&manifest, "\"instruction_set\": \"", "\"instruction_set\": \"other ");
    refuse(f, &[], 2, &["the instruction set was other"]);
    edit(&manifest, "\"instruction_set\": \"other ", "\"instruction_set\": \"");

    let whole = std::fs::read(&manifest).unwrap();
    std::fs::write(&manifest, &whole[..whole.len() / 2]).unwrap();
    refuse(f, &[], 4, &[MANIFEST, "is not the manifest of an earlier run"]);
    std::fs::write(&manifest, whole).unwrap();
    let stderr = resume(f, &[&BAKE[..], &["--frames", "1-3"]].concat());
    assert!(!stderr.contains("again"), "{stderr}");
}

#[test]
fn a_file_that_is_no_manifest_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    std::fs::write(f.join(MANIFEST), "{ \"notes\": \"mine\" }").unwrap();
    let before = contents(f);
    let error = fail(f, &[&BAKE[..], &["--frames", "1-2"]].concat(), 4);
    let words = [MANIFEST, "is not the manifest of an earlier run", "choose another name for the output"];
    assert!(words.iter().all(|word| error.contains(word)), "{error}");
    let pictures = f.join("hair.render.png.json");
    std::fs::write(&pictures, "mine").unwrap();
    let render = ["render", "scene.toml", "-o", "hair.##.png", "--frames", "1-2", "--size", "64x64"];
    let error = fail(f, &render, 4);
    assert!(error.contains("hair.render.png.json is not the manifest"), "{error}");
    std::fs::remove_file(pictures).unwrap();
    assert!(contents(f) == before, "something has changed");
}

#[test]
fn a_truncated_or_changed_frame_is_written_again_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    bake(f, &["--frames", "1-6"]);
    let whole = contents(f);
    let at = |n: u32| f.join(format!("hair.{n:02}.hair"));
    let [second, fourth] = [2, 4].map(|n| std::fs::read(at(n)).unwrap());
    std::fs::write(at(2), &second[..500]).unwrap();
    let mut flipped = fourth.clone();
    *flipped.last_mut().unwrap() ^= 1;
    std::fs::write(at(4), &flipped).unwrap();
    std::fs::remove_file(at(5)).unwrap();
    let stderr = resume(f, &[&BAKE[..], &["--frames", "1-6"]].concat());
    let truncated = format!("it has 500 bytes instead of {}", second.len());
    assert!(stderr.contains("hair.02.hair is made again") && stderr.contains(&truncated), "{stderr}");
    assert!(stderr.contains("hair.04.hair is made again: its content has changed"), "{stderr}");
    assert!(!stderr.contains("hair.05.hair") && !stderr.contains("hair.01.hair"), "{stderr}");
    assert!(contents(f) == whole);
}

#[test]
fn frames_without_a_manifest_are_written_again() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    bake(f, &["--frames", "1-2"]);
    let whole = contents(f);
    std::fs::remove_file(f.join(MANIFEST)).unwrap();
    let stderr = resume(f, &[&BAKE[..], &["--frames", "1-2"]].concat());
    assert!(stderr.contains(&format!("{MANIFEST} does not exist")), "{stderr}");
    assert!(stderr.contains("hair.01.hair is made again"), "{stderr}");
    assert!(contents(f) == whole);
}

#[cfg(unix)]
/// A pipe would be replaced by a file, and whoever reads from it would wait for ever. It is reported before the
/// simulation, and no other frame is written.
#[test]
fn a_pipe_or_a_folder_in_the_place_of_a_frame_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    bake(f, &["--frames", "1-3"]);
    for number in [1, 2] {
        std::fs::remove_file(f.join(format!("hair.0{number}.hair"))).unwrap();
    }
    let whole = contents(f);
    let wrong = f.join("hair.02.hair");
    for (kind, make) in [("pipe", "mkfifo"), ("folder", "mkdir")] {
        assert!(std::process::Command::new(make).arg(&wrong).status().unwrap().success());
        for more in [&["--resume"][..], &[]] {
            let stderr = fail(f, &[&BAKE[..], &["--frames", "1-3"], more].concat(), 5);
            assert!(stderr.contains("hair.02.hair is a ") && stderr.contains(kind), "{stderr}");
            assert!(!stderr.contains("simulating") && !f.join("hair.01.hair").exists(), "{stderr}");
        }
        let _ = std::fs::remove_file(&wrong).or_else(|_| std::fs::remove_dir(&wrong));
    }
    assert!(contents(f) == whole, "something has changed");
    resume(f, &[&BAKE[..], &["--frames", "1-3"]].concat());
    assert_eq!(contents(f).len(), whole.len() + 2);
}

#[test]
fn ranges_of_one_bake_share_a_manifest() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_scene(f, 40);
    bake(f, &["--frames", "1-2"]);
    bake(f, &["--frames", "3-4"]);
    let report = bake(f, &["--frames", "1-5", "--resume"]);
    assert_eq!((&report["frames"], &report["skipped"]), (&1.into(), &4.into()));
    // A bake of another scene starts a new list and reports it.
    edit(&f.join("scene.toml"), "gust = 0.5", "gust = 0.6");
    let output = program(f, &[&BAKE[..], &["--frames", "1-2"]].concat()).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("is replaced: scene.toml has changed"), "{stderr}");
    let report = bake(f, &["--frames", "1-5", "--resume"]);
    assert_eq!((&report["frames"], &report["skipped"]), (&3.into(), &2.into()));
}

#[test]
fn pictures_resume_by_the_same_rules() {
    let folder = tempfile::tempdir().unwrap();
    let f = folder.path();
    write_groom(f, 60);
    let render = ["render", "groom.hair", "-o", "f.#.png", "--frames", "1-3", "--size", "64x36"];
    succeed(f, &render);
    assert_eq!(names(f), ["f.1.png", "f.2.png", "f.3.png", "f.render.png.json", "groom.hair"]);
    let whole = contents(f);
    let picture = std::fs::read(f.join("f.2.png")).unwrap();
    std::fs::write(f.join("f.2.png"), &picture[..picture.len() - 1]).unwrap();
    let stderr = resume(f, &render);
    assert!(stderr.contains("f.2.png is made again"), "{stderr}");
    assert!(contents(f) == whole);
    let other = [&render[..6], &["--size", "32x18", "--resume"]].concat();
    assert!(fail(f, &other, 2).contains("--size was 64x36 and is 32x18"));
    // The range of a turntable is no option of its own.
    let stderr = fail(f, &[&render[..], &["--turntable", "--resume"]].concat(), 2);
    assert!(stderr.contains("--turntable was the default and is over frames 1-3"), "{stderr}");
    assert!(!stderr.contains("--frames"), "{stderr}");
    assert!(contents(f) == whole);
    let stderr = fail(f, &["bake", "groom.hair", "-o", "x.hair", "--frames", "1", "--resume"], 2);
    assert!(stderr.contains("--resume needs numbered files"), "{stderr}");
}
