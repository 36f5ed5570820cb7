//! The list of a folder: its folders, and its files of some kinds.

use eframe::egui::{self, Ui};
use std::path::{Path, PathBuf};

/// Height of the list [points].
const HEIGHT: f32 = 190.0;
/// Maximum number of entries that are listed.
const MOST: usize = 2000;

/// A folder and its entries, read when it is entered.
#[derive(Default)]
pub struct Folder {
    path: PathBuf,
    folders: Vec<String>,
    files: Vec<String>,
    /// Error from reading the folder, or a note about entries that are not listed.
    note: Option<String>,
}

impl Folder {
    /// Enters a folder and reads its entries.
    pub fn enter(&mut self, path: &Path) {
        *self = Self { path: path.to_owned(), ..Self::default() };
        let entries = match std::fs::read_dir(path) {
            Ok(entries) => entries,
            Err(why) => {
                self.note = Some(format!("this folder cannot be read: {why}"));
                return;
            }
        };
        for entry in entries.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            // Follows symbolic links.
            let is_folder = entry.path().is_dir();
            if is_folder { &mut self.folders } else { &mut self.files }.push(name);
        }
        self.folders.sort_by_key(|name| name.to_lowercase());
        self.files.sort_by_key(|name| name.to_lowercase());
        let many = self.folders.len() + self.files.len();
        if many > MOST {
            self.note = Some(format!("only the first {MOST} of {many} entries are listed"));
            self.folders.truncate(MOST);
            self.files.truncate(MOST - self.folders.len());
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Shows the list, with the files that have one of these extensions. Returns the file that was clicked, and
    /// whether it was a double click. A click on a folder enters it.
    pub fn show(&mut self, ui: &mut Ui, extensions: &[&str]) -> Option<(PathBuf, bool)> {
        let (mut clicked, mut entered) = (None, None);
        ui.horizontal(|ui| {
            let parent = self.path.parent();
            if ui
                .add_enabled(parent.is_some(), egui::Button::new("Up"))
                .on_hover_text("The folder above")
                .clicked()
            {
                entered = parent.map(Path::to_owned);
            }
            ui.add(egui::Label::new(self.path.display().to_string()).truncate());
        });
        let list =
            egui::ScrollArea::vertical().max_height(HEIGHT).min_scrolled_height(HEIGHT).auto_shrink(false);
        list.show(ui, |ui| {
            for name in &self.folders {
                if ui.selectable_label(false, format!("{name}/")).clicked() {
                    entered = Some(self.path.join(name));
                }
            }
            let wanted = |name: &&String| {
                let extension = Path::new(name).extension().map(|e| e.to_string_lossy().to_lowercase());
                extension.is_some_and(|e| extensions.contains(&e.as_str()))
            };
            for name in self.files.iter().filter(wanted) {
                let label = ui.selectable_label(false, name);
                if label.clicked() || label.double_clicked() {
                    clicked = Some((self.path.join(name), label.double_clicked()));
                }
            }
            if let Some(note) = &self.note {
                ui.weak(note);
            }
        });
        if let Some(folder) = entered {
            self.enter(&folder);
        }
        clicked
    }
}
