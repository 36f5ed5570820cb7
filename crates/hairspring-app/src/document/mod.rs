//! The scene that is open: the text of its file, edited in place, with every earlier text to go back to.
//!
//! The text is the only copy: sliders write into it, undo puts an older one back, save writes it out. What it comes to is read by `hairspring-io`, as for every other command, so that the window can
//! do nothing that a scene file cannot, and a value that the reader refuses is refused here with the same sentence.

mod files;
mod history;
mod material;

pub use history::Way;

use crate::{defaults::Reference, effective::effective, error::AppError, key::Key};
use hairspring_io::{Loaded, read_scene_text, read_settings, same_geometry};
use hairspring_scene::Scene;
use history::{Draft, History};
use std::path::{Path, PathBuf};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// The text of the scene that the window opens with: the built-in head, with so many hairs.
pub fn builtin_text(style: &str, strands: u32, guides: u32) -> String {
    format!(
        "name = \"Built-in head\"\n\n[builtin]\nstyle = \"{style}\"\nstrands = {strands}\nguides = {guides}\n"
    )
}

/// A scene file being edited.
pub struct Document {
    /// Where it is saved; files that it names are relative to its folder.
    path: PathBuf,
    /// Whether there is such a file.
    on_disk: bool,
    draft: Draft,
    saved: String,
    history: History,
    /// What is being dragged: its values are one step to go back.
    dragged: Vec<Key>,
    settings: Scene,
    /// The text as a table, read once for all who ask what it says.
    said: toml::Table,
    effective: toml::Table,
    /// What would count had nothing been changed since it was opened, and were nothing said.
    opened: Reference,
    defaults: Reference,
    /// What the text said and what counted when it was opened.
    first: [toml::Table; 2],
}

/// A scene's text, and where its files are named from.
pub struct Source {
    path: PathBuf,
    text: String,
}

impl Source {
    /// Reads the scene with all its files.
    pub fn load(&self) -> Result<Loaded<Scene>, AppError> {
        Ok(read_scene_text(&self.path, &self.text)?)
    }
}

/// What an edit asks of what is playing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Nothing.
    None,
    /// Settings only: it plays on.
    Settings,
    /// Other hair, another body or another motion: it begins anew.
    Geometry,
}

impl Document {
    /// A scene with this text that is not saved yet; what it names is relative to `path`'s folder.
    pub fn new(path: &Path, text: String) -> Result<Self, AppError> {
        let settings = read_settings(path, &text)?;
        let said = table(&text)?;
        let effective = effective(&settings, &said);
        Ok(Self {
            path: path.to_owned(),
            on_disk: false,
            saved: text.clone(),
            draft: Draft::new(text),
            history: History::default(),
            dragged: Vec::new(),
            first: [said.clone(), effective.clone()],
            effective,
            opened: Reference::opened(path, &said),
            defaults: Reference::library(path, &said),
            settings,
            said,
        })
    }

    /// Opens a scene file.
    pub fn open(path: &Path) -> Result<Self, AppError> {
        let text = std::fs::read_to_string(path)
            .map_err(|why| AppError::new(format!("{} could not be read: {why}", path.display())))?;
        Ok(Self { on_disk: true, ..Self::new(path, text)? })
    }

    /// Reads the scene with all its files.
    pub fn load(&self) -> Result<Loaded<Scene>, AppError> {
        self.source().load()
    }

    /// What it takes to read the scene elsewhere.
    pub fn source(&self) -> Source {
        Source { path: self.path.clone(), text: self.draft.text.clone() }
    }

    /// Its settings; grooms are without strands.
    pub fn settings(&self) -> &Scene {
        &self.settings
    }

    /// Every value that counts: see [`crate::effective::effective`].
    pub fn effective(&self) -> &toml::Table {
        &self.effective
    }

    /// What would count had nothing been changed since it was opened.
    pub fn opened(&self) -> &Reference {
        &self.opened
    }

    /// What the text said here and what counted when the scene was opened; `None` of what belongs to an entry of a list that was added since.
    pub fn first(&self, key: &Key) -> Option<[Option<&toml::Value>; 2]> {
        let key = match key.listed() {
            Some((list, place)) => key.relisted(self.draft.first(list, place)?),
            None => key.clone(),
        };
        Some(self.first.each_ref().map(|table| key.look_up(table)))
    }

    /// Every value that would count if the text said nothing of it, by the same names.
    pub fn defaults(&self) -> &toml::Table {
        self.defaults.values()
    }

    /// What the text itself says.
    pub fn said(&self) -> &toml::Table {
        &self.said
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.draft.text
    }

    /// Where it is saved, if it ever was.
    pub fn file(&self) -> Option<&Path> {
        self.on_disk.then_some(&*self.path)
    }

    /// Whether the text differs from the file's.
    pub fn is_changed(&self) -> bool {
        self.draft.text != self.saved
    }

    /// Whether there is a text to go back to, and one to go forth to.
    pub fn history(&self) -> (bool, bool) {
        self.history.has()
    }

    /// Writes a value, or takes it away so that its default counts. While a value is dragged, what is written to it is one step to go back: until [`Document::rest`].
    pub fn set(&mut self, key: &Key, value: Option<Value>) -> Result<Change, AppError> {
        self.set_all(vec![(key.clone(), value)])
    }

    /// As [`Document::set`], several values at once: one step to go back.
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

    /// What was dragged is let go of: the next value is a step of its own.
    pub fn rest(&mut self) {
        self.dragged.clear();
    }

    /// Adds an entry, given as the text of its fields, to a list such as `collider`.
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

    /// Takes entry `place` out of a list.
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

    /// Goes one step this way, if there is one and its text can be read.
    pub fn step(&mut self, way: Way) -> Result<Change, AppError> {
        self.rest();
        let Some(draft) = self.history.next(way).cloned() else { return Ok(Change::None) };
        let left = self.draft.clone();
        let change = self.put(draft)?;
        self.history.step(way, left);
        Ok(change)
    }

    /// Takes up a new text if it can be read; `step`: as a step to go back.
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
        self.said = table(&draft.text)?;
        self.effective = effective(&settings, &self.said);
        self.opened.follow(&self.path, &self.said);
        self.defaults.follow(&self.path, &self.said);
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
