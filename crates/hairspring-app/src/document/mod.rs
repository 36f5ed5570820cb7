//! The open scene: the text of its file, which is edited in place, with an undo history.
//!
//! The text is the only representation: sliders write into it, undo restores an older one, and save writes it
//! to the file. `hairspring-io` parses it, as for every other command. The window can therefore do nothing
//! that a scene file cannot, and an invalid value is rejected with the same message.

mod files;
mod history;
mod material;
mod open;
mod parts;
mod text_style;

pub use files::{is_same_file, text_in_folder};
pub use history::Way;
pub use open::{KINDS, new_scene, replaces_scene};

use crate::{defaults::Reference, effective::effective, error::AppError, key::Key};
use hairspring_io::{Inputs, Loaded, read_scene_text, read_settings, same_geometry, text_of};
use hairspring_scene::Scene;
use history::{Draft, History};
use std::path::{Path, PathBuf};
use text_style::TextStyle;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// The text of the window's initial scene: the built-in head, with the given numbers of hairs and guides.
pub fn builtin_text(style: &str, hairs: Option<(u32, u32)>) -> String {
    let hairs =
        hairs.map_or(String::new(), |(strands, guides)| format!("strands = {strands}\nguides = {guides}\n"));
    format!("name = \"Built-in head\"\n\n[builtin]\nstyle = \"{style}\"\n{hairs}")
}

/// Writes `value` at `key` in the text of a scene file, such as `solver.substeps` or `groom[0].look.roughness`.
/// A value that is not TOML is written as a string, so that names need no quotes.
///
/// # Errors
/// Returns an error if the text is not TOML or has no place for the key. The value is not checked.
pub fn set_in_text(text: &str, key: &str, value: &str) -> Result<String, AppError> {
    let mut edited = parsed(text)?;
    let place: Key = key.parse().map_err(|why: String| AppError::new(why))?;
    let value = value.parse::<Value>().unwrap_or_else(|_| value.into());
    match place.write(edited.as_table_mut(), Some(value)) {
        true => Ok(edited.to_string()),
        false => Err(AppError::new(format!("the scene has no {key}"))),
    }
}

/// A scene file being edited.
pub struct Document {
    /// The path of the file. Files that the scene names are relative to its folder.
    path: PathBuf,
    /// Content of the file when it was last read or saved; `None` if the scene has no file.
    stored: Option<String>,
    style: TextStyle,
    draft: Draft,
    saved: String,
    history: History,
    /// Keys of the current drag. All values written to them form one undo step.
    dragged: Vec<Key>,
    settings: Scene,
    /// The text as a parsed table, shared by everything that reads it.
    parsed_text: toml::Table,
    effective: toml::Table,
    /// Reference values: at the time of opening, and the defaults.
    opened: Reference,
    defaults: Reference,
    /// The text and the effective values at the time of opening.
    first: [toml::Table; 2],
}

/// The content of a scene's file, with all changes, and its path, for loading it elsewhere.
pub struct Source {
    path: PathBuf,
    text: String,
}

impl Source {
    /// Reads the scene with all its files.
    pub fn load(&self) -> Result<Loaded<Scene>, AppError> {
        Ok(read_scene_text(&self.path, &self.text)?)
    }

    /// The same, and the checksums of the text and of all files that were read.
    pub fn load_and_record(&self) -> Result<(Loaded<Scene>, Inputs), AppError> {
        let (loaded, inputs) = Inputs::record_text(&self.path, &self.text, || self.load());
        Ok((loaded?, inputs))
    }
}

/// The effect of an edit on the running simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// No effect.
    None,
    /// Only settings changed: the simulation continues.
    Settings,
    /// The hair, the body or the motion changed: the simulation restarts.
    Geometry,
}

impl Document {
    /// Creates a document for an unsaved scene. Files are named relative to the folder of `path`.
    pub fn new(path: &Path, text: String) -> Result<Self, AppError> {
        let settings = read_settings(path, &text)?;
        let parsed_text = table(&text)?;
        let effective = effective(&settings, &parsed_text);
        Ok(Self {
            path: path.to_owned(),
            stored: None,
            style: TextStyle::default(),
            saved: text.clone(),
            draft: Draft::new(text),
            history: History::default(),
            dragged: Vec::new(),
            first: [parsed_text.clone(), effective.clone()],
            effective,
            opened: Reference::opened(path, &parsed_text),
            defaults: Reference::library(path, &parsed_text),
            settings,
            parsed_text,
        })
    }

    /// Opens a scene file.
    pub fn open(path: &Path) -> Result<Self, AppError> {
        let content = text_of(path)?;
        let (style, text) = TextStyle::split(&content);
        Ok(Self { stored: Some(content), style, ..Self::new(path, text)? })
    }

    /// Returns the data that is needed to read the scene on another thread.
    pub fn source(&self) -> Source {
        Source { path: self.path.clone(), text: self.style.content(&self.draft.text) }
    }

    /// The settings of the scene; grooms have no strands.
    pub fn settings(&self) -> &Scene {
        &self.settings
    }

    /// All effective values: see [`crate::effective::effective`].
    pub fn effective(&self) -> &toml::Table {
        &self.effective
    }

