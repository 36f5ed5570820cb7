//! All parameters as widgets with unit, range, tooltip and reset button, grouped by artistic purpose.

use super::{
    TipBeside,
    control::{VALUE, as_number, control},
};
use crate::{
    edit,
    key::Key,
    parameter::{self, Group, Kind, Parameter, describe},
    session::{Action, Session},
    text::shortened,
};
use eframe::egui::{self, RichText, Ui};
use glam::Vec3;
use hairspring_scene::Camera;
use toml_edit::Value;

/// Width of labels [points].
const LABEL: f32 = 106.0;
/// Width of the reset button, for which space is always reserved [points].
const RESET: f32 = 42.0;

/// Largest height of the list of grooms [points].
const GROOMS: f32 = 96.0;
/// Maximum length of a groom's name in the list [characters].
const LONGEST: usize = 28;

/// Shows all groups. `camera` is the camera of the window; entries that are added to the scene are placed at
/// its target.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    filter: &mut String,
    camera: Option<Camera>,
    actions: &mut Vec<Action>,
) {
    let at = camera.map_or(Vec3::ZERO, |camera| camera.target);
    choose(ui, session, actions);
    ui.horizontal(|ui| {
        if session.is_reading() {
            ui.add(egui::Spinner::new().size(14.0)).on_hover_text("The scene is being reloaded");
        }
        ui.add(egui::TextEdit::singleline(filter).hint_text("Find a parameter").desired_width(f32::INFINITY));
    });
    ui.separator();
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let sought = filter.trim().to_lowercase();
        let mut none = true;
        for group in Group::ALL {
            let found = |p: &&Parameter| {
                sought.is_empty()
                    || [p.label, p.name, group.name(), &p.definition().summary()]
                        .iter()
                        .any(|t| t.to_lowercase().contains(&sought))
            };
            let parameters: Vec<_> = parameter::ALL
                .iter()
                .filter(|p| p.group == group && has_place(session, p))
                .filter(found)
                .collect();
            let named = |name: &str| name.to_lowercase().contains(&sought);
            let listed = lists(group).iter().any(|name| named(name) || named(group.name()));
            if parameters.is_empty() && !listed {
                continue;
            }
            none = false;
            // During a search the header has a different id, so that the open state without a search is kept.
            egui::CollapsingHeader::new(RichText::new(group.name()).strong())
                .id_salt((group.name(), &sought))
                .default_open(!sought.is_empty() || [Group::Style, Group::Stiffness].contains(&group))
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
                    if group == Group::Camera {
                        take_view(ui, camera, actions);
                    }
                });
        }
        if none {
            ui.weak("No parameter has this name.");
        }
    });
}

/// Label of the button that copies the window's camera into the scene.
const TAKE_VIEW: &str = "Use the current view";

/// Copies the window's camera into the scene.
fn take_view(ui: &mut Ui, camera: Option<Camera>, actions: &mut Vec<Action>) {
    let Some(camera) = camera else { return };
    let button = ui.small_button(TAKE_VIEW);
    if button.tip_beside(ui, "Sets the scene's camera to the window's current view.").clicked() {
        let key = Key::top("camera");
        // Rounds to a tenth of a millimeter, which is sufficient.
        let tidy = |x: f32| (f64::from(x) * 1e4).round() / 1e4;
        let place = |at: Vec3| Value::from_iter(at.to_array().map(tidy));
        actions.push(Action::SetAll(vec![
            (key.field("position"), Some(place(camera.position))),
            (key.field("target"), Some(place(camera.target))),
            (key.field("fov"), Some(tidy(camera.fov).into())),
            (key.field("follow"), camera.follow.then(|| true.into())),
        ]));
        actions.push(Action::Rest);
    }
}

/// The lists that are shown in a group in addition to its parameters.
fn lists(group: Group) -> &'static [&'static str] {
    match group {
        Group::Motion => &["Keys"],
        Group::Air => &["Wind sources", "Charged bodies"],
        Group::Collision => &["Colliders", "Sheets", "Hands"],
        Group::Camera => &[TAKE_VIEW],
        _ => &[],
    }
}

/// Selects the groom, and the group in it.
fn choose(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let (groom, group) = session.chosen();
    let document = session.edited();
    let grooms: Vec<usize> = document.grooms().collect();
    let groups = document.settings().grooms.get(groom).map_or(1, |g| g.materials.len().max(1));
    if session.second().is_some() {
        ui.horizontal(|ui| {
            ui.label("Edit:");
            for (second, name) in [(false, "Left"), (true, "Right")] {
                if ui.selectable_label(session.on_second() == second, name).clicked() {
                    actions.push(Action::Second(second));
                }
            }
        });
    }
    if grooms.len() > 1 || groups > 1 {
        let list =
            egui::ScrollArea::vertical().id_salt("grooms").max_height(GROOMS).auto_shrink([false, true]);
        list.show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for g in grooms.iter().filter(|_| grooms.len() > 1) {
                    let name = document.groom_name(*g);
                    let short = shortened(&name, LONGEST);
                    let mut button = ui.selectable_label(*g == groom, &*short);
                    if short != name {
                        button = button.on_hover_text(&name);
                    }
                    if button.clicked() {
                        actions.push(Action::Choose(*g, 0));
                    }
                }
                for g in (0..groups).filter(|_| groups > 1) {
                    if ui.selectable_label(g == group, format!("Group {}", g + 1)).clicked() {
                        actions.push(Action::Choose(groom, g));
                    }
                }
            });
        });
    }
}

