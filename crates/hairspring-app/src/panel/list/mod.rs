//! List entries: colliders, tools, wind sources, charged bodies, and the keys of a manual motion. Each entry
//! shows all fields from its text and its defaults. Every number has its unit, a tooltip and, if it was
//! changed, a reset button.

mod rows;

use crate::{
    key::Key,
    session::{Action, Session},
};
use eframe::egui::Ui;
use glam::Vec3;
use rows::Rows;
use toml_edit::{DocumentMut, TableLike, Value};

/// Optional fields of entries, by list. They are shown even if neither the text nor the defaults have them.
const MORE: [(&str, &[&str]); 5] = [
    ("collider", &["joint"]),
    ("sheet", &["joint"]),
    ("wind_source", &["joint"]),
    ("charged", &["joint"]),
    ("hand", &["joint", "until"]),
];

/// A list of the scene file, and the entries that can be added to it.
pub struct List {
    name: &'static str,
    label: &'static str,
    /// Label of one entry.
    one: &'static str,
    /// Name of each kind of entry, and the text of its fields.
    kinds: &'static [(&'static str, &'static str)],
}

/// Wind sources and charged bodies.
pub const AIR: [List; 2] = [
    List {
        name: "wind_source",
        label: "Wind sources",
        one: "Source",
        kinds: &[
            (
                "Fan",
                "shape.fan = { center = [-0.22, 1.5, 0.2], axis = [1.0, 0.0, -0.5], radius = 0.05, speed = 4.0 }",
            ),
            ("Point", "shape.point = { center = [0.22, 1.5, 0.0], radius = 0.05, speed = 2.0 }"),
            (
                "Vortex",
                "shape.vortex = { center = [0.0, 1.5, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.15, speed = 2.0 }",
            ),
        ],
    },
    List {
        name: "charged",
        label: "Charged bodies",
        one: "Charged body",
        kinds: &[("Balloon", "center = [0.2, 1.6, 0.0]\nradius = 0.06\ncharge = -2e-7")],
    },
];

/// Colliders, sheets and tools.
pub const COLLISION: [List; 3] = [
    List {
        name: "collider",
        label: "Colliders",
        one: "Collider",
        kinds: &[
            ("Sphere", "shape.sphere = { center = [0.18, 1.45, 0.1], radius = 0.05 }"),
            ("Capsule", "shape.capsule = { a = [-0.15, 1.4, 0.15], b = [0.15, 1.4, 0.15], radius = 0.02 }"),
            ("Box", "shape.box = { center = [0.0, 1.38, 0.15], size = [0.3, 0.02, 0.1] }"),
            ("Floor", "shape.plane = { point = [0.0, 1.32, 0.0], normal = [0.0, 1.0, 0.0] }"),
        ],
    },
    // A sheet is a file, so it cannot be added here.
    List { name: "sheet", label: "Sheets", one: "Sheet", kinds: &[] },
    List {
        name: "hand",
        label: "Hands",
        one: "Hand",
        kinds: &[
            ("Grab", "tool.grab = { center = [0.1, 1.42, 0.08], radius = 0.02 }"),
            ("Comb", "tool.comb = { a = [-0.1, 1.6, 0.15], b = [0.1, 1.6, 0.15], radius = 0.02 }"),
            (
                "Tie",
                "tool.tie = { center = [0.0, 1.5, -0.13], axis = [0.0, -0.3, -1.0], radius = 0.015, reach = 0.1 }",
            ),
        ],
    },
];

/// The camera target that the positions of the templates above refer to [m].
const LOOK: Vec3 = Vec3::new(0.0, 1.5, 0.0);

/// The text of an entry's fields with its positions moved by `by` [m], so that a new entry appears in the
/// view.
fn placed(fields: &str, by: Vec3) -> String {
    fn shift(table: &mut dyn TableLike, by: Vec3) {
        for (name, item) in table.iter_mut() {
            let place = ["center", "a", "b", "point"].contains(&name.get());
            match item.as_array_mut() {
                Some(list) if place => {
                    for (x, by) in list.iter_mut().zip(by.to_array()) {
                        let moved = x.as_float().unwrap_or(0.0) + f64::from(by);
                        let decor = x.decor().clone();
                        *x = Value::from((moved * 1e3).round() / 1e3);
                        *x.decor_mut() = decor;
                    }
                }
                _ => {
                    if let Some(inner) = item.as_table_like_mut() {
                        shift(inner, by);
                    }
                }
            }
        }
    }
    let Ok(mut document) = fields.parse::<DocumentMut>() else { return fields.to_owned() };
    shift(document.as_table_mut(), by);
    document.to_string()
}

