//! Opening, saving, recording and baking: the path of a file, typed or chosen in a list of a folder or in the
//! desktop's dialog, and what else the file needs.

use super::folder::Folder;
use crate::{
    bake::BakeRequest,
    document::{Document, KINDS},
    record::{Kind, RecordFormat, RecordRequest},
    session::Action,
};
use eframe::egui::{self, Ui};
use hairspring_scene::stage::FrameRate;
use std::{
    path::{Path, PathBuf},
    sync::mpsc::{Receiver, TryRecvError},
};

/// Purpose of the dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum For {
    /// Opens a file.
    Open,
    /// Saves the scene.
    Save,
    /// Records the view.
    Record(Kind),
    /// Writes the hair of the current frame.
    Export,
    /// Writes the hair of a range of frames.
    Bake,
}

impl For {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open a scene, groom, body or motion",
            Self::Save => "Save the scene",
            Self::Record(kind) => kind.title(),
            Self::Export => "Export the hair of this frame",
            Self::Bake => "Bake the hair, one file a frame",
        }
    }

    /// Extensions of the files that are listed.
    fn extensions(self) -> Vec<&'static str> {
        match self {
            Self::Open => KINDS.iter().flat_map(|(_, extensions)| *extensions).copied().collect(),
            Self::Save => vec!["toml"],
            Self::Record(Kind::Still) => vec!["png", "jpg"],
            Self::Record(Kind::Pictures) => vec!["png"],
            Self::Record(Kind::Clip | Kind::Turntable) => vec!["mp4"],
            Self::Export | Self::Bake => vec!["hair", "tfx", "data"],
        }
    }

    fn suggestion(self) -> &'static str {
        match self {
            Self::Open => "",
            Self::Save => "scene.toml",
            Self::Record(kind) => kind.file(),
            Self::Export => "groom.hair",
            Self::Bake => "hair.####.hair",
        }
    }

    fn explanation(self) -> &'static str {
        match self {
            Self::Open => "A file may also be dropped on the window.",
            Self::Save => "As TOML; the files that it names stay where they are.",
            Self::Record(Kind::Still) => "PNG or JPEG, by the name's end.",
            Self::Record(Kind::Pictures) => "`#` signs represent the digits of the frame's number.",
            Self::Record(Kind::Clip | Kind::Turntable) => "An .mp4 with H.264 video.",
            Self::Export => "All hairs as they are now, as .hair, .tfx or .data.",
            Self::Bake => {
                "Simulates the scene from time 0, including unsaved changes, and writes one groom file per frame, like \
                 `hairspring bake`. The # signs represent the digits of the frame number; frame 1 is at time 0."
            }
        }
    }
}

/// The user's decision.
pub enum Decision {
    /// An action for the session.
    Do(Action),
    /// A recording.
    Record(RecordRequest),
    /// The file for the hair of the current frame.
    Export(PathBuf),
    /// A bake.
    Bake(BakeRequest),
}

/// The dialog.
pub struct Files {
    open: Option<For>,
    path: String,
    /// The file of the open scene.
    own: Option<PathBuf>,
    /// The folder that was used last.
    folder: Folder,
    seconds: f32,
    /// Size and rate of recordings.
    pub format: RecordFormat,
    /// First and last frame of a bake.
    frames: [u32; 2],
    /// Frame rate of a bake.
    rate: FrameRate,
    /// Receives the result of the desktop's dialog, which runs on its own thread.
    chosen: Option<Receiver<Option<PathBuf>>>,
    note: Option<&'static str>,
}

impl Default for Files {
    fn default() -> Self {
        let format = RecordFormat::default();
        Self {
            open: None,
            path: String::new(),
            own: None,
            folder: Folder::default(),
            seconds: 5.0,
            frames: [1, format.rate.frames_of(None)],
            rate: format.rate,
            format,
            chosen: None,
            note: None,
        }
    }
}

/// Sizes of recordings [pixels].
const SIZES: [[u32; 2]; 6] =
    [[640, 360], [1280, 720], [1920, 1080], [3840, 2160], [1080, 1080], [1080, 1920]];