/// Whether the parameter applies to this kind of scene: hair that is read from a file has no style and is not
/// grown.
fn has_place(session: &Session, parameter: &Parameter) -> bool {
    let (groom, group) = session.chosen();
    let (key, effective) = (parameter.key(groom, group), session.edited().effective());
    let maybe = matches!(parameter.kind(), Kind::Maybe { .. } | Kind::MaybeColor { .. });
    key.look_up(effective).is_some() || (maybe && key.parent().look_up(effective).is_some())
}

/// Shows one parameter.
fn row(ui: &mut Ui, session: &Session, parameter: &'static Parameter, actions: &mut Vec<Action>) {
    let chosen = session.chosen();
    let document = session.edited();
    let key = parameter.key(chosen.0, chosen.1);
    ui.push_id(parameter.name, |ui| {
        // If a change restarts the scene, it is applied when the drag ends. Until then the value is only
        // displayed.
        let held_id = ui.scope_id().with("held");
        let held: Option<Value> = ui.data(|data| data.get_temp(held_id));
        let shown: Option<toml::Value> =
            held.as_ref().and_then(|value| value.to_string().trim().parse().ok());
        let now = shown.as_ref().or_else(|| key.look_up(document.effective()));
        let idle = parameter.inactive_reason(document, chosen);
        let changed = idle.is_none() && now != key.look_up(document.opened().values());
        let listed = document.groom_key(chosen.0).is_none_or(|key| key != Key::top("builtin"));
        let mut edited = None;
        ui.horizontal(|ui| {
            let name = RichText::new(parameter.label);
            let name = if changed { name.strong() } else { name };
            let tip = tip(parameter, idle.as_deref(), key.look_up(document.defaults()));
            let left = egui::Layout::left_to_right(egui::Align::Center);
            ui.allocate_ui_with_layout(egui::vec2(LABEL, 18.0), left, |ui| {
                ui.set_min_width(LABEL);
                ui.add_enabled(idle.is_none(), egui::Label::new(name).truncate()).tip_beside(ui, &tip);
            });
            let room = (ui.available_width() - RESET - ui.spacing().item_spacing.x).max(VALUE);
            ui.allocate_ui_with_layout(egui::vec2(room, 18.0), left.with_main_wrap(true), |ui| {
                ui.set_min_width(room);
                ui.set_max_width(room);
                ui.add_enabled_ui(idle.is_none(), |ui| {
                    let response = control(ui, parameter, now, listed, &mut |value| edited = Some(value));
                    if let Some(response) = response {
                        response.tip_beside(ui, &tip);
                    }
                });
            });
            if changed {
                ui.spacing_mut().button_padding.x = 3.0;
                let back = ui.add(egui::Button::new("reset").small().truncate());
                if back.tip_beside(ui, "Back to how the scene was opened").clicked() {
                    edited = Some(edit::reset(document, parameter, chosen));
                }
            }
        });
        let waits = parameter.is_geometry() && ui.input(|i| i.pointer.any_down());
        match (edited, held) {
            (Some(Some(value)), _) if waits => {
                ui.data_mut(|data| data.insert_temp(held_id, value));
            }
            (None, Some(_)) if waits => {}
            (edited, held) => {
                if let Some(value) = edited.or(held.map(Some)) {
                    actions.push(Action::Parameter(parameter, value));
                    ui.data_mut(|data| data.remove::<Value>(held_id));
                }
            }
        }
    });
}

/// The tooltip: description, accepted values, default and name.
fn tip(parameter: &Parameter, idle: Option<&str>, default: Option<&toml::Value>) -> String {
    let default = default.map_or("none".into(), |value| match value {
        toml::Value::Boolean(on) => (if *on { "on" } else { "off" }).into(),
        toml::Value::Array(list) => {
            let numbers: Vec<_> = list.iter().filter_map(as_number).map(short).collect();
            numbers.join(", ")
        }
        value => match (as_number(value), value.as_str()) {
            (Some(x), _) => short(x),
            (None, word) => word.unwrap_or_default().into(),
        },
    });
    let first = idle.map(|why| format!("{why}\n\n")).unwrap_or_default();
    format!("{first}{}\n{}", describe(parameter.definition(), &default), parameter.name)
}

/// Formats a number compactly.
fn short(x: f64) -> String {
    let far = x != 0.0 && !(1e-3..1e6).contains(&x.abs());
    if far { format!("{x:e}") } else { format!("{x}") }
}

#[cfg(test)]
mod tests;
