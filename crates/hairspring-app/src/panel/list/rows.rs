//! The fields of an entry as rows. Every number has its unit, a tooltip and, if it was changed, a reset
//! button.

use super::super::{Labelled, TipBeside, keys, number};
use crate::{
    edit,
    field::{Field, Kind, of, place, tip, unit, words},
    key::Key,
    session::{Action, Session},
};
use eframe::egui::{self, RichText, Ui};
use toml_edit::Value;

/// Width of labels [points].
const LABEL: f32 = 86.0;

/// Rows for the fields of a list entry.
pub(super) struct Rows<'a> {
    pub(super) session: &'a Session,
    pub(super) list: &'static str,
    pub(super) actions: &'a mut Vec<Action>,
}

impl Rows<'_> {
    /// Shows the fields of a table: first those of a nested table, then its own in the order of their
    /// definitions.
    pub(super) fn fields(&mut self, ui: &mut Ui, key: &Key, value: &toml::Value) {
        let Some(table) = value.as_table() else { return };
        for (name, inner) in table.iter().filter(|(_, value)| value.is_table()) {
            self.fields(ui, &key.entry(name), inner);
        }
        let mut own: Vec<_> = table.iter().filter(|(_, value)| !value.is_table()).collect();
        own.sort_by_key(|(name, _)| place(name));
        for (name, value) in own {
            self.field(ui, &key.entry(name), name, Some(value));
        }
    }

    /// Shows one field.
    pub(super) fn field(&mut self, ui: &mut Ui, key: &Key, name: &str, value: Option<&toml::Value>) {
        let Some(field) = of(self.list, name) else { return };
        let document = self.session.edited();
        let in_text = key.look_up(document.parsed_text()).is_some();
        // An added entry has no original value; only undo reverts its changes.
        let before = document.first(key).filter(|[_, counted]| *counted != key.look_up(document.effective()));
        let back = before.map(|[text, _]| text.and_then(edit::written));
        if let Kind::Keys(keys) = field.kind {
            // If the corners of a hull come from a file, the text has none.
            if name == "points" && !in_text {
                return;
            }
            ui.push_id(name, |ui| {
                ui.horizontal(|ui| {
                    ui.label(name_of(field, &back)).tip_beside(ui, &tip(field, key));
                    self.reset(ui, key, back);
                });
                let first = self.first_key(key, name);
                keys::show(ui, (key, field, keys), value, (&first, self.list == "clip"), self.actions);
            });
            return;
        }
        ui.push_id(name, |ui| {
            // Fields that are too long for the panel wrap, so that it does not grow.
            ui.horizontal_wrapped(|ui| {
                let left = egui::Layout::left_to_right(egui::Align::Center);
                ui.allocate_ui_with_layout(egui::vec2(LABEL, 18.0), left, |ui| {
                    ui.set_min_width(LABEL);
                    ui.add(egui::Label::new(name_of(field, &back)).truncate())
                        .tip_beside(ui, &tip(field, key));
                });
                if let Some(new) = self.control(ui, field, key, value) {
                    self.actions.push(Action::Set(key.clone(), new));
                }
                self.reset(ui, key, back);
            });
        });
    }

    /// Shows the reset button of a field that was changed since the scene was opened.
    fn reset(&mut self, ui: &mut Ui, key: &Key, back: Option<Option<Value>>) {
        let Some(back) = back else { return };
        if ui.small_button("reset").tip_beside(ui, "Back to how the scene was opened").clicked() {
            self.actions.push(Action::Set(key.clone(), back));
        }
    }

    /// The first key of a new list: for a charged body its current position, one second later; otherwise 0.
    fn first_key(&self, key: &Key, name: &str) -> Vec<f64> {
        let effective = self.session.edited().effective();
        let center = key.sibling("center").look_up(effective).and_then(toml::Value::as_array);
        match (self.list, name, center) {
            ("charged", "path", Some(center)) => {
                std::iter::once(1.0).chain(center.iter().filter_map(toml::Value::as_float)).collect()
            }
            ("clip", ..) => vec![0.0; 7],
            _ => vec![0.0; 4],
        }
    }

    /// The widget of a field. `Some(None)` removes the field. The file's reader checks ranges and rejects
    /// invalid values.
    fn control(
        &self,
        ui: &mut Ui,
        field: &Field,
        key: &Key,
        value: Option<&toml::Value>,
    ) -> Option<Option<Value>> {
        match (field.kind, value) {
            (Kind::Joint, value) => {
                let none = if self.list == "collider" { "first joint" } else { "none" };
                let chosen = value.and_then(toml::Value::as_str);
                let mut new = None;
                let combo = egui::ComboBox::from_id_salt(field.name)
                    .selected_text(chosen.unwrap_or(none))
                    .show_ui(ui, |ui| {
                        if ui.selectable_label(chosen.is_none(), none).clicked() {
                            new = Some(None);
                        }
                        for joint in self.session.joints() {
                            if ui.selectable_label(chosen == Some(joint), joint).clicked() {
                                new = Some(Some(joint.as_str().into()));
                            }
                        }
                    });
                combo.response.labelled(ui, field.label).tip_beside(ui, &tip(field, key));
                new
            }
            (Kind::Word, Some(value)) => {
                let chosen = value.as_str()?;
                let mut new = None;
                let combo =
                    egui::ComboBox::from_id_salt(field.name).selected_text(chosen).show_ui(ui, |ui| {
                        for word in words(key) {
                            if ui.selectable_label(chosen == *word, *word).clicked() && chosen != *word {
                                new = Some(Some((*word).into()));
                            }
                        }
                    });
                combo.response.labelled(ui, field.label).on_hover_text(tip(field, key));
                new
            }
            (Kind::Maybe(from), value) => {
                let mut never = value.is_none();
                if ui.checkbox(&mut never, "never").tip_beside(ui, &tip(field, key)).changed() {
                    return Some((!never).then(|| from.into()));
                }
                number_field(ui, as_number(value?)?, unit(key), &tip(field, key)).map(|x| Some(x.into()))
            }
            (_, Some(toml::Value::Boolean(on))) => {
                let mut on = *on;
                let response = ui.checkbox(&mut on, "").labelled(ui, field.label);
                response.tip_beside(ui, &tip(field, key)).changed().then(|| Some(on.into()))
            }
            (_, Some(toml::Value::Array(list))) => {
                let mut changed = false;
                let mut out = Vec::with_capacity(list.len());
                for (axis, x) in ["x", "y", "z"].into_iter().zip(list) {
                    let x = as_number(x).unwrap_or(0.0);
                    let new = number_field(ui, x, "", &format!("{axis}: {}", tip(field, key)));
                    changed |= new.is_some();
                    out.push(new.unwrap_or(x));
                }
                if !unit(key).is_empty() {
                    ui.weak(unit(key));
                }
                changed.then(|| Some(Value::from_iter(out)))
            }
            (_, Some(value)) => {
                number_field(ui, as_number(value)?, unit(key), &tip(field, key)).map(|x| Some(x.into()))
            }
            (_, None) => None,
        }
    }
}

/// The label of a field, emphasized if the field was changed.
fn name_of(field: &Field, back: &Option<Option<Value>>) -> RichText {
    let name = RichText::new(field.label);
    if back.is_some() { name.strong() } else { name }
}

fn as_number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

fn number_field(ui: &mut Ui, x: f64, unit: &str, tip: &str) -> Option<f64> {
    let mut new = x;
    // A hundredth of the number per point of drag, with a minimum of 0.001 except for very small numbers.
    let speed = (x.abs() * 0.01).max(if x == 0.0 || x.abs() > 1e-4 { 1e-3 } else { 0.0 });
    let drag = number::drag(&mut new).speed(speed);
    let drag = if unit.is_empty() { drag } else { drag.suffix(format!(" {unit}")) };
    ui.add(drag).tip_beside(ui, tip).changed().then_some(new)
}