    /// The reference values at the time of opening.
    pub fn opened(&self) -> &Reference {
        &self.opened
    }

    /// The value of the text and the effective value of a key at the time of opening; `None` for list entries
    /// that were added since.
    pub fn first(&self, key: &Key) -> Option<[Option<&toml::Value>; 2]> {
        let key = match key.listed() {
            Some((list, place)) => key.relisted(self.draft.first(list, place)?),
            None => key.clone(),
        };
        Some(self.first.each_ref().map(|table| key.look_up(table)))
    }

    /// All default values, with the same keys.
    pub fn defaults(&self) -> &toml::Table {
        self.defaults.values()
    }

    /// The parsed text.
    pub fn parsed_text(&self) -> &toml::Table {
        &self.parsed_text
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.draft.text
    }

    /// The path of the file, if it exists.
    pub fn file(&self) -> Option<&Path> {
        self.stored.is_some().then_some(&*self.path)
    }

    /// Whether the text differs from the saved file.
    pub fn is_changed(&self) -> bool {
        self.draft.text != self.saved
    }

    /// Whether undo is possible, and whether redo is.
    pub fn history(&self) -> (bool, bool) {
        self.history.has()
    }

    /// Writes a value, or removes it so that its default applies. While a value is dragged, all writes to it
    /// form one undo step, until [`Document::rest`] is called.
    pub fn set(&mut self, key: &Key, value: Option<Value>) -> Result<Change, AppError> {
        self.set_all(vec![(key.clone(), value)])
    }

    /// Like [`Document::set`], for several values in one undo step.
    pub fn set_all(&mut self, values: Vec<(Key, Option<Value>)>) -> Result<Change, AppError> {
        let mut edited = parsed(self.text())?;
        let mut keys = Vec::with_capacity(values.len());
        for (key, value) in values {
            if !key.write(edited.as_table_mut(), value) {
                return Err(AppError::new(format!("the scene has no {key}")));
            }
            keys.push(key);
        }
        let change = self.take(self.draft.with(edited.to_string()), self.dragged != keys)?;
        self.dragged = keys;
        Ok(change)
    }

    /// Ends a drag. The next value is a separate undo step.
    pub fn rest(&mut self) {
        self.dragged.clear();
    }

    /// Appends an entry to a list such as `collider`. `fields` is the text of its fields.
    pub fn add(&mut self, list: &str, fields: &str) -> Result<Change, AppError> {
        let mut edited = parsed(self.text())?;
        let fields: DocumentMut = fields.parse().map_err(|why| AppError::new(format!("{why}")))?;
        let item = edited.entry(list).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        let Some(tables) = item.as_array_of_tables_mut() else {
            return Err(AppError::new(format!("`{list}` is not written as [[{list}]] tables in this scene")));
        };
        let mut table = Table::new();
        table.extend(fields.as_table().iter().map(|(k, v)| (k.to_owned(), v.clone())));
        let had = tables.len();
        tables.push(table);
        self.take(self.draft.added(edited.to_string(), list, had), true)
    }

    /// Removes entry `place` from a list.
    pub fn remove(&mut self, list: &str, place: usize) -> Result<Change, AppError> {
        let mut edited = parsed(self.text())?;
        let tables = edited.get_mut(list).and_then(Item::as_array_of_tables_mut);
        let Some(tables) = tables.filter(|tables| place < tables.len()) else { return Ok(Change::None) };
        let had = tables.len();
        tables.remove(place);
        if tables.is_empty() {
            edited.remove(list);
        }
        self.take(self.draft.removed(edited.to_string(), list, had, place), true)
    }

    /// Takes one undo or redo step, if there is one and its text can be read.
    pub fn step(&mut self, way: Way) -> Result<Change, AppError> {
        self.rest();
        let Some(draft) = self.history.next(way).cloned() else { return Ok(Change::None) };
        let left = self.draft.clone();
        let change = self.put(draft)?;
        self.history.step(way, left);
        Ok(change)
    }

    /// Adopts a new text if it can be read; `step` adds an undo step.
    fn take(&mut self, draft: Draft, step: bool) -> Result<Change, AppError> {
        if draft.text == self.draft.text {
            return Ok(Change::None);
        }
        let old = self.draft.clone();
        let change = self.put(draft)?;
        self.history.follow(step.then_some(old));
        self.dragged.clear();
        Ok(change)
    }

    fn put(&mut self, draft: Draft) -> Result<Change, AppError> {
        let settings = read_settings(&self.path, &draft.text)?;
        let same = same_geometry(&self.draft.text, &draft.text);
        self.parsed_text = table(&draft.text)?;
        self.effective = effective(&settings, &self.parsed_text);
        self.opened.follow(&self.path, &self.parsed_text);
        self.defaults.follow(&self.path, &self.parsed_text);
        (self.settings, self.draft) = (settings, draft);
        Ok(if same { Change::Settings } else { Change::Geometry })
    }
}

fn table(text: &str) -> Result<toml::Table, AppError> {
    text.parse().map_err(|why| AppError::new(format!("{why}")))
}

fn parsed(text: &str) -> Result<DocumentMut, AppError> {
    text.parse().map_err(|why| AppError::new(format!("{why}")))
}