/// Shows these lists. New entries are placed around `at` [m].
pub fn show(ui: &mut Ui, session: &Session, lists: &'static [List], at: Vec3, actions: &mut Vec<Action>) {
    let effective = session.edited().effective();
    for list in lists {
        let entries = effective.get(list.name).and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
        if entries.is_empty() && list.kinds.is_empty() {
            continue;
        }
        ui.horizontal(|ui| {
            ui.strong(list.label);
            if list.kinds.is_empty() {
                return;
            }
            ui.menu_button("Add", |ui| {
                for (name, fields) in list.kinds {
                    if ui.button(*name).clicked() {
                        actions.push(Action::Add(list.name, placed(fields, at - LOOK)));
                        ui.close();
                    }
                }
            });
        });
        for (place, entry) in entries.iter().enumerate() {
            ui.indent((list.name, place), |ui| {
                ui.horizontal(|ui| {
                    let kind = kind(entry).map(|kind| format!(": {kind}")).unwrap_or_default();
                    ui.label(format!("{} {}{kind}", list.one, place + 1));
                    if ui.small_button("Remove").clicked() {
                        actions.push(Action::Remove(list.name, place));
                    }
                });
                let mut rows = Rows { session, list: list.name, actions };
                let key = Key::top(list.name).place(place);
                rows.fields(ui, &key, entry);
                let more = MORE.iter().find(|more| more.0 == list.name).map_or(&[][..], |more| more.1);
                for name in more.iter().filter(|name| entry.get(**name).is_none()) {
                    rows.field(ui, &key.entry(name), name, None);
                }
            });
        }
    }
}

/// Shows the motion: its keys, or the file that it comes from.
pub fn motion(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let clip = session.edited().effective().get("clip");
    let key = Key::top("clip");
    let mut rows = Rows { session, list: "clip", actions };
    if let Some(file) = clip.and_then(|clip| clip.get("file")).and_then(toml::Value::as_str) {
        ui.weak(format!("from {file}"));
        if let Some(pivot) = clip.and_then(|clip| clip.get("pivot")) {
            rows.field(ui, &key.entry("pivot"), "pivot", Some(pivot));
        }
        return;
    }
    let keys = clip.and_then(|clip| clip.get("keys"));
    rows.field(ui, &key.entry("keys"), "keys", keys);
    if keys.is_some() {
        let zero = toml::Value::from(vec![0.0; 3]);
        let pivot = clip.and_then(|clip| clip.get("pivot")).unwrap_or(&zero);
        rows.field(ui, &key.entry("pivot"), "pivot", Some(pivot));
    }
    ui.weak("Keys replace the scene's own motion. Each change restarts the scene.");
}