/// Frame rates.
const RATES: [&str; 8] = ["12", "23.976", "24", "25", "29.97", "30", "50", "60"];
/// What a dialog of the desktop that returns nothing may mean.
const NO_FILE: &str = "The desktop's dialog returned no file. If none opened, this desktop has no portal for it \
    (xdg-desktop-portal); use the list above.";

/// What a file that another program changed means.
const CHANGED: &str = "Another program changed this file since it was read. \"Replace it\" overwrites those changes; open the \
    file again to see them.";

impl Files {
    /// Opens the dialog with a suggested path.
    pub fn open_dialog(&mut self, what: For, known: Option<&Path>) {
        (self.open, self.note, self.own) = (Some(what), None, known.map(Path::to_owned));
        let current = std::env::current_dir().unwrap_or_default();
        let folder = match self.folder.path() {
            unused if unused.as_os_str().is_empty() => current.clone(),
            used => used.to_owned(),
        };
        let folder = known.and_then(Path::parent).map_or(folder, Path::to_owned);
        self.folder.enter(&folder);
        self.path = match (known, what.suggestion()) {
            (Some(known), _) => known.display().to_string(),
            (None, "") => String::new(),
            (None, name) if folder == current => name.into(),
            (None, name) => folder.join(name).display().to_string(),
        };
    }

    /// Opens the dialog to save a scene.
    pub fn open_save_dialog(&mut self, document: &Document) {
        self.open_dialog(For::Save, document.file());
        if document.is_changed_on_disk() {
            // As any other file, it is only replaced by the button `Replace it`.
            (self.own, self.note) = (None, Some(CHANGED));
        }
    }

    /// Opens the dialog for a bake of a motion of this length [s].
    pub fn open_bake_dialog(&mut self, duration: Option<f64>) {
        self.frames = [1, self.rate.frames_of(duration)];
        self.open_dialog(For::Bake, None);
    }

    /// Whether it is shown.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Closes it.
    pub fn close(&mut self) {
        self.open = None;
    }

    /// Shows the dialog.
    pub fn show(&mut self, ctx: &egui::Context) -> Option<Decision> {
        self.poll_desktop_dialog();
        let what = self.open?;
        let mut stays = true;
        let mut decision = None;
        egui::Window::new(what.title()).open(&mut stays).collapsible(false).resizable(false).show(
            ctx,
            |ui| {
                ui.set_width(460.0);
                let field = egui::TextEdit::singleline(&mut self.path).hint_text("path of the file");
                let typed = ui.add(field.desired_width(f32::INFINITY));
                let entered = typed.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
                let before = self.folder.path().to_owned();
                let clicked = self.folder.show(ui, &what.extensions());
                if before != self.folder.path() && what != For::Open {
                    // The name stays when the folder changes.
                    let name = Path::new(self.path.trim()).file_name().map(PathBuf::from).unwrap_or_default();
                    self.path = self.folder.path().join(name).display().to_string();
                }
                let twice = clicked.as_ref().is_some_and(|(_, twice)| *twice);
                if let Some((file, _)) = clicked {
                    self.path = file.display().to_string();
                }
                ui.separator();
                self.details(ui, what);
                ui.horizontal(|ui| {
                    let replaces = self.replaces(what);
                    let go = match what {
                        For::Open => "Open it",
                        For::Bake => "Bake",
                        _ if replaces => "Replace it",
                        _ => "Write it",
                    };
                    let ready = !self.path.trim().is_empty();
                    // An existing file is only replaced by the button `Replace it`.
                    let at_once = (entered || twice) && ready && !replaces;
                    if ui.add_enabled(ready, egui::Button::new(go)).clicked() || at_once {
                        decision = Some(self.decide(what));
                    }
                    if ui.button("Browse…").on_hover_text("The desktop's own dialog").clicked() {
                        self.browse(ui, what);
                    }
                });
                ui.weak(what.explanation());
                if let Some(note) = self.note {
                    ui.colored_label(ui.visuals().warn_fg_color, note);
                }
            },
        );
        if decision.is_some() || !stays {
            self.open = None;
        }
        decision
    }

    /// Whether the file exists, and is not that of the open scene.
    fn replaces(&self, what: For) -> bool {
        let path = Path::new(self.path.trim());
        let one =
            matches!(what, For::Save | For::Export | For::Record(Kind::Still | Kind::Clip | Kind::Turntable));
        one && self.own.as_deref() != Some(path) && path.is_file()
    }

