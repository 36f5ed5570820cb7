//! The widget of a parameter: a slider, a switch, a choice, a color, a direction.

use super::{
    Labelled, TipBeside,
    number::{self, tidy},
};
use crate::parameter::{Kind, Parameter};
use eframe::egui::{self, Slider, SliderClamping, Ui};
use toml_edit::Value;

/// Width of a slider's number with its unit [points].
pub const VALUE: f32 = 90.0;
/// Width of a number without a unit [points].
const BARE: f32 = 66.0;

/// The widget of a parameter, which calls `edit` with a new value. `listed` marks a groom in the text, which
/// may have its own guides.
pub fn control(
    ui: &mut Ui,
    parameter: &Parameter,
    now: Option<&toml::Value>,
    listed: bool,
    edit: &mut dyn FnMut(Option<Value>),
) -> Option<egui::Response> {
    let number = now.and_then(as_number);
    let name = parameter.label;
    match parameter.kind() {
        // A bounded number has become one with a range.
        Kind::Bounded => None,
        Kind::Number { min, max, log } => {
            let slider = Scale { range: (min, max), log, clamping: SliderClamping::Never };
            Some(slider.show(ui, parameter, number.unwrap_or(min), edit).labelled(ui, name))
        }
        Kind::Maybe { min, max, from, without } => {
            let mut on = number.is_some();
            if ui.checkbox(&mut on, "").labelled(ui, name).changed() {
                edit(on.then(|| from.into()));
            }
            let Some(value) = number else {
                ui.weak(without);
                return None;
            };
            // From 0 on, the slider is linear. Factors have no minimum, so their slider is logarithmic.
            let slider = Scale { range: (min, max), log: min > 0.0, clamping: SliderClamping::Edits };
            Some(slider.show(ui, parameter, value, edit).labelled(ui, name))
        }
        Kind::Count { min, max } => {
            fit(ui, parameter.unit());
            Some(count(ui, number.unwrap_or(min as f64), (min, max), edit).labelled(ui, name))
        }
        Kind::Guides { max } => {
            let word = now.and_then(toml::Value::as_str);
            let words = ["some", "all", "file"];
            let words = if listed { &words[..] } else { &words[..2] };
            let combo = egui::ComboBox::from_id_salt(parameter.name)
                .width(24.0)
                .selected_text(word.unwrap_or(words[0]))
                .show_ui(ui, |ui| {
                    for choice in words {
                        let is = *choice == word.unwrap_or(words[0]);
                        if ui.selectable_label(is, *choice).clicked() && !is {
                            edit(Some(if *choice == words[0] { 2000.into() } else { (*choice).into() }));
                        }
                    }
                });
            let combo = combo.response.labelled(ui, name);
            let Some(value) = number else { return Some(combo) };
            fit(ui, parameter.unit());
            Some(count(ui, value, (1, max), edit).labelled(ui, name))
        }
        Kind::Switch => {
            let mut on = now.and_then(toml::Value::as_bool).unwrap_or(false);
            let response = ui.checkbox(&mut on, "").labelled(ui, name);
            if response.changed() {
                edit(Some(on.into()));
            }
            Some(response)
        }
        Kind::Choice => {
            let chosen = now.and_then(toml::Value::as_str).or(parameter.words().next()).unwrap_or_default();
            let combo =
                egui::ComboBox::from_id_salt(parameter.name).selected_text(chosen).show_ui(ui, |ui| {
                    for word in parameter.words() {
                        if ui.selectable_label(word == chosen, word).clicked() && word != chosen {
                            edit(Some(word.into()));
                        }
                    }
                });
            Some(combo.response)
        }
        Kind::Color => {
            let mut color = numbers(now).map(|c| c as f32);
            let response = ui.color_edit_button_rgb(&mut color);
            if response.changed() {
                edit(Some(color.into_iter().map(short).collect()));
            }
            Some(response)
        }
        Kind::MaybeColor { from, without } => {
            let mut on = now.is_some();
            if ui.checkbox(&mut on, "").labelled(ui, name).changed() {
                edit(on.then(|| from.into_iter().collect()));
            }
            let Some(now) = now else {
                ui.weak(without);
                return None;
            };
            let mut color = numbers(Some(now)).map(|c| c as f32);
            let response = ui.color_edit_button_rgb(&mut color);
            if response.changed() {
                edit(Some(color.into_iter().map(short).collect()));
            }
            Some(response)
        }
        Kind::Vector { reach } => {
            let mut vector = numbers(now);
            let mut changed = false;
            // Three numbers and their unit fit on one line.
            ui.spacing_mut().item_spacing.x = 4.0;
            for (axis, x) in ["x", "y", "z"].into_iter().zip(&mut vector) {
                let drag = number::drag(x).speed(reach / 200.0).range(-reach..=reach);
                let drag = ui.add(drag).tip_beside(ui, &format!("{axis} [{}]", parameter.unit()));
                changed |= drag.changed();
            }
            if !parameter.unit().is_empty() {
                ui.weak(parameter.unit());
            }
            if parameter.name == "wind.velocity" {
                let mut wind = vector.map(|c| c as f32);
                if super::wind::pad(ui, &mut wind, reach as f32) {
                    (vector[0], vector[2]) = (short(wind[0]), short(wind[2]));
                    changed = true;
                }
            }
            if changed {
                edit(Some(vector.into_iter().map(tidy).collect()));
            }
            None
        }
        Kind::Profile => {
            let mut profile: Vec<f64> =
                now.and_then(toml::Value::as_array).into_iter().flatten().filter_map(as_number).collect();
            let mut changed = false;
            // Mass and radius are above 0 everywhere.
            let least = if ["mass_profile", "radius_profile"].contains(&parameter.name) { 0.01 } else { 0.0 };
            for x in &mut profile {
                let value = number::drag(x).speed(0.02).range(least..=100.0);
                changed |= ui.add(value).labelled(ui, name).changed();
            }
            if profile.len() < 8 && ui.small_button("+").tip_beside(ui, "Add a value at the tip").clicked() {
                profile.push(profile.last().copied().unwrap_or(1.0));
                changed = true;
            }
            if profile.len() > 1
                && ui.small_button("-").tip_beside(ui, "Remove the value at the tip").clicked()
            {
                profile.pop();
                changed = true;
            }
            if changed {
                edit(Some(profile.into_iter().map(tidy).collect()));
            }
            None
        }
    }
}

