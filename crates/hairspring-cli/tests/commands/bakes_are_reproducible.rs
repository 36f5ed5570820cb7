//! Promise: a bake gives the same bits on one thread or two, in one run, resumed after frames went missing,
//! or stopped by Ctrl-C and resumed.
//!
//! A render farm bakes a shot on any free machine and restarts after a crash. A frame that differs by one
//! bit from the next flickers. Every frame's file is compared byte for byte with that of an uninterrupted
//! run.

use crate::common::{contents, json, names, succeed, write_scene};
use std::path::Path;

/// Bakes frames 1 to 12 into `folder`/`name`, with additional arguments.
fn bake(folder: &Path, name: &str, more: &[&str]) -> Vec<(String, Vec<u8>)> {
    std::fs::create_dir_all(folder.join(name)).unwrap();
    let pattern = format!("{name}/hair.###.hair");
    let arguments = [&["bake", "scene.toml", "-o", &pattern, "--frames", "1-12"], more].concat();
    succeed(folder, &arguments);
    contents(&folder.join(name))
}

#[test]
fn on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 400);
    let one = bake(folder.path(), "one", &["--threads", "1"]);
    let two = bake(folder.path(), "two", &["--threads", "2"]);
    // Twelve frames and their manifest, which does not depend on the number of threads either.
    assert_eq!(one.len(), 13);
    assert_eq!((&*one[0].0, &*one[12].0), ("hair.001.hair", "hair.bake.hair.json"));
    assert!(one[0].1 != one[11].1, "nothing moved");
    assert!(one == two);
}

#[test]
fn resumed_over_missing_and_broken_frames() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 200);
    let whole = bake(folder.path(), "bake", &[]);
    let at = |n: u32| folder.path().join(format!("bake/hair.{n:03}.hair"));
    for n in [3, 7, 12] {
        std::fs::remove_file(at(n)).unwrap();
    }
    // A truncated file, as a crash of the file system may leave. A crash of the program leaves none.
    std::fs::write(at(9), &whole[8].1[..500]).unwrap();
    let untouched = std::fs::metadata(at(5)).unwrap().modified().unwrap();
    let resumed = bake(folder.path(), "bake", &["--resume"]);
    assert!(resumed == whole);
    assert_eq!(
        std::fs::metadata(at(5)).unwrap().modified().unwrap(),
        untouched,
        "a complete frame was written again"
    );
}

#[test]
fn part_of_a_range_equals_the_full_bake() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 50);
    let whole = bake(folder.path(), "whole", &[]);
    std::fs::create_dir(folder.path().join("part")).unwrap();
    succeed(folder.path(), &["bake", "scene.toml", "-o", "part/hair.###.hair", "--frames", "8-9"]);
    assert!(contents(&folder.path().join("part"))[..2] == whole[7..9]);
}

#[test]
fn a_bake_with_samples_counts_frames_and_samples() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 50);
    let bake = ["bake", "scene.toml", "-o", "hair.pc2", "--frames", "1-3", "--samples", "2"];
    let report = json(&succeed(folder.path(), &[&bake[..], &["--json"]].concat()));
    let counts = ["frames", "samples", "skipped"].map(|key| report[key].as_u64());
    assert_eq!(counts, [Some(3), Some(5), Some(0)]);
    let lines = succeed(folder.path(), &bake);
    assert!(lines.contains("hair.pc2 (3 frames; 5 samples)"), "{lines}");
}

#[test]
fn one_file_of_strands_leaves_files_of_the_user_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 50);
    let bake = ["bake", "scene.toml", "-o", "hair.pc2", "--frames", "1-3", "--checkpoint", "1"];
    succeed(folder.path(), &bake);
    assert!(!folder.path().join("hair.pc2.frames").exists());
    std::fs::create_dir(folder.path().join("hair.pc2.frames")).unwrap();
    std::fs::write(folder.path().join("hair.pc2.frames/notes.txt"), "mine").unwrap();
    succeed(folder.path(), &bake);
    assert_eq!(names(&folder.path().join("hair.pc2.frames")), ["notes.txt"]);
}

#[cfg(unix)]
#[test]
fn stopped_by_ctrl_c_and_resumed() {
    use std::{process::Command, process::Stdio, time::Duration};
    let folder = tempfile::tempdir().unwrap();
    write_scene(folder.path(), 200);
    let whole = bake(folder.path(), "whole", &[]);
    let stopped = folder.path().join("stopped");
    std::fs::create_dir(&stopped).unwrap();
    // More frames than can be baked before the signal arrives.
    let arguments = ["bake", "scene.toml", "-o", "stopped/hair.###.hair", "--frames", "1-900000"];
    let child = crate::common::program(folder.path(), &arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while !stopped.join("hair.002.hair").exists() {
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("--resume"), "{stderr}");
    let written = names(&stopped);
    assert!(written.iter().all(|n| n.starts_with("hair.")), "{written:?}");
    // All written frames are complete, including the last.
    let frame = |name: &String| name.strip_prefix("hair.")?.strip_suffix(".hair")?.parse::<u32>().ok();
    for name in written.iter().filter(|name| frame(name).is_some_and(|n| n > 12)) {
        std::fs::remove_file(stopped.join(name)).unwrap();
    }
    let frames = |folder: &Path| -> Vec<_> {
        contents(folder).into_iter().filter(|(name, _)| frame(name).is_some()).collect()
    };
    assert!(frames(&stopped).iter().all(|file| whole.contains(file)));
    bake(folder.path(), "stopped", &["--resume"]);
    assert!(frames(&stopped)[..] == whole[..12]);
}
