//! Asks before a scene with unsaved changes is left: to open another one, or to close the window.

use super::App;
use crate::{panel::files::For, session::Action};
use eframe::egui::{self, Key, Modifiers};

/// Why the scene is left.
enum To {
    /// For another scene.
    Open(Action),
    /// The window closes.
    Close,
}

/// A question about unsaved changes, or its answer while the changes are being saved.
pub(super) struct Leaving {
    to: To,
    /// Whether the user chose to save, and the file is being named.
    saves: bool,
}

impl App {
    /// Executes an action of the user. If it leaves a scene with unsaved changes, the user is asked first.
    pub(super) fn request(&mut self, action: Action) {
        match self.session.leaves_changes(&action) {
            true => self.leaving = Some(Leaving { to: To::Open(action), saves: false }),
            false => self.act(action),
        }
    }

    /// Holds back a close of the window that would lose changes.
    pub(super) fn hold_back_close(&mut self, ctx: &egui::Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        if requested && !self.closes && self.session.document().is_changed() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leaving = Some(Leaving { to: To::Close, saves: false });
        }
    }

    /// Closes the window without a question.
    pub(super) fn close(&mut self, ctx: &egui::Context) {
        self.closes = true;
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Asks about unsaved changes, and leaves the scene when they are saved or given up.
    pub(super) fn ask_before_leaving(&mut self, ctx: &egui::Context) {
        let Some(leaving) = &self.leaving else { return };
        if leaving.saves {
            if !self.session.document().is_changed() {
                self.leave(ctx);
            } else if !self.files.is_open() {
                // The dialog was closed, or the file could not be written.
                self.leaving = None;
            }
            return;
        }
        let document = self.session.document();
        let name = document.file().and_then(|p| p.file_name()).map(|n| n.to_string_lossy().into_owned());
        let name = name.unwrap_or_else(|| document.settings().name.clone());
        let (mut save, mut drop, mut stay) = (false, false, false);
        egui::Modal::new(egui::Id::unique("leaving")).show(ctx, |ui| {
            ui.set_max_width(340.0);
            ui.heading(format!("Save the changes to {name}?"));
            ui.label(match &leaving.to {
                To::Open(_) => "Another scene is about to be opened.",
                To::Close => "The window is about to close.",
            });
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                save = ui.button("Save").clicked();
                drop = ui.button("Don't save").clicked();
                stay = ui.button("Cancel").clicked();
            });
        });
        // The key is consumed, so that it does not close a dialog behind the question too.
        stay |= ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
        if stay {
            self.leaving = None;
        } else if drop {
            self.leave(ctx);
        } else if save {
            match self.session.document().file() {
                Some(_) => self.act(Action::Save(None)),
                None => self.files.open_dialog(For::Save, None),
            }
            if let Some(leaving) = &mut self.leaving {
                leaving.saves = true;
            }
        }
    }

    fn leave(&mut self, ctx: &egui::Context) {
        match self.leaving.take().map(|leaving| leaving.to) {
            Some(To::Open(action)) => self.act(action),
            Some(To::Close) => self.close(ctx),
            None => {}
        }
    }
}
