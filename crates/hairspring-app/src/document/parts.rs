//! Replacing the body or the motion in the text of a scene. Everything else stays, with its comments.

use super::{Document, parsed};
use crate::{AppError, key::Key};
use toml_edit::{DocumentMut, Item, Value};

/// Initial hair for a body without any.
const COAT: &str =
    "\n[[groom]]\nmaterial = \"short-fur\"\nguides = 1000\n\n[groom.grow]\nstrands = 20000\nlength = 0.02\n";

impl Document {
    /// Returns the text with another body, at rest. What belonged to the old body is removed. If no hair is
    /// left, a short coat grows on the new body.
    pub fn with_body(&self, file: &str) -> Result<String, AppError> {
        let mut edited = parsed(self.text())?;
        if edited.contains_key("builtin") {
            // The old name no longer applies.
            edited.remove("name");
        }
        for gone in ["builtin", "collision", "clip"] {
            edited.remove(gone);
        }
        let coat = if edited.contains_key("groom") { "" } else { COAT };
        let text = with_file(edited, "body", file)?;
        // It belongs to the first entry, which may be one of the removed ones.
        let head = head(self.text());
        let lost = if text.starts_with(head) { String::new() } else { format!("{head}\n\n") };
        Ok(format!("{lost}{text}{coat}"))
    }

    /// Returns the text with another motion, which moves the joints of the same names.
    pub fn with_motion(&self, file: &str) -> Result<String, AppError> {
        with_file(parsed(self.text())?, "clip", file)
    }

    /// The values and tables of `earlier` that this scene does not have, by their names: those of the whole file, and
    /// those of its tables.
    pub fn removed_since(&self, earlier: &toml::Table) -> Vec<String> {
        let mut removed = Vec::new();
        for (name, value) in earlier {
            match (value, self.parsed_text.get(name)) {
                (toml::Value::Table(_), None) => removed.push(format!("[{name}]")),
                (_, None) => removed.push(name.clone()),
                (toml::Value::Table(earlier), Some(now)) => {
                    let gone = earlier.keys().filter(|field| now.get(field.as_str()).is_none());
                    removed.extend(gone.map(|field| format!("{name}.{field}")));
                }
                _ => {}
            }
        }
        removed
    }
}

/// Returns the text with a table `name` that has nothing but this file. An existing table keeps its place and its
/// comments.
fn with_file(mut edited: DocumentMut, name: &str, file: &str) -> Result<String, AppError> {
    let Some(table) = edited.get_mut(name).and_then(Item::as_table_like_mut) else {
        let text = edited.to_string();
        return Ok(format!("{}\n\n[{name}]\nfile = {file}\n", text.trim()).trim_start().to_owned());
    };
    let fields: Vec<String> = table.iter().map(|(field, _)| field.to_owned()).collect();
    for field in fields.iter().filter(|field| *field != "file") {
        table.remove(field);
    }
    let file: Value =
        file.parse().map_err(|why| AppError::new(format!("{file} is not a file name: {why}")))?;
    Key::top("file").write(table, Some(file));
    Ok(edited.to_string().trim_start().to_owned())
}

/// The comment at the head of a text; empty if there is none.
fn head(text: &str) -> &str {
    let comment = |line: &&str| line.trim().is_empty() || line.trim().starts_with('#');
    let length = text.split_inclusive('\n').take_while(comment).map(str::len).sum();
    text[..length].trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> Document {
        Document::new("scene.toml".as_ref(), text.into()).unwrap()
    }

    #[test]
    fn a_body_that_replaces_the_built_in_head_gets_a_coat_and_keeps_other_hair() {
        let head = "name = \"Built-in head\"\n[builtin]\nstyle = \"wavy\"\n\n[[collider]]\nshape.sphere = { center = [0.0, 1.0, 0.0], radius = 0.1 }\n";
        let scene = "[[groom]]\nfile = \"a.hair\"\n\n[[collider]]\nshape.sphere = { center = [0.0, 1.0, 0.0], radius = 0.1 }\n";
        for (text, coat) in [(head, true), (scene, false)] {
            let text = document(text).with_body("\"b.obj\"").unwrap();
            let other = document(&text);
            assert_eq!(other.settings().grooms.len(), 1, "{text}");
            assert_eq!(text.contains("[groom.grow]"), coat, "{text}");
            assert!(text.contains("collider") && !text.contains("uilt"), "{text}");
        }
    }

    #[test]
    fn a_replaced_part_keeps_its_place_and_its_comments() {
        let text = "# Shot 12\n# by Ada\n\nname = \"Shot\"\n\n# walk, then turn\n[clip]\nfile = \"walk.bvh\" # take 3\n\
                    joint = \"Head\"\n\n# her own\n[body]\nfile = \"old.glb\"\nrig = \"old.json\"\n\n[[groom]]\n# soft\n[groom.grow]\nstrands = 9\n";
        let moved = document(text).with_motion("\"run.bvh\"").unwrap();
        assert_eq!(moved, text.replace("walk.bvh", "run.bvh").replace("joint = \"Head\"\n", ""));
        let other = document(text).with_body("\"new.glb\"").unwrap();
        let clip = "# walk, then turn\n[clip]\nfile = \"walk.bvh\" # take 3\njoint = \"Head\"\n\n";
        let wanted = text.replace(clip, "").replace("old.glb", "new.glb").replace("rig = \"old.json\"\n", "");
        assert_eq!(other, wanted);
        let earlier = document(text);
        let mut removed = document(&other).removed_since(earlier.parsed_text());
        removed.sort();
        assert_eq!(removed, ["[clip]", "body.rig"]);
    }

    #[test]
    fn the_comment_at_the_head_stays_if_the_first_entry_is_removed() {
        let text = "# mine\nname = \"x\"\n[builtin]\nstrands = 9\n";
        let other = document(text).with_body("\"b.obj\"").unwrap();
        assert!(other.starts_with("# mine\n\n[body]\nfile = \"b.obj\"\n"), "{other}");
    }
}