/// The kind of a collider or tool, if the entry has one.
fn kind(entry: &toml::Value) -> Option<&str> {
    let shape = entry.get("shape").or_else(|| entry.get("tool"))?;
    shape.as_table()?.keys().next().map(String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;
    use egui_kittest::{Harness, kittest::Queryable};
    use std::{cell::RefCell, rc::Rc};

    const SCENE: &str = "[builtin]\nstrands = 10\nguides = 5\n\n[[hand]]\ntool.grab = { center = [0.1, 1.3, 0.1], radius = 0.02 }\n\n\
        [[charged]]\ncenter = [0.3, 1.8, 0.0]\nradius = 0.13\ncharge = -2e-7\n";

    /// The lists of a scene, and the session that records the actions.
    fn panel(text: &str) -> (Harness<'static>, Rc<RefCell<Session>>) {
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let session = Rc::new(RefCell::new(Session::new(document, 1, None, || ()).unwrap()));
        let shown = session.clone();
        let harness = Harness::builder().with_size([500.0, 1600.0]).build_ui(move |ui| {
            let mut actions = Vec::new();
            {
                let session = shown.borrow();
                show(ui, &session, &AIR, LOOK, &mut actions);
                show(ui, &session, &COLLISION, LOOK, &mut actions);
                motion(ui, &session, &mut actions);
            }
            actions.into_iter().for_each(|action| shown.borrow_mut().act(action).unwrap());
        });
        (harness, session)
    }

    fn press(harness: &mut Harness<'static>, label: &str, which: usize) {
        harness.get_all_by_label(label).nth(which).unwrap().click();
        harness.run_steps(3);
    }

    #[test]
    fn buttons_add_and_remove_keys_and_undo_restores_the_text() {
        let (mut harness, session) = panel(SCENE);
        let contains = |text: &str| session.borrow().document().text().contains(text);
        // In the order of the panel: those of the charged body, of the tool and of the motion.
        press(&mut harness, "Add a key", 0);
        assert!(
            contains("path = [{ time = 1.0, center = [0.3, 1.8, 0.0] }]"),
            "{}",
            session.borrow().document().text()
        );
        press(&mut harness, "+", 0);
        assert!(contains("{ time = 1.5, center = [0.3, 1.8, 0.0] }"));
        press(&mut harness, "Add a key", 0);
        assert!(contains("path = [[0.0, 0.0, 0.0, 0.0]]"));
        press(&mut harness, "Add a key", 0);
        assert!(contains("keys = [{ time = 0.0, position = [0.0, 0.0, 0.0], rotation = [0.0, 0.0, 0.0] }]"));
        press(&mut harness, "-", 0);
        press(&mut harness, "-", 0);
        assert!(!contains("time = 1"), "{}", session.borrow().document().text());
        for _ in 0..6 {
            session.borrow_mut().act(Action::Undo).unwrap();
        }
        assert_eq!(session.borrow().document().text(), SCENE);
    }

    #[test]
    fn added_entries_are_placed_at_the_center_of_the_view() {
        let text =
            placed("shape.sphere = { center = [0.0, 1.3, 0.25], radius = 0.08 }", Vec3::new(0.1, -0.5, 0.0));
        assert_eq!(text.trim(), "shape.sphere = { center = [0.1, 0.8, 0.25], radius = 0.08 }");
        for list in AIR.iter().chain(&COLLISION) {
            for (name, fields) in list.kinds {
                let (_, session) = panel(SCENE);
                let added = session.borrow_mut().act(Action::Add(list.name, placed(fields, Vec3::X)));
                assert!(added.is_ok(), "{name}: {added:?}");
            }
        }
    }

    #[test]
    fn optional_fields_can_be_switched_on_and_off() {
        let (mut harness, session) = panel(SCENE);
        let contains = |text: &str| session.borrow().document().text().contains(text);
        press(&mut harness, "never", 0);
        assert!(contains("until = 2.0"));
        press(&mut harness, "never", 0);
        assert!(!contains("until"));
    }

    #[test]
    fn reset_of_a_list_entry_survives_changes_of_its_index() {
        let scene =
            format!("{SCENE}\n[[charged]]\ncenter = [-0.3, 1.8, 0.0]\nradius = 0.14\ncharge = 2e-7\n");
        let (mut harness, session) = panel(&scene);
        let resets = |harness: &Harness| harness.query_all_by_label("reset").count();
        let text = || session.borrow().document().text().to_owned();
        let act = |action| session.borrow_mut().act(action).unwrap();
        harness.run_steps(3);
        assert_eq!(resets(&harness), 0, "just opened");
        act(Action::Set("charged[1].radius".parse().unwrap(), Some(0.2.into())));
        harness.run_steps(3);
        assert_eq!(resets(&harness), 1);
        // The entry before it is removed, and one is appended.
        act(Action::Remove("charged", 0));
        act(Action::Add("charged", "center = [0.0, 2.0, 0.0]\nradius = 0.3\ncharge = 1e-7\n".into()));
        harness.run_steps(3);
        assert_eq!(resets(&harness), 1, "what was added has nothing to go back to");
        press(&mut harness, "reset", 0);
        assert!(text().contains("radius = 0.14") && !text().contains("radius = 0.2"), "{}", text());
        assert_eq!(resets(&harness), 0);
        for _ in 0..4 {
            act(Action::Undo);
        }
        assert_eq!(text(), scene);
        // Writing the value that already applies is not a change.
        act(Action::Set("charged[0].solid".parse().unwrap(), Some(true.into())));
        harness.run_steps(3);
        assert_eq!(resets(&harness), 0);
    }
}
