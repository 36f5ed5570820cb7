//! Entries of lists: colliders, hands, sources of wind, charged bodies. Each is shown with all that its text or its defaults say of it.

use crate::{
    key::Key,
    session::{Action, Session},
};
use eframe::egui::{self, DragValue, Ui};
use toml_edit::Value;

/// A list of the scene file, and what can be added to it.
pub struct List {
    name: &'static str,
    label: &'static str,
    /// Name of each kind of entry and the text of its fields.
    kinds: &'static [(&'static str, &'static str)],
}

/// What blows and charges.
pub const AIR: [List; 2] = [
    List {
        name: "wind_source",
        label: "Sources of wind",
        kinds: &[
            (
                "Fan",
                "shape.fan = { center = [0.0, 1.55, 0.8], axis = [0.0, 0.0, -1.0], radius = 0.15, speed = 4.0 }",
            ),
            ("Point", "shape.point = { center = [0.3, 1.5, 0.0], radius = 0.05, speed = 2.0 }"),
            (
                "Vortex",
                "shape.vortex = { center = [0.0, 1.5, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.2, speed = 2.0 }",
            ),
        ],
    },
    List {
        name: "charged",
        label: "Charged bodies",
        kinds: &[("Balloon", "center = [0.3, 1.8, 0.0]\nradius = 0.13\ncharge = -2e-7")],
    },
];

/// What hair meets and what holds it.
pub const COLLISION: [List; 2] = [
    List {
        name: "collider",
        label: "Colliders",
        kinds: &[
            ("Sphere", "shape.sphere = { center = [0.0, 1.3, 0.25], radius = 0.08 }"),
            ("Capsule", "shape.capsule = { a = [-0.2, 1.35, 0.15], b = [0.2, 1.35, 0.15], radius = 0.03 }"),
            ("Box", "shape.box = { center = [0.0, 1.2, 0.3], size = [0.4, 0.02, 0.2] }"),
            ("Floor", "shape.plane = { point = [0.0, 1.2, 0.0], normal = [0.0, 1.0, 0.0] }"),
        ],
    },
    List {
        name: "hand",
        label: "Hands",
        kinds: &[
            ("Grab", "tool.grab = { center = [0.1, 1.35, 0.1], radius = 0.02 }"),
            ("Comb", "tool.comb = { a = [-0.1, 1.6, 0.15], b = [0.1, 1.6, 0.15], radius = 0.02 }"),
            (
                "Tie",
                "tool.tie = { center = [0.0, 1.5, -0.13], axis = [0.0, -0.3, -1.0], radius = 0.015, reach = 0.1 }",
            ),
        ],
    },
];

/// Shows these lists.
pub fn show(ui: &mut Ui, session: &Session, lists: &'static [List], actions: &mut Vec<Action>) {
    let effective = session.edited().effective();
    for list in lists {
        ui.horizontal(|ui| {
            ui.label(list.label);
            ui.menu_button("Add", |ui| {
                for (name, fields) in list.kinds {
                    if ui.button(*name).clicked() {
                        actions.push(Action::Add(list.name, (*fields).to_owned()));
                        ui.close();
                    }
                }
            });
        });
        let Some(entries) = effective.get(list.name).and_then(toml::Value::as_array) else { continue };
        for (place, entry) in entries.iter().enumerate() {
            ui.indent((list.name, place), |ui| {
                ui.horizontal(|ui| {
                    ui.label(format!("{} {}", list.label, place + 1));
                    if ui.small_button("Remove").clicked() {
                        actions.push(Action::Remove(list.name, place));
                    }
                });
                let key = Key::top(list.name).place(place);
                fields(ui, &key, entry, actions);
            });
        }
    }
}

/// The fields of a table; a table in it is shown by its fields in turn.
fn fields(ui: &mut Ui, key: &Key, value: &toml::Value, actions: &mut Vec<Action>) {
    let Some(table) = value.as_table() else { return };
    for (name, value) in table {
        let key = key.entry(name);
        if value.is_table() {
            ui.weak(name);
            fields(ui, &key, value, actions);
            continue;
        }
        ui.horizontal(|ui| {
            ui.add_sized([70.0, 18.0], egui::Label::new(name).truncate());
            if let Some(new) = field(ui, value) {
                actions.push(Action::Set(key.clone(), Some(new)));
            }
        });
    }
}

/// A field, and its new value where it was changed. What lies in range is known to the reader of the file, which refuses the rest.
fn field(ui: &mut Ui, value: &toml::Value) -> Option<Value> {
    match value {
        toml::Value::Float(x) => number(ui, *x).map(Value::from),
        toml::Value::Integer(i) => {
            let mut i = *i;
            ui.add(DragValue::new(&mut i)).changed().then(|| i.into())
        }
        toml::Value::Boolean(on) => {
            let mut on = *on;
            ui.checkbox(&mut on, "").changed().then(|| on.into())
        }
        toml::Value::Array(list) if list.iter().all(|x| x.is_float() || x.is_integer()) => {
            let mut changed = false;
            let mut out = Vec::with_capacity(list.len());
            for x in list {
                let x = x.as_float().or(x.as_integer().map(|i| i as f64)).unwrap_or(0.0);
                let new = number(ui, x);
                changed |= new.is_some();
                out.push(new.unwrap_or(x));
            }
            changed.then(|| Value::from_iter(out))
        }
        toml::Value::String(text) => {
            ui.label(text);
            None
        }
        other => {
            // Paths of keys are lists of lists: the file is the place to write them.
            ui.weak(format!("{} entries, see the text", other.as_array().map_or(0, Vec::len)));
            None
        }
    }
}

fn number(ui: &mut Ui, x: f64) -> Option<f64> {
    let mut new = x;
    // A hundredth of the number a point, or a centimetre's hundredth near 0.
    let speed = (x.abs() * 0.01).max(if x == 0.0 || x.abs() > 1e-4 { 1e-3 } else { 0.0 });
    let drag = DragValue::new(&mut new).speed(speed);
    let drag = if x != 0.0 && x.abs() < 1e-3 {
        drag.custom_formatter(|x, _| format!("{x:.2e}"))
    } else {
        drag.max_decimals(3)
    };
    ui.add(drag).changed().then_some(new)
}
