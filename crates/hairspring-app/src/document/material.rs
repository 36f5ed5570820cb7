//! Grooms and materials in the text: their keys, and creating a separate material for a group that uses a
//! preset.

use super::{Document, parsed};
use crate::{AppError, key::Key};
use toml_edit::{Item, Table, Value};

impl Document {
    /// Returns the key for `field` of the material of group `group` of groom `groom`. If the group has no
    /// material of its own, one is created. Its creation and the next written value form one undo step.
    pub fn own_material(&mut self, groom: usize, group: usize, field: &str) -> Result<Key, AppError> {
        let key = |name: &str| Key::top("material").entry(name).field(field);
        let mut edited = parsed(self.text())?;
        let Some(place) = self.groom_key(groom).map(|key| key.field("material")) else {
            return Err(AppError::new(format!("the scene file has no entry for groom {groom}")));
        };
        let text = &self.parsed_text;
        let list = self.materials_of(groom);
        let at = group.min(list.len().saturating_sub(1));
        if let Some(name) = self.material_of(groom, group) {
            return Ok(key(&name));
        }
        let known = |name: &str| text.get("material").is_some_and(|m| m.get(name).is_some());
        // The new material is based on a preset: the current one, that of the built-in style, or the default.
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
        self.take(self.draft.with(edited.to_string()), true)?;
        self.dragged = vec![key(&name)];
        Ok(key(&name))
    }

    /// Names of the materials of groom `groom` as written in the text.
    fn materials_of(&self, groom: usize) -> Vec<String> {
        match self.groom_key(groom).and_then(|key| key.field("material").look_up(&self.parsed_text)) {
            Some(toml::Value::String(name)) => vec![name.clone()],
            Some(toml::Value::Array(names)) => {
                names.iter().filter_map(|n| n.as_str().map(str::to_owned)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Name of the material that the text defines for group `group` of groom `groom`; `None` if the group
    /// uses a preset or no material.
    pub fn material_of(&self, groom: usize, group: usize) -> Option<String> {
        let mut list = self.materials_of(groom);
        let name = (!list.is_empty()).then(|| list.swap_remove(group.min(list.len() - 1)))?;
        self.parsed_text.get("material")?.get(&name).map(|_| name)
    }

    /// Whether the text defines a material that no groom uses.
    pub fn has_unused_material(&self, name: &str) -> bool {
        let defined = self.parsed_text.get("material").is_some_and(|materials| materials.get(name).is_some());
        defined && !self.grooms().any(|groom| self.materials_of(groom).iter().any(|used| used == name))
    }

    /// Key of groom `groom` in the text; `None` for the brows of the built-in head, which are not in the
    /// text.
    pub fn groom_key(&self, groom: usize) -> Option<Key> {
        let made = self.settings.grooms.len().saturating_sub(self.listed_grooms());
        match (groom, groom.checked_sub(made)) {
            (_, Some(place)) => Some(Key::top("groom").place(place)),
            (0, None) => Some(Key::top("builtin")),
            _ => None,
        }
    }

    /// Name of groom `groom`. Grooms with the same name are numbered.
    pub fn groom_name(&self, groom: usize) -> String {
        let grooms = &self.settings.grooms;
        let Some(name) = grooms.get(groom).map(|groom| &groom.name) else { return String::new() };
        let same = |until: usize| grooms[..until].iter().filter(|groom| groom.name == *name).count();
        if same(grooms.len()) > 1 { format!("{name} {}", same(groom + 1)) } else { name.clone() }
    }

    /// The grooms that are in the text.
    pub fn grooms(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.settings.grooms.len()).filter(|g| self.groom_key(*g).is_some())
    }

    fn listed_grooms(&self) -> usize {
        self.parsed_text.get("groom").and_then(toml::Value::as_array).map_or(0, Vec::len)
    }
}

/// A table that is written without a header of its own.
fn implicit() -> Table {
    let mut table = Table::new();
    table.set_implicit(true);
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_material_that_no_groom_names_is_unused() {
        let text = "[builtin]\nmaterial = \"a\"\n[[groom]]\nmaterial = [\"b\", \"curly\"]\n[groom.grow]\nstrands = 5\n\
            [material.a]\n[material.b]\n[material.\"c d\"]\n";
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        assert_eq!(
            ["a", "b", "c d", "curly"].map(|name| document.has_unused_material(name)),
            [false, false, true, false]
        );
    }

    #[test]
    fn grooms_are_named_after_their_files_and_numbered_if_names_repeat() {
        let text = "[builtin]\nstrands = 5\n[[groom]]\nfile = \"a/tail.hair\"\n[[groom]]\nfile = \"tail.tfx\"\n\
            [[groom]]\nname = \"Fringe\"\n[groom.grow]\nstrands = 5\n[[groom]]\n[groom.grow]\nstrands = 5\n";
        let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
        let names: Vec<String> = (0..6).map(|g| document.groom_name(g)).collect();
        assert_eq!(names, ["Head hair", "Brows and lashes", "tail 1", "tail 2", "Fringe", "Grown hair"]);
    }
}
