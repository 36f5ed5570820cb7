//! Promise: unsaved changes survive a crash. While a scene has unsaved changes, a file keeps them. The next
//! start offers them, and a recovered scene is saved where it belongs. A window that its user closes leaves
//! no file.

mod support;

use egui_kittest::{Harness, kittest::Queryable};
use hairspring_app::App;
use std::path::{Path, PathBuf};
use support::{SMALL, until, window_with};

fn files(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).map(|all| all.map(|f| f.unwrap().path()).collect()).unwrap_or_default()
}

fn kept(folder: &Path) -> bool {
    files(folder).iter().any(|f| std::fs::read_to_string(f).is_ok_and(|text| text.contains("gravity")))
}

/// A folder with the files that a window leaves that crashes with a changed scene.
fn crash(folder: &Path) -> PathBuf {
    let [running, left] = ["running", "left"].map(|name| folder.join(name));
    let script =
        format!("pause\nsave {}\nset gravity [0.0, -1.0, 0.0]\nwait 1", folder.join("own.toml").display());
    let mut window = window_with(folder, SMALL, &script, Some(running.clone()));
    assert!(until(&mut window, |app| app.is_idle() && kept(&running)), "the changes are not kept");
    // The files at this moment are what a crash leaves; nothing holds their lock.
    std::fs::create_dir(&left).unwrap();
    for file in files(&running) {
        std::fs::copy(&file, left.join(file.file_name().unwrap())).unwrap();
    }
    let other = window_with(folder, SMALL, "", Some(running.clone()));
    assert!(other.query_by_label("Recover").is_none(), "the scene of a running window is offered");
    drop((window, other));
    assert_eq!(files(&running), [""; 0].map(PathBuf::from), "a closed window leaves files");
    left
}

fn press(window: &mut Harness<'static, App>, button: &str) {
    // A dialog takes a few frames to find its size.
    (0..100).find(|_| {
        window.step();
        window.query_by_label(button).is_some()
    });
    window.get_by_label(button).click();
    (0..3).for_each(|_| window.step());
}

#[test]
fn changes_are_offered_after_a_crash_and_recovered() {
    let folder = tempfile::tempdir().unwrap();
    let left = crash(folder.path());
    let open = || window_with(folder.path(), SMALL, "", Some(left.clone()));
    let mut window = open();
    press(&mut window, "Later");
    assert!(window.query_by_label("Recover").is_none() && kept(&left));
    drop(window);
    let mut window = open();
    press(&mut window, "Recover");
    let document = window.state().session().document();
    assert!(document.text().contains("gravity") && document.is_changed());
    assert_eq!(document.file(), Some(&*folder.path().canonicalize().unwrap().join("own.toml")));
    assert!(until(&mut window, |_| kept(&left)), "the recovered changes are not kept");
    drop(window);
    assert!(!kept(&left), "what was recovered is offered again");
}

#[test]
fn discarded_changes_are_not_offered_again() {
    let folder = tempfile::tempdir().unwrap();
    let left = crash(folder.path());
    let mut window = window_with(folder.path(), SMALL, "", Some(left.clone()));
    press(&mut window, "Discard");
    assert!(!kept(&left) && window.query_by_label("Discard").is_none());
    assert_eq!(window.state().session().document().text(), SMALL);
}

#[test]
fn changes_of_the_right_scene_of_a_comparison_are_kept_too() {
    let folder = tempfile::tempdir().unwrap();
    let running = folder.path().join("running");
    let script = "pause\ncompare on\nset gravity [0.0, -1.0, 0.0]\nwait 1";
    let mut window = window_with(folder.path(), SMALL, script, Some(running.clone()));
    assert!(until(&mut window, |app| app.is_idle() && kept(&running)), "the changes are not kept");
    drop(window);
    assert_eq!(files(&running), [""; 0].map(PathBuf::from), "a closed window leaves files");
}
