//! Promise: the window bakes what the library plays, bit for bit, also with changes that are not saved. It
//! exports the current frame, and records at any size and rate. A bake that is stopped leaves complete files. Its
//! manifest is that of `hairspring bake`, which resumes it.

mod support;

use egui_kittest::kittest::Queryable;
use glam::Vec3;
use hairspring_io::{Inputs, Manifest, Origin, ReadOptions, read_groom, read_scene_text};
use hairspring_scene::stage::{FrameRate, Stage};
use hairspring_test::farthest;
use hairspring_view::sequence_path;
use std::path::Path;
use support::{SMALL, until, window};

fn points(path: &Path) -> Vec<Vec3> {
    read_groom(path, &ReadOptions { scale: Some(1.0), up: None }).unwrap().value.points
}

/// The frames of `frames` that a bake of this scene would still make, according to the manifest of `pattern`.
fn unfinished(pattern: &Path, frames: &[u32], (scene, text): (&Path, &str), fps: &str) -> Vec<u32> {
    let (_, inputs) = Inputs::record_text(scene, text, || read_scene_text(scene, text).unwrap());
    let origin = Origin::new("bake", &[("fps", Some(fps.into()))], inputs);
    let (manifest, note) = Manifest::begin(pattern, origin, true).unwrap();
    assert_eq!(note, None);
    manifest.unfinished(frames, |frame| sequence_path(pattern, frame).unwrap()).0
}

#[test]
fn a_bake_includes_unsaved_changes_and_matches_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let script = format!(
        "pause\nset gravity [0.0, -3.0, 0.0]\nrate 24\nbake {} 4\nreset\nwait 7\nexport {}\n",
        file("hair.##.hair").display(),
        file("now.data").display()
    );
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    assert_eq!(window.state().message().filter(|(_, wrong)| *wrong), None);
    let text = window.state().session().document().text().to_owned();
    let stage = || Stage::new(read_scene_text("scene.toml".as_ref(), &text).unwrap().value).unwrap();
    let all = |stage: &Stage| stage.strands().flat_map(|s| s.points.to_vec()).collect::<Vec<_>>();
    let mut played = stage();
    for frame in 1..=4 {
        if frame > 1 {
            played.step_frame(FrameRate::new(24, 1).unwrap());
        }
        let baked = points(&file(&format!("hair.{frame:02}.hair")));
        assert!(baked == all(&played), "frame {frame} differs by {} m", farthest(&baked, &all(&played)));
    }
    assert!(!file("hair.05.hair").exists());
    let scene = file("scene.toml");
    let left = unfinished(&file("hair.##.hair"), &[1, 2, 3, 4, 5], (&scene, &text), "24");
    assert_eq!(left, [5]);
    let mut now = stage();
    (0..7).for_each(|_| _ = now.step_frame(FrameRate::new(60, 1).unwrap()));
    assert!(farthest(&points(&file("now.data")), &all(&now)) < 1e-6);
}

#[test]
fn a_stopped_bake_leaves_complete_files() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = folder.path().join("hair.####.hair");
    let script = format!("pause\nwait 1\nbake {} 100000", pattern.display());
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |_| folder.path().join("hair.0003.hair").exists()));
    window.step();
    window.get_by_label("Stop").click();
    assert!(until(&mut window, |app| app.is_idle()));
    let (message, wrong) = window.state().message().unwrap();
    assert!(message.contains("stopped after") && !wrong, "{message}");
    let files = std::fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().path());
    let files: Vec<_> = files.filter(|path| path.extension().unwrap() == "hair").collect();
    let (scene, text) = (folder.path().join("scene.toml"), window.state().session().document().text());
    let frames: Vec<u32> = (1..=files.len() as u32 + 1).collect();
    assert_eq!(unfinished(&pattern, &frames, (&scene, text), "30"), [files.len() as u32 + 1]);
    assert!(files.len() >= 3 && files.len() < 100_000);
    let first = points(&folder.path().join("hair.0001.hair")).len();
    assert!(files.iter().all(|file| points(file).len() == first), "a file is not complete");
}

#[test]
fn bakes_and_exports_that_cannot_be_written_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (line, word) in [
        ("bake hair.hair 5", "####"),
        ("bake no/hair.##.hair 5", "no"),
        ("bake hair.##.png 5", ".tfx"),
        ("export hair.png", ".tfx"),
        ("still a.##.png", "leave out the # signs"),
        ("export a.##.hair", "leave out the # signs"),
    ] {
        let mut window = window(folder.path(), SMALL, &format!("pause\nwait 1\n{line}"));
        assert!(until(&mut window, |app| app.is_idle()));
        let (message, wrong) = window.state().message().expect("there is no message");
        assert!(wrong && message.contains(word), "{line}: {message}");
        assert_eq!(window.state().script_errors(), 1, "{line}");
    }
}

#[test]
fn files_of_the_scene_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let groom = folder.path().join("few.hair");
    let mut first = window(folder.path(), SMALL, &format!("pause\nexport {}", groom.display()));
    assert!(until(&mut first, |app| app.is_idle()) && groom.exists());
    drop(first);
    let before = std::fs::read(&groom).unwrap();
    let scene = "[[groom]]\nfile = \"few.hair\"\nguides = 60\n";
    for line in ["export", "bake"] {
        let frames = if line == "bake" { " 1" } else { "" };
        for side in ["", "compare on\n", "compare on\nsecond off\n"] {
            let script = format!("pause\nwait 1\n{side}{line} {}{frames}", groom.display());
            let mut window = window(folder.path(), scene, &script);
            assert!(until(&mut window, |app| app.is_idle()));
            let (message, wrong) = window.state().message().expect("there is no message");
            assert!(wrong && message.contains("few.hair is an input file"), "{line}: {message}");
            assert_eq!(window.state().script_errors(), 1, "{line}");
        }
    }
    assert_eq!(std::fs::read(&groom).unwrap(), before, "the groom was replaced");
}

#[test]
fn recordings_have_the_size_and_the_rate_that_were_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let script = format!(
        "pause\nreset\nwait 1\nsize 200 120\nrate 24\npictures {} 0.25\nsize 96 64\nstill {}\n",
        file("p.##.png").display(),
        file("s.png").display()
    );
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    for (name, size) in [("p.01.png", (200, 120)), ("p.06.png", (200, 120)), ("s.png", (96, 64))] {
        let image = hairspring_view::read_png(&file(name)).unwrap();
        assert_eq!((image.width, image.height), size, "{name}");
    }
    assert!(!file("p.07.png").exists());
    // Frame 6 is 5/24 s after frame 1, which is at 1/60 s.
    let time = window.state().session().latest().unwrap().time;
    assert!((time - 1.0 / 60.0 - 5.0 / 24.0).abs() < 1e-6, "{time}");
}