    fn decide(&self, what: For) -> Decision {
        let path = PathBuf::from(self.path.trim());
        match what {
            For::Open => Decision::Do(Action::Open(path)),
            For::Save if self.replaces(what) => Decision::Do(Action::SaveOver(path)),
            For::Save => Decision::Do(Action::Save(Some(path))),
            For::Record(kind) => {
                Decision::Record(RecordRequest { kind, path, seconds: self.seconds, format: self.format })
            }
            For::Export => Decision::Export(path),
            For::Bake => Decision::Bake(BakeRequest { path, frames: self.frames, rate: self.rate }),
        }
    }

    /// What a file needs besides its path.
    fn details(&mut self, ui: &mut Ui, what: For) {
        match what {
            For::Open | For::Save | For::Export => return,
            For::Bake => {
                ui.horizontal(|ui| {
                    let [first, last] = &mut self.frames;
                    ui.label("Frames");
                    ui.add(egui::DragValue::new(first).range(1..=*last));
                    ui.label("to");
                    ui.add(egui::DragValue::new(last).range(*first..=1_000_000));
                    rate(ui, &mut self.rate);
                });
                return;
            }
            For::Record(_) => {}
        }
        ui.horizontal(|ui| {
            let [width, height] = &mut self.format.size;
            ui.label("Size");
            ui.add(egui::DragValue::new(width).range(RecordFormat::SIDES)).on_hover_text("Width");
            ui.label("×");
            ui.add(egui::DragValue::new(height).range(RecordFormat::SIDES).suffix(" pixels"))
                .on_hover_text("Height");
            ui.menu_button("Sizes", |ui| {
                for size in SIZES {
                    if ui.button(format!("{} × {}", size[0], size[1])).clicked() {
                        self.format.size = size;
                    }
                }
            });
            if what != For::Record(Kind::Still) {
                rate(ui, &mut self.format.rate);
            }
        });
        if what != For::Record(Kind::Still) {
            // A length that was typed is checked when the recording starts.
            let slider =
                egui::Slider::new(&mut self.seconds, 0.5..=60.0).clamping(egui::SliderClamping::Never);
            ui.add(slider.suffix(" s").text("Length"));
        }
    }

    fn browse(&mut self, ui: &Ui, what: For) {
        let (send, receive) = std::sync::mpsc::channel();
        (self.chosen, self.note) = (Some(receive), None);
        let ctx = ui.ctx().clone();
        let folder = self.folder.path().to_owned();
        std::thread::spawn(move || {
            let mut dialog = rfd::FileDialog::new().set_title(what.title()).set_directory(folder);
            if what == For::Open {
                dialog = dialog.add_filter("All that can be opened", &what.extensions());
                dialog = KINDS.iter().fold(dialog, |dialog, (name, of)| dialog.add_filter(*name, of));
            } else {
                dialog = dialog.add_filter("Files", &what.extensions()).set_file_name(what.suggestion());
            }
            let path = if what == For::Open { dialog.pick_file() } else { dialog.save_file() };
            // The window may have been closed in the meantime.
            let _ = send.send(path);
            ctx.request_repaint();
        });
    }

    /// Receives the result of the desktop's dialog.
    fn poll_desktop_dialog(&mut self) {
        let Some(chosen) = self.chosen.take() else { return };
        match chosen.try_recv() {
            Ok(Some(path)) => self.path = path.display().to_string(),
            // A desktop without a portal also returns nothing.
            Ok(None) | Err(TryRecvError::Disconnected) => self.note = Some(NO_FILE),
            Err(TryRecvError::Empty) => self.chosen = Some(chosen),
        }
    }
}

/// A choice of the frame rate.
fn rate(ui: &mut Ui, rate: &mut FrameRate) {
    let shown = |rate: FrameRate| format!("{} a second", (rate.hertz() * 1e3).round() / 1e3);
    egui::ComboBox::from_id_salt("rate").selected_text(shown(*rate)).show_ui(ui, |ui| {
        for known in RATES.iter().filter_map(|text| text.parse::<FrameRate>().ok()) {
            ui.selectable_value(rate, known, shown(known));
        }
    });
}
