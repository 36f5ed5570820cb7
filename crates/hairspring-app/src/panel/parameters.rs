//! Every parameter as a slider with its unit, range, tooltip and reset, under what an artist thinks of.

use super::Labelled;
use crate::{
    key::Key,
    parameter::{self, Group, Kind, Of, Parameter},
    session::{Action, Session},
};
use eframe::egui::{self, DragValue, RichText, Slider, Ui};
use glam::Vec3;
use hairspring::material::{PRESETS, preset};
use std::{collections::HashMap, sync::LazyLock};
use toml_edit::Value;

/// Width of names [points].
const LABEL: f32 = 116.0;

/// Effective values of a scene that says nothing, by the names of [`crate::document::Document::effective`].
static DEFAULTS: LazyLock<toml::Table> = LazyLock::new(crate::effective::defaults);

/// Values of a material by its preset; of one without, the library's.
static MATERIALS: LazyLock<HashMap<Option<&str>, toml::Table>> = LazyLock::new(|| {
    let names = std::iter::once(None).chain(PRESETS.into_iter().map(Some));
    let table = |name: Option<&'static str>| {
        let material = name.and_then(preset).unwrap_or_default();
        toml::Table::try_from(material).unwrap_or_else(|why| unreachable!("settings are plain data: {why}"))
    };
    names.map(|name| (name, table(name))).collect()
});

/// Shows all groups; what is added to the scene stands about `at` [m].
pub fn show(ui: &mut Ui, session: &Session, filter: &mut String, at: Vec3, actions: &mut Vec<Action>) {
    choose(ui, session, actions);
    ui.add(egui::TextEdit::singleline(filter).hint_text("Find a parameter").desired_width(f32::INFINITY));
    ui.separator();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let sought = filter.trim().to_lowercase();
        let mut none = true;
        for group in Group::ALL {
            let found = |p: &&Parameter| {
                sought.is_empty()
                    || [p.label, p.name, p.tip].iter().any(|t| t.to_lowercase().contains(&sought))
            };
            let parameters: Vec<_> =
                parameter::ALL.iter().filter(|p| p.group == group).filter(found).collect();
            let listed = lists(group).iter().any(|name| name.to_lowercase().contains(&sought));
            if parameters.is_empty() && !listed {
                continue;
            }
            none = false;
            egui::CollapsingHeader::new(RichText::new(group.name()).strong())
                .default_open(group == Group::Stiffness)
                .open((!sought.is_empty()).then_some(true))
                .show(ui, |ui| {
                    for parameter in parameters {
                        row(ui, session, parameter, actions);
                    }
                    if group == Group::Air {
                        super::list::show(ui, session, &super::list::AIR, at, actions);
                    }
                    if group == Group::Collision {
                        super::list::show(ui, session, &super::list::COLLISION, at, actions);
                    }
                    if group == Group::Motion {
                        super::list::motion(ui, session, actions);
                    }
                });
        }
        if none {
            ui.weak("Nothing is called so.");
        }
    });
}

/// Lists that stand in a group besides its parameters.
fn lists(group: Group) -> &'static [&'static str] {
    match group {
        Group::Motion => &["Keys"],
        Group::Air => &["Sources of wind", "Charged bodies"],
        Group::Collision => &["Colliders", "Hands"],
        _ => &[],
    }
}

/// Which groom, and which group of it.
fn choose(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let (groom, group) = session.chosen();
    let document = session.edited();
    let grooms: Vec<usize> = document.grooms().collect();
    let groups = document.settings().grooms.get(groom).map_or(1, |g| g.materials.len().max(1));
    if session.second().is_some() {
        ui.horizontal(|ui| {
            for (second, name) in [(false, "Left"), (true, "Right")] {
                if ui.selectable_label(session.on_second() == second, name).clicked() {
                    actions.push(Action::Second(second));
                }
            }
            ui.label("is changed");
        });
    }
    if grooms.len() > 1 || groups > 1 {
        ui.horizontal(|ui| {
            for g in grooms.iter().filter(|_| grooms.len() > 1) {
                if ui.selectable_label(*g == groom, format!("Groom {}", g + 1)).clicked() {
                    actions.push(Action::Choose(*g, 0));
                }
            }
            for g in (0..groups).filter(|_| groups > 1) {
                if ui.selectable_label(g == group, format!("Group {}", g + 1)).clicked() {
                    actions.push(Action::Choose(groom, g));
                }
            }
        });
    }
}

