//! Opening, saving and recording: the path of a file, typed or chosen in the desktop's dialog.

use crate::{
    record::{Kind, RecordRequest},
    session::Action,
};
use eframe::egui::{self, Ui};
use std::path::{Path, PathBuf};

/// Purpose of the dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum For {
    /// Opens a file.
    Open,
    /// Saves the scene.
    Save,
    /// Records the view.
    Record(Kind),
}

/// The user's decision.
pub enum Decision {
    /// An action for the session.
    Do(Action),
    /// A recording.
    Record(RecordRequest),
}

/// The dialog.
pub struct Files {
    open: Option<For>,
    path: String,
    seconds: f32,
    /// Receives the result of the desktop's dialog, which runs on its own thread.
    chosen: Option<std::sync::mpsc::Receiver<Option<PathBuf>>>,
}

impl Default for Files {
    fn default() -> Self {
        Self { open: None, path: String::new(), seconds: 5.0, chosen: None }
    }
}

impl Files {
    /// Opens the dialog with a suggested path.
    pub fn ask(&mut self, what: For, known: Option<&Path>) {
        self.open = Some(what);
        self.path = match what {
            For::Open => String::new(),
            For::Save => known.map_or("scene.toml".into(), |p| p.display().to_string()),
            For::Record(kind) => kind.file().into(),
        };
    }

    /// Closes it.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// Shows the dialog.
    pub fn show(&mut self, ctx: &egui::Context) -> Option<Decision> {
        if let Some(chosen) = self.chosen.take() {
            match chosen.try_recv() {
                Ok(Some(path)) => self.path = path.display().to_string(),
                Ok(None) | Err(std::sync::mpsc::TryRecvError::Disconnected) => {}
                Err(std::sync::mpsc::TryRecvError::Empty) => self.chosen = Some(chosen),
            }
        }
        let what = self.open?;
        let title = match what {
            For::Open => "Open a scene, groom, body or motion",
            For::Save => "Save the scene",
            For::Record(kind) => kind.title(),
        };
        let mut stays = true;
        let mut decision = None;
        egui::Window::new(title).open(&mut stays).collapsible(false).resizable(false).show(ctx, |ui| {
            let field =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of the file").desired_width(360.0);
            let typed = ui.add(field);
            let entered = typed.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            if let For::Record(Kind::Clip | Kind::Pictures | Kind::Turntable) = what {
                ui.add(egui::Slider::new(&mut self.seconds, 0.5..=60.0).suffix(" s").text("Length"));
            }
            ui.horizontal(|ui| {
                if ui.button("Browse…").clicked() {
                    self.browse(ui, what);
                }
                let go = if what == For::Open { "Open it" } else { "Write it" };
                let ready = !self.path.trim().is_empty();
                if ui.add_enabled(ready, egui::Button::new(go)).clicked() || (entered && ready) {
                    let path = PathBuf::from(self.path.trim());
                    decision = Some(match what {
                        For::Open => Decision::Do(Action::Open(path)),
                        For::Save => Decision::Do(Action::Save(Some(path))),
                        For::Record(kind) => {
                            Decision::Record(RecordRequest { kind, path, seconds: self.seconds })
                        }
                    });
                }
            });
            ui.weak(match what {
                For::Open => "A file may also be dropped on the window.",
                For::Save => "As TOML; the files that it names stay where they are.",
                For::Record(Kind::Still) => "1280 × 720 pixels, as PNG or JPEG by the name's end.",
                For::Record(Kind::Pictures) => {
                    "1280 × 720 pixels, 30 a second; # stands for the digits of the frame."
                }
                For::Record(Kind::Clip | Kind::Turntable) => "1280 × 720 pixels, 30 frames a second.",
            });
        });
        if decision.is_some() || !stays {
            self.open = None;
        }
        decision
    }

    fn browse(&mut self, ui: &Ui, what: For) {
        let (send, receive) = std::sync::mpsc::channel();
        self.chosen = Some(receive);
        let ctx = ui.ctx().clone();
        // A desktop without a portal returns nothing. The path can still be typed.
        std::thread::spawn(move || {
            let dialog = rfd::FileDialog::new();
            let path = if what == For::Open { dialog.pick_file() } else { dialog.save_file() };
            // The window may have been closed in the meantime.
            let _ = send.send(path);
            ctx.request_repaint();
        });
    }
}
