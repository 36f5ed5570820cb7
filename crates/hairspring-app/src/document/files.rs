//! The files of a scene: saving, adjusting the paths of named files, and replacing the body or the motion.

use super::{Document, parsed, table};
use crate::{
    AppError,
    destination::{destination, settled},
    recovery::KeptScene,
};
use hairspring_io::atomically;
use std::path::{Path, PathBuf};
use toml_edit::{Item, Value};

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
        for gone in ["builtin", "body", "collision", "clip"] {
            edited.remove(gone);
        }
        let coat = if edited.contains_key("groom") { "" } else { COAT };
        Ok(format!("{}\n\n[body]\nfile = {file}\n{coat}", edited.to_string().trim()).trim_start().to_owned())
    }

    /// Returns the text with another motion, which moves the joints of the same names.
    pub fn with_motion(&self, file: &str) -> Result<String, AppError> {
        let mut edited = parsed(self.text())?;
        edited.remove("clip");
        Ok(format!("{}\n\n[clip]\nfile = {file}\n", edited.to_string().trim_end()))
    }

    /// The scene as it is kept for a crash.
    pub fn kept(&self) -> KeptScene {
        KeptScene { path: settled(&self.path), on_disk: self.on_disk, text: self.text().to_owned() }
    }

    /// Opens a scene that was kept for a crash. It has unsaved changes.
    pub fn recovered(scene: &KeptScene) -> Result<Self, AppError> {
        let document = Self::new(&scene.path, scene.text.clone())?;
        Ok(Self { on_disk: scene.on_disk, ..document.never_saved() })
    }

    /// Writes the text to a file, atomically. If the folder changes, the paths of named files are adjusted,
    /// in earlier texts too.
    pub fn save(&mut self, path: &Path) -> Result<(), AppError> {
        let path = destination(path)?;
        let from = settled(&self.path);
        let move_to =
            |text: &str| text_in_folder(text, [&from, &path].map(|p| p.parent().unwrap_or(Path::new(""))));
        let text = move_to(&self.draft.text)?;
        atomically(&path, |out| out.write_all(text.as_bytes()))
            .map_err(|why| AppError::new(format!("{} could not be written: {why}", path.display())))?;
        self.history.rename(|text| move_to(text))?;
        self.parsed_text = table(&text)?;
        self.draft.text.clone_from(&text);
        (self.path, self.saved, self.on_disk) = (path, text, true);
        Ok(())
    }
}

/// Returns the text of a scene with the paths of named files, relative to one folder, rewritten relative to another.
///
/// # Errors
/// Returns an error if the text is not TOML.
pub fn text_in_folder(text: &str, [from, to]: [&Path; 2]) -> Result<String, AppError> {
    if from == to {
        return Ok(text.to_owned());
    }
    let mut edited = parsed(text)?;
    rename_files(edited.as_table_mut(), &|name| {
        let path = settled(&from.join(name));
        path.strip_prefix(to).map(Path::to_owned).unwrap_or(path)
    });
    Ok(edited.to_string())
}

/// The keys of a scene file whose text is the name of a file.
const FILE_KEYS: [&str; 7] = ["file", "rig", "weights", "bones", "vertex_cache", "texture", "values"];

/// Renames every file that a scene names: the texts of [`FILE_KEYS`].
fn rename_files(table: &mut dyn toml_edit::TableLike, rename: &dyn Fn(&str) -> PathBuf) {
    for (key, item) in table.iter_mut() {
        let names_file = FILE_KEYS.contains(&key.get());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Way;

    const SCENE: &str = "[[groom]]\nfile = \"a.hair\"\n\n[[collider]]\nshape.sphere = { center = [0.0, 1.0, 0.0], radius = 0.1 }\n";

    #[test]
    fn saving_in_another_folder_adjusts_the_paths_of_named_files_and_of_undo_steps() {
        let folder = tempfile::tempdir().unwrap();
        let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
        [&from, &to].into_iter().for_each(|path| std::fs::create_dir(path).unwrap());
        let mut document = Document::new(&from.join("scene.toml"), SCENE.into()).unwrap();
        document.set(&"gravity".parse().unwrap(), Some(Value::from_iter([0.0, -1.0, 0.0]))).unwrap();
        document.save(&from.join("../to/scene.toml")).unwrap();
        let real = folder.path().canonicalize().unwrap();
        assert_eq!(document.file(), Some(&*real.join("to/scene.toml")), "without `..`");
        let groom = real.join("from/a.hair").display().to_string();
        assert!(document.text().contains(&groom), "{}", document.text());
        assert!(document.step(Way::Back).is_ok() && !document.text().contains("gravity"));
        assert!(document.text().contains(&groom), "{}", document.text());
        document.save(&from.join("scene.toml")).unwrap();
        assert_eq!(document.text(), SCENE, "back where it was");
    }

    #[test]
    fn every_file_that_a_scene_names_is_renamed() {
        let scene = "[body]\nfile = \"a\"\nrig = \"a\"\nweights = \"a\"\nvertex_cache = \"a\"\n[builtin]\n\
                     maps = { density = { texture = \"a\" } }\n[[groom]]\nfile = \"a\"\nbones = \"a\"\n[groom.maps]\n\
                     length = { texture = \"a\" }\nbend = { values = \"a\" }\ndrag = { values = [1, 2] }\n[[collider]]\n\
                     shape.hull = { file = \"a\" }\n[clip]\nfile = \"a\"\n";
        let renamed = text_in_folder(scene, [Path::new("/from"), Path::new("/to")]).unwrap();
        assert_eq!(renamed, scene.replace("\"a\"", "\"/from/a\""));
    }

    #[cfg(unix)]
    #[test]
    fn a_saved_scene_is_as_readable_as_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let rights = |name: &str| folder.path().join(name).metadata().unwrap().permissions().mode();
        std::fs::write(folder.path().join("plain"), "").unwrap();
        let mut document = Document::new(&folder.path().join("scene.toml"), SCENE.into()).unwrap();
        document.save(&folder.path().join("saved.toml")).unwrap();
        assert_eq!(rights("saved.toml"), rights("plain"));
    }

    #[test]
    fn a_body_that_replaces_the_built_in_head_gets_a_coat_and_keeps_other_hair() {
        let head = "name = \"Built-in head\"\n[builtin]\nstyle = \"wavy\"\n\n[[collider]]\nshape.sphere = { center = [0.0, 1.0, 0.0], radius = 0.1 }\n";
        for (text, coat) in [(head, true), (SCENE, false)] {
            let document = Document::new("scene.toml".as_ref(), text.into()).unwrap();
            let text = document.with_body("\"b.obj\"").unwrap();
            let other = Document::new("scene.toml".as_ref(), text.clone()).unwrap();
            assert_eq!(other.settings().grooms.len(), 1, "{text}");
            assert_eq!(text.contains("[groom.grow]"), coat, "{text}");
            assert!(text.contains("collider") && !text.contains("uilt"), "{text}");
        }
    }
}