/// One parameter.
fn row(ui: &mut Ui, session: &Session, parameter: &'static Parameter, actions: &mut Vec<Action>) {
    let (groom, group) = session.chosen();
    let key = parameter.key(groom, group);
    let now = key.look_up(session.edited().effective());
    let default = default_of(session, parameter, groom);
    let changed = now != default;
    let mut edit = |value: Option<Value>| actions.push(Action::Parameter(parameter, value));
    ui.push_id(parameter.name, |ui| {
        ui.horizontal(|ui| {
            let name = RichText::new(parameter.label);
            let name = if changed { name.strong() } else { name };
            let tip = if parameter.unit.is_empty() {
                format!("{}\n\n{}", parameter.tip, parameter.name)
            } else {
                format!("{} [{}]\n\n{}", parameter.tip, parameter.unit, parameter.name)
            };
            let left = egui::Layout::left_to_right(egui::Align::Center);
            ui.allocate_ui_with_layout(egui::vec2(LABEL, 18.0), left, |ui| {
                ui.set_min_width(LABEL);
                ui.add(egui::Label::new(name).truncate()).on_hover_text(&tip);
            });
            let response = control(ui, parameter, now, &mut edit);
            if let Some(response) = response {
                response.on_hover_text(&tip);
            }
            if changed && ui.small_button("reset").on_hover_text("Back to the default").clicked() {
                edit(None);
            }
        });
    });
}

/// The value that counts where the text says nothing: the library's, or that of a material's preset.
fn default_of(session: &Session, parameter: &Parameter, groom: usize) -> Option<&'static toml::Value> {
    if parameter.of == Of::Material {
        let style = session.edited().preset_of(groom);
        return Key::default().field(parameter.name).look_up(MATERIALS.get(&style)?);
    }
    parameter.key(0, 0).look_up(&DEFAULTS)
}

