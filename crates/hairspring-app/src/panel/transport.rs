//! Playback controls (play, pause, step, reset, slow motion), tools, and the choice of the color ramp.

use crate::{
    session::{Action, Session},
    snapshot::Snapshot,
    view::{Tool, View},
};
use eframe::egui::{self, Ui};
use hairspring_scene::stage::Value;

/// The bar below the picture.
pub fn show(ui: &mut Ui, session: &Session, snapshot: Option<&Snapshot>, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        let playing = session.playing();
        let name = if playing { "Pause" } else { "Play" };
        if ui.button(name).on_hover_text("Space").clicked() {
            actions.push(Action::Play(!playing));
        }
        if ui.add_enabled(!playing, egui::Button::new("Step")).on_hover_text("Right arrow: advance by one frame, 1/60 s").clicked() {
            actions.push(Action::Step);
        }
        if ui.button("Reset").on_hover_text("R: back to time 0").clicked() {
            actions.push(Action::Reset);
        }
        ui.separator();
        let mut speed = session.speed();
        let slider = egui::Slider::new(&mut speed, 0.05..=2.0).logarithmic(true).suffix(" ×").max_decimals(2);
        if ui.add(slider.text("Speed")).on_hover_text("Playback speed. Values below 1 play in slow motion.").changed() {
            actions.push(Action::Speed(speed));
        }
        ui.separator();
        if let Some(snapshot) = snapshot {
            let took = snapshot.took.as_secs_f32();
            // The time that a frame may take at the current playback speed.
            let due = crate::player::STEP / session.speed();
            let share = due / took.max(1e-6);
            ui.monospace(format!("{:6.2} s", snapshot.time));
            let pace = if playing && share < 1.0 {
                format!("{:.1} ms a frame: {:.0} % of the speed", 1e3 * took, 100.0 * share)
            } else {
                format!("{:.1} ms a frame", 1e3 * took)
            };
            // Text that does not fit goes to the next line as a whole.
            ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
            ui.weak(pace).on_hover_text("Compute time of a frame of 1/60 s. If it exceeds 1/60 s, playback slows down; no frame is skipped.");
            ui.weak(super::timeline::cache_note(&snapshot.cached));
        }
    });
    if let Some(snapshot) = snapshot {
        super::timeline::show(ui, session, snapshot, actions);
    }
}

/// Tools, color ramp and overlays.
pub fn tools(ui: &mut Ui, session: &Session, view: &mut View, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        for (tool, name, _, tip) in Tool::ALL {
            if ui.selectable_label(view.tool == tool, name).on_hover_text(tip).clicked() {
                view.tool = tool;
            }
        }
        if view.tool.reaches() {
            ui.add(
                egui::Slider::new(&mut view.reach, 0.002..=0.2).logarithmic(true).suffix(" m").text("Radius"),
            );
        }
        if view.tool == Tool::Palm {
            ui.add(
                egui::Slider::new(&mut view.length, 0.02..=2.0).logarithmic(true).suffix(" m").text("Length"),
            );
        }
        ui.separator();
        let shown = session.shown();
        let name = shown.map_or("natural", Value::name);
        egui::ComboBox::from_label("Color").selected_text(name).show_ui(ui, |ui| {
            if ui.selectable_label(shown.is_none(), "natural").clicked() {
                actions.push(Action::Show(None));
            }
            for value in Value::ALL {
                if ui.selectable_label(shown == Some(value), value.name()).clicked() {
                    actions.push(Action::Show(Some(value)));
                }
            }
        });
        ui.menu_button("Overlays", |ui| {
            let o = &mut view.overlays;
            for (on, name) in [
                (&mut o.hair, "Hair"),
                (&mut o.body, "Body"),
                (&mut o.colliders, "Colliders"),
                (&mut o.slice, "Slice of distance"),
                (&mut o.volume, "Volume grid"),
                (&mut o.frames, "Coordinate frames of head, roots and the picked strand"),
                (&mut o.roots, "Roots"),
                (&mut o.handles, "Handles of wind, colliders and hands"),
            ] {
                ui.checkbox(on, name);
            }
            ui.add_enabled(o.slice, egui::Slider::new(&mut view.slice, 0.0..=1.0).text("Slice height"));
            ui.separator();
            ui.add(egui::Slider::new(&mut view.exposure, -3.0..=3.0).text("Exposure").suffix(" stops"));
            let mut own = view.width.is_some();
            ui.horizontal(|ui| {
                if ui.checkbox(&mut own, "Hair width").changed() {
                    view.width = own.then_some(1.0);
                }
                if let Some(width) = &mut view.width {
                    ui.add(egui::Slider::new(width, 0.5..=20.0).logarithmic(true).suffix(" ×"));
                }
            });
        });
        ui.checkbox(&mut view.follow, "Follow").on_hover_text("L: the camera moves along with the hair");
        let mut compare = session.second().is_some();
        if ui
            .checkbox(&mut compare, "Compare")
            .on_hover_text("C: a second scene beside it, on the same motion")
            .changed()
        {
            actions.push(Action::Compare(compare));
        }
    });
}
