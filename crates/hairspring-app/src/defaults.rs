//! Reference values of a scene: those at the time it was opened, and the defaults of the library, of a
//! built-in style and of material presets.

use crate::effective::{effective, entries};
use hairspring_io::read_settings;
use std::path::Path;
use toml::{Table, Value};

/// Lists that are edited entry by entry. They have no defaults.
const LISTS: [&str; 5] = ["collider", "hand", "wind_source", "charged", "sheet"];

/// The values of a reference scene. Its text is that of another scene, except for what determines defaults:
/// the built-in style and the presets of its materials are those of the current scene.
pub struct Reference {
    /// The text of the reference scene.
    from: Table,
    /// The text that was last read.
    text: Table,
    values: Table,
}

impl Reference {
    /// Creates the reference for the scene in its current state. Later changes are compared with it.
    pub fn opened(path: &Path, parsed: &Table) -> Self {
        Self::new(path, parsed, parsed.clone())
    }

    /// Creates the reference for a scene that specifies only the sources of its hair, body and motion.
    pub fn library(path: &Path, parsed: &Table) -> Self {
        Self::new(path, parsed, bare(parsed))
    }

    fn new(path: &Path, parsed: &Table, mut from: Table) -> Self {
        LISTS.iter().for_each(|list| drop(from.remove(*list)));
        let mut reference = Self { from, text: Table::new(), values: Table::new() };
        reference.follow(path, parsed);
        reference
    }

    /// Adopts the current style and presets of the scene.
    pub fn follow(&mut self, path: &Path, parsed: &Table) {
        let mut named = self.from.clone();
        take_over(named.get_mut("builtin"), parsed.get("builtin"), "style");
        let mut text = named.clone();
        take_over(text.get_mut("builtin"), parsed.get("builtin"), "material");
        let grooms = text.get_mut("groom").and_then(Value::as_array_mut);
        for (groom, entry) in grooms.into_iter().flatten().zip(entries(parsed, "groom")) {
            take_over(Some(groom), Some(entry), "material");
        }
        let before = text.remove("material");
        let materials = parsed.get("material").and_then(Value::as_table).into_iter().flatten();
        let materials = materials.map(|(name, entry)| {
            let mut material =
                before.as_ref().and_then(|m| m.get(name)).cloned().unwrap_or(Table::new().into());
            take_over(Some(&mut material), Some(entry), "preset");
            (name.clone(), material)
        });
        text.insert("material".into(), Value::Table(materials.collect()));
        if text == self.text {
            return;
        }
        // This contains less than the scene's own text, so it can be read if that can.
        if let Ok(settings) = read_settings(path, &text.to_string()) {
            // The names are those of the reference, so that a preset that was chosen later counts as a
            // difference.
            self.values = effective(&settings, &named);
            let style = self.from.get("builtin").map(|b| b.get("style").cloned().unwrap_or("wavy".into()));
            let grooms = self.values.get_mut("groom").and_then(Value::as_array_mut);
            if let (Some(style), Some(head)) = (style, grooms.and_then(|g| g.first_mut()?.as_table_mut())) {
                head.insert("style".into(), style);
            }
        }
        self.text = text;
    }

    /// The reference values, with the keys of [`effective`].
    pub fn values(&self) -> &Table {
        &self.values
    }

    /// The text of the reference scene.
    pub fn parsed_text(&self) -> &Table {
        &self.from
    }
}

/// Copies the value of `name` from `source`, or removes it if `source` does not have it.
fn take_over(table: Option<&mut Value>, source: Option<&Value>, name: &str) {
    if let Some(table) = table.and_then(Value::as_table_mut) {
        match source.and_then(|source| source.get(name)) {
            Some(value) => drop(table.insert(name.into(), value.clone())),
            None => drop(table.remove(name)),
        }
    }
}

/// Reduces a scene to the sources of its hair, body and motion.
fn bare(parsed: &Table) -> Table {
    let only = |value: &Value, names: &[&str]| -> Value {
        let table = names.iter().filter_map(|name| Some(((*name).to_owned(), value.get(name)?.clone())));
        Value::Table(table.collect())
    };
    let mut out = Table::new();
    for (name, fields) in
        [("builtin", &[][..]), ("body", &["file"][..]), ("clip", &["file", "keys", "joint", "pivot"][..])]
    {
        if let Some(value) = parsed.get(name) {
            out.insert(name.into(), only(value, fields));
        }
    }
    let grooms = entries(parsed, "groom").iter().map(|groom| {
        let mut bare = only(groom, &["file"]);
        if let (Some(table), Some(_)) = (bare.as_table_mut(), groom.get("grow")) {
            table.insert("grow".into(), Table::new().into());
        }
        bare
    });
    let grooms: Vec<_> = grooms.collect();
    if !grooms.is_empty() {
        out.insert("groom".into(), Value::Array(grooms));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;

    fn looked_up(table: &Table, key: &str) -> Value {
        key.parse::<crate::key::Key>().unwrap().look_up(table).unwrap().clone()
    }

    #[test]
    fn defaults_follow_the_chosen_style_and_preset() {
        let text = "[builtin]\nstyle = \"curly\"\n[builtin.look]\nroughness = 0.5\n";
        let mut document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        assert_eq!(document.opened().values(), document.effective());
        let root = looked_up(document.defaults(), "groom[0].look.root_color");
        document.set(&"builtin.style".parse().unwrap(), Some("straight".into())).unwrap();
        for table in [document.defaults(), document.opened().values()] {
            let key = "groom[0].look.root_color";
            assert_ne!(looked_up(table, key), root, "a style's own color");
            assert_eq!(looked_up(table, key), looked_up(document.effective(), key));
        }
        assert_eq!(looked_up(document.defaults(), "groom[0].look.roughness").as_float(), Some(0.32));
        assert_eq!(looked_up(document.opened().values(), "groom[0].look.roughness").as_float(), Some(0.5));
        assert_eq!(looked_up(document.opened().values(), "groom[0].style").as_str(), Some("curly"));
        assert_eq!(looked_up(document.defaults(), "groom[0].style").as_str(), Some("wavy"));
    }
}
