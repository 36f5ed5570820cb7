//! Promise: a file can be chosen without a desktop's dialog: the window lists the files that it opens, in any
//! folder.

mod support;

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::sync::{Mutex, PoisonError};
use support::{SMALL, until, window};

/// The window starts in the current folder, which all tests share.
static CURRENT: Mutex<()> = Mutex::new(());

#[test]
fn a_scene_in_another_folder_is_opened_by_clicks() {
    let _current = CURRENT.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("shots");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(inner.join("other.toml"), SMALL.replace("Small", "Other")).unwrap();
    std::fs::write(inner.join("avatar.vrm"), "").unwrap();
    std::fs::write(inner.join("notes.txt"), "").unwrap();
    std::env::set_current_dir(folder.path()).unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nwait 1");
    assert!(until(&mut window, |app| app.is_idle()));
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    (0..3).for_each(|_| window.step());
    for name in ["shots/", "other.toml", "Open it"] {
        if name == "other.toml" {
            assert!(
                window.query_by_label("avatar.vrm").is_some() && window.query_by_label("notes.txt").is_none()
            );
        }
        window.get_by_label(name).click();
        (0..3).for_each(|_| window.step());
    }
    assert_eq!(window.state().session().document().settings().name, "Other");
}

#[test]
fn only_the_replace_button_replaces_an_existing_file() {
    let _current = CURRENT.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().unwrap();
    let groom = folder.path().join("old.hair");
    std::fs::write(&groom, "old").unwrap();
    std::env::set_current_dir(folder.path()).unwrap();
    let mut window = window(folder.path(), SMALL, "pause\nwait 1");
    assert!(until(&mut window, |app| app.is_idle()));
    for name in ["File", "Export hair…"] {
        window.get_by_label(name).click();
        (0..3).for_each(|_| window.step());
    }
    assert!(window.query_by_label("Write it").is_some());
    // A double click immediately opens a file, or writes one that does not exist yet.
    for _ in 0..2 {
        window.get_by_label("old.hair").click();
        (0..2).for_each(|_| window.step());
    }
    assert!(window.query_by_label("Write it").is_none() && std::fs::read(&groom).unwrap() == b"old");
    window.get_by_label("Replace it").click();
    (0..3).for_each(|_| window.step());
    assert!(std::fs::read(&groom).unwrap().len() > 1000);
}