/// A slider for whole numbers.
fn count(
    ui: &mut Ui,
    mut value: f64,
    (min, max): (i64, i64),
    edit: &mut dyn FnMut(Option<Value>),
) -> egui::Response {
    let slider = Slider::from_get_set(min as f64..=max as f64, |new| {
        if let Some(new) = new
            && new.round() != value
        {
            value = new.round();
            edit(Some((value as i64).into()));
        }
        value
    });
    // Typed numbers may be outside the range.
    let slider = slider.clamping(SliderClamping::Never).logarithmic(max > 1000 * min.max(1));
    ui.add(slider.integer())
}

/// Makes a slider as wide as fits into the rest of its row.
fn fit(ui: &mut Ui, unit: &str) {
    let left = ui.available_size_before_wrap().x - if unit.is_empty() { BARE } else { VALUE };
    ui.spacing_mut().slider_width = left.clamp(20.0, 240.0);
}

/// How a slider moves.
struct Scale {
    range: (f64, f64),
    log: bool,
    clamping: SliderClamping,
}

impl Scale {
    /// Shows a slider with its unit.
    fn show(
        self,
        ui: &mut Ui,
        parameter: &Parameter,
        mut value: f64,
        edit: &mut dyn FnMut(Option<Value>),
    ) -> egui::Response {
        fit(ui, parameter.unit());
        let parser = number::parser(value);
        let slider = Slider::from_get_set(self.range.0..=self.range.1, |new| {
            if let Some(new) = new
                && new != value
            {
                value = new;
                edit(Some(tidy(new).into()));
            }
            value
        });
        let slider = slider
            .logarithmic(self.log)
            .clamping(self.clamping)
            .custom_formatter(|x, _| number::shown(x))
            .custom_parser(parser)
            .update_while_editing(false);
        ui.add(match parameter.unit() {
            "" => slider,
            unit => slider.suffix(format!(" {unit}")),
        })
    }
}

/// A number, whether it is written as an integer or as a float.
pub fn as_number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

/// Three numbers; missing ones are 0.
fn numbers(value: Option<&toml::Value>) -> [f64; 3] {
    let mut list = value.and_then(toml::Value::as_array).into_iter().flatten().filter_map(as_number);
    std::array::from_fn(|_| list.next().unwrap_or(0.0))
}

/// Rounds a number that was picked by eye to four significant digits.
fn short(x: f32) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(f64::from(x))
}
