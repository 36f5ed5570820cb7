//! Promise: no change is lost without a question. A user who opens another scene or closes the window while
//! the scene has unsaved changes is asked to save, not to save, or to cancel. The same holds for the right scene of a
//! comparison, and for changes that another program made to the file.

mod support;

use egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::{Harness, kittest::Queryable};
use hairspring_app::App;
use std::{path::Path, sync::Arc};
use support::{Dropped, SMALL, until, window};

const CHANGED: &str = "pause\nset gravity [0.0, -1.0, 0.0]\nwait 1";

/// A window on a scene with a change that is saved or not, and another scene in its folder.
fn changed(folder: &Path, saved: bool) -> Harness<'static, App> {
    std::fs::write(folder.join("other.toml"), SMALL.replace("Small", "Other")).unwrap();
    let file = folder.join("own.toml").display().to_string();
    let script =
        format!("save {file}\n{CHANGED}{}", if saved { format!("\nsave {file}") } else { String::new() });
    let mut window = window(folder, SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    window
}

fn press(window: &mut Harness<'static, App>, button: &str) {
    window.get_by_label(button).click();
    (0..3).for_each(|_| window.step());
}

fn drop_other(window: &mut Harness<'static, App>, folder: &Path) {
    window.input_mut().dropped_files.push(Arc::new(Dropped(folder.join("other.toml"))));
    (0..3).for_each(|_| window.step());
}

fn name(window: &Harness<'static, App>) -> String {
    window.state().session().document().settings().name.clone()
}

/// Asks the window to close; returns whether it does.
fn closes(window: &mut Harness<'static, App>) -> bool {
    window.input_mut().viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
    window.step();
    let held = !commands(window).contains(&ViewportCommand::CancelClose);
    window.input_mut().viewports.entry(ViewportId::ROOT).or_default().events.clear();
    held
}

fn commands(window: &Harness<'static, App>) -> Vec<ViewportCommand> {
    window.output().viewport_output.values().flat_map(|v| v.commands.clone()).collect()
}

#[test]
fn opening_another_scene_asks_first_and_follows_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let own = || std::fs::read_to_string(folder.path().join("own.toml")).unwrap();
    for (answer, after, saved) in
        [("Cancel", "Small", false), ("Don't save", "Other", false), ("Save", "Other", true)]
    {
        let mut window = changed(folder.path(), false);
        drop_other(&mut window, folder.path());
        assert_eq!(name(&window), "Small", "the scene was left without a question");
        assert!(window.query_by_label("Save the changes to own.toml?").is_some());
        press(&mut window, answer);
        assert_eq!((name(&window).as_str(), own().contains("gravity")), (after, saved), "{answer}");
        assert!(window.query_by_label("Don't save").is_none(), "the question is still there");
    }
}

#[test]
fn a_saved_scene_is_left_without_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = changed(folder.path(), true);
    drop_other(&mut window, folder.path());
    assert_eq!(name(&window), "Other");
    assert!(closes(&mut window));
}

#[test]
fn closing_the_window_asks_first_and_follows_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    for (answer, closed) in [("Cancel", false), ("Don't save", true), ("Save", true)] {
        let mut window = changed(folder.path(), false);
        assert!(!closes(&mut window), "the window closed without a question");
        window.step();
        window.get_by_label(answer).click();
        let closing = (0..4).any(|_| {
            window.step();
            commands(&window).contains(&ViewportCommand::Close)
        });
        assert_eq!(closing, closed, "{answer}");
        assert_eq!(closes(&mut window), closed, "{answer}: the next close");
    }
    assert!(std::fs::read_to_string(folder.path().join("own.toml")).unwrap().contains("gravity"));
}

#[test]
fn a_scene_without_a_file_is_named_before_it_is_left() {
    let folder = tempfile::tempdir().unwrap();
    std::env::set_current_dir(folder.path()).unwrap();
    std::fs::write(folder.path().join("other.toml"), SMALL.replace("Small", "Other")).unwrap();
    let mut window = window(folder.path(), SMALL, CHANGED);
    assert!(until(&mut window, |app| app.is_idle()));
    drop_other(&mut window, folder.path());
    press(&mut window, "Save");
    assert_eq!(name(&window), "Small", "the file has no name yet");
    press(&mut window, "Write it");
    assert_eq!(name(&window), "Other");
    assert!(std::fs::read_to_string("scene.toml").unwrap().contains("gravity"));
}

/// A window that compares two scenes, of which only the right one is changed.
fn compared(folder: &Path) -> Harness<'static, App> {
    let script = format!(
        "save {}\npause\ncompare on\nset gravity [0.0, -1.0, 0.0]\nwait 1",
        folder.join("own.toml").display()
    );
    let mut window = window(folder, SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    window
}

#[test]
fn the_right_scene_of_a_comparison_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    for (answer, ended) in [("Cancel", false), ("Don't save", true)] {
        let mut window = compared(folder.path());
        window.key_press(Key::C);
        (0..3).for_each(|_| window.step());
        assert!(window.query_by_label("Save the changes to Small (right)?").is_some());
        press(&mut window, answer);
        assert_eq!(window.state().session().second().is_none(), ended, "{answer}");
    }
    let mut window = compared(folder.path());
    assert!(!closes(&mut window), "the window closed without a question");
    window.step();
    press(&mut window, "Don't save");
    assert!(closes(&mut window));
    assert_eq!(std::fs::read_to_string(folder.path().join("own.toml")).unwrap(), SMALL);
}

#[test]
fn both_scenes_of_a_comparison_are_asked_about_one_after_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("own.toml");
    let script = format!(
        "save {}\npause\ncompare on\nset gravity [0.0, -1.0, 0.0]\nsecond off\nset gravity [0.0, -2.0, 0.0]\nwait 1",
        own.display()
    );
    let mut window = window(folder.path(), SMALL, &script);
    assert!(until(&mut window, |app| app.is_idle()));
    std::fs::write(folder.path().join("other.toml"), SMALL.replace("Small", "Other")).unwrap();
    drop_other(&mut window, folder.path());
    assert!(window.query_by_label("Save the changes to own.toml?").is_some());
    press(&mut window, "Save");
    assert!(std::fs::read_to_string(&own).unwrap().contains("-2.0"));
    assert!(window.query_by_label("Save the changes to Small (right)?").is_some());
    press(&mut window, "Don't save");
    assert_eq!(name(&window), "Other");
}

#[test]
fn a_file_that_another_program_changed_is_replaced_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("own.toml");
    let mut window = changed(folder.path(), false);
    std::fs::write(&own, "# theirs\n").unwrap();
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    (0..5).for_each(|_| window.step());
    assert_eq!(std::fs::read_to_string(&own).unwrap(), "# theirs\n", "it was replaced without a question");
    press(&mut window, "Replace it");
    assert!(std::fs::read_to_string(&own).unwrap().contains("gravity"));
    assert!(!window.state().session().document().is_changed());
}
