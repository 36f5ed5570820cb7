//! The scene that is open: the text of its file, edited in place, with every earlier text to go back to.
//!
//! The text is the only copy: sliders write into it, undo puts an older one back, save writes it out. What it comes to is read by `hairspring-io`, as for every other command, so that the window can
//! do nothing that a scene file cannot, and a value that the reader refuses is refused here with the same sentence.

use crate::{defaults::Reference, effective::effective, error::AppError, key::Key};
use hairspring::scene::Scene;
use hairspring_io::{Loaded, read_scene_text, read_settings, same_geometry};
use std::{
    io::Write,
    path::{Path, PathBuf},
};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// Most texts that are kept to go back to: at some kilobytes each, well under a megabyte.
const MOST_STEPS: usize = 200;

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
    text: String,
    saved: String,
    undo: Vec<String>,
    redo: Vec<String>,
    /// What is being dragged: its values are one step to go back.
    dragged: Vec<Key>,
    settings: Scene,
    /// The text as a table, read once for all who ask what it says.
    said: toml::Table,
    effective: toml::Table,
    /// What would count had nothing been changed since it was opened, and were nothing said.
    opened: Reference,
    defaults: Reference,
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
        Ok(Self {
            path: path.to_owned(),
            on_disk: false,
            saved: text.clone(),
            text,
            undo: Vec::new(),
            redo: Vec::new(),
            dragged: Vec::new(),
            effective: effective(&settings, &said),
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
        Source { path: self.path.clone(), text: self.text.clone() }
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
        &self.text
    }

    /// Where it is saved, if it ever was.
    pub fn file(&self) -> Option<&Path> {
        self.on_disk.then_some(&*self.path)
    }

    /// Whether the text differs from the file's.
    pub fn is_changed(&self) -> bool {
        self.text != self.saved
    }

    /// Whether there is a text to go back to, and one to go forth to.
    pub fn history(&self) -> (bool, bool) {
        (!self.undo.is_empty(), !self.redo.is_empty())
    }

    /// Writes a value, or takes it away so that its default counts. While a value is dragged, what is written to it is one step to go back: until [`Document::rest`].
    pub fn set(&mut self, key: &Key, value: Option<Value>) -> Result<Change, AppError> {
        self.set_all(vec![(key.clone(), value)])
    }

    /// As [`Document::set`], several values at once: one step to go back.
    pub fn set_all(&mut self, values: Vec<(Key, Option<Value>)>) -> Result<Change, AppError> {
        let mut edited = self.parsed()?;
        let mut keys = Vec::with_capacity(values.len());
        for (key, value) in values {
            if !key.write(edited.as_table_mut(), value) {
                return Err(AppError::new(format!("the scene has no {key}")));
            }
            keys.push(key);
        }
        let change = self.take(edited.to_string(), self.dragged != keys)?;
        self.dragged = keys;
        Ok(change)
    }

    /// What was dragged is let go of: the next value is a step of its own.
    pub fn rest(&mut self) {
        self.dragged.clear();
    }

    /// Adds an entry, given as the text of its fields, to a list such as `collider`.
    pub fn add(&mut self, list: &str, fields: &str) -> Result<Change, AppError> {
        let mut edited = self.parsed()?;
        let fields: DocumentMut = fields.parse().map_err(|why| AppError::new(format!("{why}")))?;
        let item = edited.entry(list).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        let Some(tables) = item.as_array_of_tables_mut() else {
            return Err(AppError::new(format!("`{list}` is not written as [[{list}]] tables in this scene")));
        };
        let mut table = Table::new();
        table.extend(fields.as_table().iter().map(|(k, v)| (k.to_owned(), v.clone())));
        tables.push(table);
        self.take(edited.to_string(), true)
    }

    /// The text with another body, at rest; what belonged to the old one goes.
    pub fn with_body(&self, file: &str) -> Result<String, AppError> {
        let mut edited = self.parsed()?;
        for gone in ["builtin", "body", "collision", "clip"] {
            edited.remove(gone);
        }
        Ok(format!("{}\n[body]\nfile = {file}\n", edited.to_string().trim_end()))
    }

    /// The text with another motion, which drives the body by the joints of the same names.
    pub fn with_motion(&self, file: &str) -> Result<String, AppError> {
        let mut edited = self.parsed()?;
        edited.remove("clip");
        Ok(format!("{}\n\n[clip]\nfile = {file}\n", edited.to_string().trim_end()))
    }

    /// Takes entry `place` out of a list.
    pub fn remove(&mut self, list: &str, place: usize) -> Result<Change, AppError> {
        let mut edited = self.parsed()?;
        if let Some(tables) = edited.get_mut(list).and_then(Item::as_array_of_tables_mut)
            && place < tables.len()
        {
            tables.remove(place);
            if tables.is_empty() {
                edited.remove(list);
            }
        }
        self.take(edited.to_string(), true)
    }

    /// Goes one step back.
    pub fn undo(&mut self) -> Result<Change, AppError> {
        let Some(text) = self.undo.pop() else { return Ok(Change::None) };
        self.redo.push(self.text.clone());
        self.rest();
        self.put(text)
    }

    /// Goes one step forth again.
    pub fn redo(&mut self) -> Result<Change, AppError> {
        let Some(text) = self.redo.pop() else { return Ok(Change::None) };
        self.undo.push(self.text.clone());
        self.rest();
        self.put(text)
    }

    /// Writes the text to a file, whole or not at all. Saved to another folder, the files that it names are named from there.
    pub fn save(&mut self, path: &Path) -> Result<(), AppError> {
        let failed =
            |why: std::io::Error| AppError::new(format!("{} could not be written: {why}", path.display()));
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let text = self.moved_to(folder)?;
        let mut file = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
        file.write_all(text.as_bytes()).map_err(failed)?;
        file.persist(path).map_err(|why| failed(why.error))?;
        self.said = table(&text)?;
        self.text.clone_from(&text);
        (self.path, self.saved, self.on_disk) = (path.to_owned(), text, true);
        Ok(())
    }

    /// The text with its files named from `folder`.
    fn moved_to(&self, folder: &Path) -> Result<String, AppError> {
        let from = self.path.parent().unwrap_or(Path::new(""));
        let whole = |p: &Path| std::path::absolute(p).unwrap_or_else(|_| p.to_owned());
        let (from, to) = (whole(from), whole(folder));
        if from == to {
            return Ok(self.text.clone());
        }
        let mut edited = self.parsed()?;
        rename_files(edited.as_table_mut(), &|name| {
            let path = whole(&from.join(name));
            path.strip_prefix(&to).map(Path::to_owned).unwrap_or(path)
        });
        Ok(edited.to_string())
    }

    /// Where to write `field` of a material of its own that group `group` of groom `groom` has. It is made if there is none, and is one step to go back
    /// with the value that is written to it next.
    pub fn own_material(&mut self, groom: usize, group: usize, field: &str) -> Result<Key, AppError> {
        let key = |name: &str| Key::top("material").entry(name).field(field);
        let mut edited = self.parsed()?;
        let Some(place) = self.groom_key(groom).map(|key| key.field("material")) else {
            return Err(AppError::new(format!("the scene says nothing of groom {groom}")));
        };
        let text = &self.said;
        let list = self.materials_of(groom);
        let at = group.min(list.len().saturating_sub(1));
        if let Some(name) = self.material_of(groom, group) {
            return Ok(key(&name));
        }
        let known = |name: &str| text.get("material").is_some_and(|m| m.get(name).is_some());
        // A preset, the built-in style's or the default: a material of its own begins from it.
        let style = text
            .get("builtin")
            .filter(|_| groom == 0)
            .map(|b| b.get("style").and_then(toml::Value::as_str).unwrap_or("wavy").to_owned());
        let base = list.get(at).cloned().or(style);
        let name = (1..)
            .map(|k| if k == 1 { "hair".into() } else { format!("hair-{k}") })
            .find(|n: &String| !known(n));
        let name = name.unwrap_or_default();
        let materials = edited.entry("material").or_insert(Item::Table(implicit()));
        if let Some(materials) = materials.as_table_like_mut() {
            let mut table = Table::new();
            if let Some(base) = base {
                table.insert("preset", Item::Value(base.into()));
            }
            materials.insert(&name, Item::Table(table));
        }
        let value: Value = if list.len() > 1 {
            let mut names = list;
            names[at].clone_from(&name);
            Value::from_iter(names)
        } else {
            name.clone().into()
        };
        if !place.write(edited.as_table_mut(), Some(value)) {
            return Err(AppError::new(format!("the scene has no {place}")));
        }
        self.take(edited.to_string(), true)?;
        self.dragged = vec![key(&name)];
        Ok(key(&name))
    }

    /// Names of the materials of groom `groom`, as the text says them.
    fn materials_of(&self, groom: usize) -> Vec<String> {
        match self.groom_key(groom).and_then(|key| key.field("material").look_up(&self.said)) {
            Some(toml::Value::String(name)) => vec![name.clone()],
            Some(toml::Value::Array(names)) => {
                names.iter().filter_map(|n| n.as_str().map(str::to_owned)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Name of the material that the text has for group `group` of groom `groom`; `None` where that has a preset, or none.
    pub fn material_of(&self, groom: usize, group: usize) -> Option<String> {
        let mut list = self.materials_of(groom);
        let name = (!list.is_empty()).then(|| list.swap_remove(group.min(list.len() - 1)))?;
        self.said.get("material")?.get(&name).map(|_| name)
    }

    /// Where the text says what groom `groom` is; `None` for the built-in head's brows, of which it says nothing.
    pub fn groom_key(&self, groom: usize) -> Option<Key> {
        let made = self.settings.grooms.len().saturating_sub(self.listed_grooms());
        match (groom, groom.checked_sub(made)) {
            (_, Some(place)) => Some(Key::top("groom").place(place)),
            (0, None) => Some(Key::top("builtin")),
            _ => None,
        }
    }

    /// Grooms that the text says something of.
    pub fn grooms(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.settings.grooms.len()).filter(|g| self.groom_key(*g).is_some())
    }

    fn listed_grooms(&self) -> usize {
        self.said.get("groom").and_then(toml::Value::as_array).map_or(0, Vec::len)
    }

    fn parsed(&self) -> Result<DocumentMut, AppError> {
        self.text.parse().map_err(|why| AppError::new(format!("{why}")))
    }

    /// Takes up a new text if it can be read; `step`: as a step to go back.
    fn take(&mut self, text: String, step: bool) -> Result<Change, AppError> {
        if text == self.text {
            return Ok(Change::None);
        }
        let old = self.text.clone();
        let change = self.put(text)?;
        if step {
            self.undo.push(old);
            let many = self.undo.len().saturating_sub(MOST_STEPS);
            self.undo.drain(..many);
        }
        self.redo.clear();
        self.dragged.clear();
        Ok(change)
    }

    fn put(&mut self, text: String) -> Result<Change, AppError> {
        let settings = read_settings(&self.path, &text)?;
        let same = same_geometry(&self.text, &text);
        self.said = table(&text)?;
        self.effective = effective(&settings, &self.said);
        self.opened.follow(&self.path, &self.said);
        self.defaults.follow(&self.path, &self.said);
        (self.settings, self.text) = (settings, text);
        Ok(if same { Change::Settings } else { Change::Geometry })
    }
}

fn table(text: &str) -> Result<toml::Table, AppError> {
    text.parse().map_err(|why| AppError::new(format!("{why}")))
}

/// A table that is written only by what is in it.
fn implicit() -> Table {
    let mut table = Table::new();
    table.set_implicit(true);
    table
}

/// Renames every file that a scene names: the values of `file`, `rig`, `weights` and `bones`.
fn rename_files(table: &mut dyn toml_edit::TableLike, rename: &dyn Fn(&str) -> PathBuf) {
    for (key, item) in table.iter_mut() {
        let names_file = ["file", "rig", "weights", "bones"].contains(&key.get());
        match item {
            Item::Value(Value::String(name)) if names_file => {
                let new = rename(name.value()).to_string_lossy().into_owned();
                let decor = name.decor().clone();
                let mut new = Value::from(new);
                *new.decor_mut() = decor;
                *item = Item::Value(new);
            }
            Item::ArrayOfTables(list) => list.iter_mut().for_each(|t| rename_files(t, rename)),
            Item::Value(Value::Array(list)) => {
                list.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|t| rename_files(t, rename));
            }
            item => {
                if let Some(table) = item.as_table_like_mut() {
                    rename_files(table, rename);
                }
            }
        }
    }
}
