//! Asks before scenes with unsaved changes are left: to open another one, to end a comparison, or to close the window.

use super::App;
use crate::session::{Action, Side};
use eframe::egui::{self, Key, Modifiers};

/// Why the scenes are left.
enum To {
    /// For an action.
    Act(Action),
    /// The window closes.
    Close,
}

/// A question about unsaved changes, or its answer while the changes are being saved.
pub(super) struct Leaving {
    to: To,
    /// The side that the user chose to save, while its file is being named.
    saves: Option<Side>,
    /// The sides whose changes the user gave up.
    given_up: Vec<Side>,
}

impl Leaving {
    fn new(to: To) -> Self {
        Self { to, saves: None, given_up: Vec::new() }
    }

    /// Why the user is asked.
    fn reason(&self) -> &'static str {
        match &self.to {
            To::Act(Action::Compare(_)) => "The comparison is about to end.",
            To::Act(_) => "Another scene is about to be opened.",
            To::Close => "The window is about to close.",
        }
    }
}

impl App {
    /// Executes an action of the user. If it loses unsaved changes, the user is asked first.
    pub(super) fn request(&mut self, action: Action) {
        match self.session.loses(&action)[..] {
            [] => self.act(action),
            _ => self.leaving = Some(Leaving::new(To::Act(action))),
        }
    }

    /// Holds back a close of the window that would lose changes.
    pub(super) fn hold_back_close(&mut self, ctx: &egui::Context) {
        let requested = ctx.input(|i| i.viewport().close_requested());
        if requested && !self.closes && !self.session.unsaved().is_empty() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leaving = Some(Leaving::new(To::Close));
        }
    }

    /// Closes the window without a question.
    pub(super) fn close(&mut self, ctx: &egui::Context) {
        self.closes = true;
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    /// Asks about unsaved changes, one scene after the other, and leaves when they are saved or given up.
    pub(super) fn ask_before_leaving(&mut self, ctx: &egui::Context) {
        let Some(leaving) = &self.leaving else { return };
        let mut lost = match &leaving.to {
            To::Act(action) => self.session.loses(action),
            To::Close => self.session.unsaved(),
        };
        lost.retain(|side| !leaving.given_up.contains(side));
        if leaving.saves.is_some_and(|side| lost.contains(&side)) {
            if !self.files.is_open() {
                // The dialog was closed, or the file could not be written.
                self.leaving = None;
            }
            return;
        }
        let Some(&side) = lost.first() else { return self.leave(ctx) };
        let Some(document) = self.session.on(side) else { return };
        let name = document.file().and_then(|p| p.file_name()).map(|n| n.to_string_lossy().into_owned());
        let name = name.unwrap_or_else(|| document.settings().name.clone());
        let which = match side {
            Side::Left => "",
            Side::Right => " (right)",
        };
        let (mut save, mut drop, mut stay) = (false, false, false);
        egui::Modal::new(egui::Id::unique("leaving")).show(ctx, |ui| {
            ui.set_max_width(340.0);
            ui.heading(format!("Save the changes to {name}{which}?"));
            ui.label(leaving.reason());
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                save = ui.button("Save").clicked();
                drop = ui.button("Don't save").clicked();
                stay = ui.button("Cancel").clicked();
            });
        });
        // The key is consumed, so that it does not close a dialog behind the question too.
        stay |= ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
        let Some(leaving) = &mut self.leaving else { return };
        if stay {
            self.leaving = None;
        } else if drop {
            leaving.given_up.push(side);
            ctx.request_repaint();
        } else if save {
            leaving.saves = Some(side);
            self.act(Action::Second(side == Side::Right));
            self.save();
        }
    }

    fn leave(&mut self, ctx: &egui::Context) {
        match self.leaving.take().map(|leaving| leaving.to) {
            Some(To::Act(action)) => self.act(action),
            Some(To::Close) => self.close(ctx),
            None => {}
        }
    }
}
