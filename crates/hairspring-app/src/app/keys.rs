//! Keyboard shortcuts, and the menu bar.

use super::App;
use crate::{panel::files::For, record::Kind, session::Action, view::Tool};
use eframe::egui::{self, FocusDirection, Key, Label, Modifiers, RichText, Ui};

impl App {
    /// Handles keys that no widget takes.
    pub(super) fn keys(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        let pressed = |m: Modifiers, k: Key| ctx.input_mut(|i| i.consume_key(m, k));
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
            actions.push(Action::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            actions.push(Action::Undo);
        }
        if pressed(Modifiers::COMMAND, Key::O) {
            self.files.open_dialog(For::Open, None);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            self.save();
        }
        if pressed(Modifiers::NONE, Key::Space) {
            actions.push(Action::Play(!self.session.playing()));
        }
        if pressed(Modifiers::NONE, Key::ArrowRight) && !self.session.playing() {
            actions.push(Action::Step);
        }
        if pressed(Modifiers::NONE, Key::ArrowLeft) && !self.session.playing() {
            actions.extend(self.frame_before().map(Action::Seek));
        }
        if pressed(Modifiers::NONE, Key::R) {
            actions.push(Action::Reset);
        }
        if pressed(Modifiers::NONE, Key::C) {
            actions.push(Action::Compare(self.session.second().is_none()));
        }
        if pressed(Modifiers::NONE, Key::Home) {
            actions.push(Action::Head(glam::Vec3::ZERO));
        }
        if pressed(Modifiers::NONE, Key::F12) {
            self.files.open_dialog(For::Record(Kind::Still), None);
        }
        if pressed(Modifiers::NONE, Key::F) {
            self.view.orbit = None;
        }
        for (key, on) in [
            (Key::L, &mut self.view.follow),
            (Key::G, &mut self.open.graphs),
            (Key::P, &mut self.open.presets),
            (Key::Questionmark, &mut self.open.help),
        ] {
            *on ^= pressed(Modifiers::NONE, key);
        }
        if pressed(Modifiers::NONE, Key::Tab) {
            self.open.panels ^= true;
            // Otherwise the key also moves the focus to a widget, which then takes the other keys.
            ctx.memory_mut(|memory| memory.move_focus(FocusDirection::None));
        }
        // On many keyboards the question mark is on a shifted key.
        self.open.help ^=
            pressed(Modifiers::SHIFT, Key::Questionmark) || pressed(Modifiers::SHIFT, Key::Slash);
        for (tool, _, key, _) in Tool::ALL {
            if pressed(Modifiers::NONE, key) {
                self.view.tool = tool;
            }
        }
        if pressed(Modifiers::NONE, Key::Escape) {
            (self.open.help, self.open.presets) = (false, false);
            self.files.close();
            actions.push(Action::Unpick);
        }
    }

    /// The cached frame before the one that is shown.
    fn frame_before(&self) -> Option<u64> {
        let snapshot = self.session.latest()?;
        snapshot.cached.frames.iter().rev().find(|frame| **frame < snapshot.frame).copied()
    }

    /// Saves the scene whose parameters are shown. Without a file, or if another program changed it, the dialog asks.
    pub(super) fn save(&mut self) {
        let document = self.session.edited();
        match document.file() {
            Some(_) if !document.is_changed_on_disk() => self.act(Action::Save(None)),
            _ => self.files.open_save_dialog(document),
        }
    }

    /// Shows the menu bar.
    pub(super) fn menu(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| {
                if ui.button("Presets…").clicked() {
                    self.open.presets = true;
                }
                if ui.button("Open…").clicked() {
                    self.files.open_dialog(For::Open, None);
                }
                if ui.button("Save").clicked() {
                    self.save();
                }
                if ui.button("Save as…").clicked() {
                    self.files.open_save_dialog(self.session.edited());
                }
                ui.separator();
                if ui.button("Export hair…").clicked() {
                    self.files.open_dialog(For::Export, None);
                }
                if ui.button("Bake…").clicked() {
                    self.files.open_bake_dialog(self.session.length());
                }
                ui.separator();
                if ui.button("Quit").clicked() {
                    ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
                }
            });
            ui.menu_button("Record", |ui| {
                for kind in Kind::ALL {
                    if ui.button(format!("{}…", kind.title())).clicked() {
                        self.files.open_dialog(For::Record(kind), None);
                    }
                }
            });
            let (back, forth) = self.session.steps();
            if ui.add_enabled(back, egui::Button::new("Undo")).clicked() {
                actions.push(Action::Undo);
            }
            if ui.add_enabled(forth, egui::Button::new("Redo")).clicked() {
                actions.push(Action::Redo);
            }
            ui.toggle_value(&mut self.open.graphs, "Graphs");
            ui.toggle_value(&mut self.open.help, "?");
            let document = self.session.edited();
            let file = document.file();
            let name = file.and_then(|p| p.file_name()).map(|n| n.to_string_lossy());
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                // Long names are cut, so that they do not cover the menus. The star stays.
                if document.is_changed() {
                    ui.strong("*");
                }
                let half = 0.5 * ui.available_width();
                ui.scope(|ui| {
                    ui.set_max_width(half);
                    ui.add(Label::new(RichText::new(&document.settings().name).strong()).truncate());
                });
                let name = RichText::new(name.unwrap_or("not saved".into())).weak();
                let shown = ui.add(Label::new(name).truncate());
                if let Some(file) = file {
                    shown.on_hover_text(file.display().to_string());
                }
            });
        });
    }
}