/// The widget of a parameter, which calls `edit` with a new value.
fn control(
    ui: &mut Ui,
    parameter: &Parameter,
    now: Option<&toml::Value>,
    edit: &mut dyn FnMut(Option<Value>),
) -> Option<egui::Response> {
    let number = now.and_then(as_number);
    let name = parameter.label;
    match parameter.kind {
        Kind::Number { min, max, log } => {
            let mut value = number.unwrap_or(min);
            let slider = Slider::from_get_set(min..=max, |new| {
                if let Some(new) = new {
                    value = new;
                    edit(Some(tidy(new)));
                }
                value
            });
            let slider = slider.logarithmic(log).clamping(egui::SliderClamping::Never).max_decimals(4);
            Some(ui.add(written(slider, parameter)).labelled(ui, name))
        }
        Kind::Maybe { min, max, from } => {
            let mut on = number.is_some();
            if ui.checkbox(&mut on, "").changed() {
                edit(on.then(|| tidy(from)));
            }
            let mut value = number?;
            let slider = Slider::from_get_set(min..=max, |new| {
                if let Some(new) = new {
                    value = new;
                    edit(Some(tidy(new)));
                }
                value
            });
            Some(ui.add(written(slider.logarithmic(true), parameter)).labelled(ui, name))
        }
        Kind::Count { min, max } => {
            let mut value = number.unwrap_or(min as f64);
            let slider = Slider::from_get_set(min as f64..=max as f64, |new| {
                if let Some(new) = new
                    && new.round() != value
                {
                    value = new.round();
                    edit(Some((value as i64).into()));
                }
                value
            });
            Some(ui.add(slider.integer()).labelled(ui, name))
        }
        Kind::Switch => {
            let mut on = now.and_then(toml::Value::as_bool).unwrap_or(false);
            let response = ui.checkbox(&mut on, "").labelled(ui, name);
            if response.changed() {
                edit(Some(on.into()));
            }
            Some(response)
        }
        Kind::Choice(words) => {
            let chosen = now.and_then(toml::Value::as_str).unwrap_or(words[0]);
            let combo =
                egui::ComboBox::from_id_salt(parameter.name).selected_text(chosen).show_ui(ui, |ui| {
                    for word in words {
                        if ui.selectable_label(*word == chosen, *word).clicked() && *word != chosen {
                            edit(Some((*word).into()));
                        }
                    }
                });
            Some(combo.response)
        }
        Kind::Color => {
            let mut color = numbers::<3>(now);
            let response = ui.color_edit_button_rgb(&mut color);
            if response.changed() {
                edit(Some(color.iter().map(|c| tidy_f64(f64::from(*c))).collect()));
            }
            Some(response)
        }
        Kind::Vector { reach } => {
            let mut vector = numbers::<3>(now);
            let mut changed = false;
            for (axis, x) in ["x", "y", "z"].into_iter().zip(&mut vector) {
                let drag = DragValue::new(x).speed(reach / 200.0).range(-reach..=reach).max_decimals(2);
                let drag = ui.add(drag).on_hover_text(format!("{axis} [{}]", parameter.unit));
                changed |= drag.changed();
            }
            if parameter.name == "wind.velocity" {
                changed |= super::wind::pad(ui, &mut vector, reach as f32);
            }
            if changed {
                edit(Some(vector.iter().map(|c| tidy_f64(f64::from(*c))).collect()));
            }
            None
        }
        Kind::Profile => {
            let mut profile: Vec<f64> =
                now.and_then(toml::Value::as_array).into_iter().flatten().filter_map(as_number).collect();
            let mut changed = false;
            for x in &mut profile {
                changed |= ui.add(DragValue::new(x).speed(0.02).range(0.01..=100.0)).changed();
            }
            if profile.len() < 8 && ui.small_button("+").on_hover_text("One more towards the tip").clicked() {
                profile.push(profile.last().copied().unwrap_or(1.0));
                changed = true;
            }
            if profile.len() > 1 && ui.small_button("-").on_hover_text("One less").clicked() {
                profile.pop();
                changed = true;
            }
            if changed {
                edit(Some(profile.into_iter().map(tidy_f64).collect()));
            }
            None
        }
    }
}

/// A slider with its unit; very large and very small numbers as powers of ten.
fn written<'a>(slider: Slider<'a>, parameter: &Parameter) -> Slider<'a> {
    let unit = parameter.unit;
    let far = match parameter.kind {
        Kind::Number { min, max, .. } | Kind::Maybe { min, max, .. } => {
            max >= 1e5 || max.abs().max(min.abs()) < 1e-2
        }
        _ => false,
    };
    let slider = if far { slider.custom_formatter(|x, _| format!("{x:.2e}")) } else { slider };
    match unit {
        "" => slider,
        unit => slider.suffix(format!(" {unit}")),
    }
}

fn as_number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

fn numbers<const N: usize>(value: Option<&toml::Value>) -> [f32; N] {
    let mut list = value.and_then(toml::Value::as_array).into_iter().flatten().filter_map(as_number);
    std::array::from_fn(|_| list.next().unwrap_or(0.0) as f32)
}

/// A number as a person would write it: four digits that count.
fn tidy(x: f64) -> Value {
    tidy_f64(x).into()
}

fn tidy_f64(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_has_a_value_and_a_default() {
        let document = crate::document::Document::new(
            std::path::Path::new("scene.toml"),
            "[builtin]\nstrands = 10\nguides = 5\n".into(),
        )
        .unwrap();
        for parameter in parameter::ALL {
            let here = parameter.key(0, 0).look_up(document.effective()).is_some();
            let maybe = matches!(parameter.kind, Kind::Maybe { .. });
            assert!(here || maybe, "{} is not in the scene", parameter.name);
            assert!(parameter.tip.ends_with('.'), "{}", parameter.name);
        }
    }
}
