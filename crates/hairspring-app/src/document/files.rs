//! The files of a scene: saving, and adjusting the paths of named files.

use super::{Document, parsed, table, text_style::TextStyle};
use crate::{
    AppError,
    destination::{destination, settled},
    recovery::KeptScene,
};
use hairspring_io::{ErrorKind, Format, atomically, text_of};
use std::path::{Path, PathBuf};
use toml_edit::{Item, Value};

impl Document {
    /// The scene as it is kept for a crash.
    pub fn kept(&self) -> KeptScene {
        KeptScene { path: settled(&self.path), stored: self.stored.clone(), text: self.text().to_owned() }
    }

    /// Opens a scene that was kept for a crash. It has unsaved changes.
    pub fn recovered(scene: &KeptScene) -> Result<Self, AppError> {
        let document = Self::new(&scene.path, scene.text.clone())?;
        let style = scene.stored.as_deref().map(|content| TextStyle::split(content).0).unwrap_or_default();
        Ok(Self { stored: scene.stored.clone(), style, ..document.never_saved() })
    }

    /// Whether another program changed the file since it was read or saved here. A file that is gone does not count.
    pub fn is_changed_on_disk(&self) -> bool {
        self.stored.as_ref().is_some_and(|known| match text_of(&self.path) {
            Ok(now) => now != *known,
            Err(why) => why.kind() != ErrorKind::NotFound,
        })
    }

    /// Writes the text to a `.toml` file, atomically. If the folder changes, the paths of named files are adjusted,
    /// in earlier texts too.
    ///
    /// # Errors
    /// Returns an error for another extension, if another program changed the scene's own file, or if the file cannot be
    /// written.
    pub fn save(&mut self, path: &Path) -> Result<(), AppError> {
        if is_same_file(path, &self.path) && self.is_changed_on_disk() {
            return Err(AppError::new(format!(
                "{} was changed by another program since it was read; open it again, or save under another name",
                path.display()
            )));
        }
        self.save_over(path)
    }

    /// Like [`Document::save`], but also replaces a file that another program changed.
    pub fn save_over(&mut self, path: &Path) -> Result<(), AppError> {
        if Format::of(path) != Some(Format::Scene) {
            let path = path.display();
            return Err(AppError::new(format!(
                "{path}: a scene is written as .toml; choose a name that ends in .toml"
            )));
        }
        let path = destination(path)?;
        let from = settled(&self.path);
        let move_to =
            |text: &str| text_in_folder(text, [&from, &path].map(|p| p.parent().unwrap_or(Path::new(""))));
        let text = move_to(&self.draft.text)?;
        let content = self.style.content(&text);
        atomically(&path, |out| out.write_all(content.as_bytes()))
            .map_err(|why| AppError::new(format!("{} could not be written: {why}", path.display())))?;
        self.history.rename(|text| move_to(text))?;
        self.parsed_text = table(&text)?;
        self.draft.text.clone_from(&text);
        (self.path, self.saved, self.stored) = (path, text, Some(content));
        Ok(())
    }
}

/// Whether two paths lead to the same file, which exists.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
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
    fn a_scene_is_saved_as_toml_only() {
        let folder = tempfile::tempdir().unwrap();
        let groom = folder.path().join("a.hair");
        std::fs::write(&groom, "hair").unwrap();
        let mut document = Document::new(&folder.path().join("scene.toml"), SCENE.into()).unwrap();
        let why = document.save(&groom).unwrap_err().to_string();
        assert!(why.contains("a.hair: a scene is written as .toml"), "{why}");
        assert_eq!(std::fs::read_to_string(&groom).unwrap(), "hair");
    }

    #[test]
    fn a_file_that_another_program_changed_is_not_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, SCENE).unwrap();
        let mut document = Document::open(&path).unwrap();
        let gravity = "gravity".parse().unwrap();
        document.set(&gravity, Some(Value::from_iter([0.0, -1.0, 0.0]))).unwrap();
        document.save(&path).unwrap();
        let theirs = format!("# theirs\n{SCENE}");
        std::fs::write(&path, &theirs).unwrap();
        document.set(&gravity, Some(Value::from_iter([0.0, -2.0, 0.0]))).unwrap();
        let kept: KeptScene = toml::from_str(&toml::to_string(&document.kept()).unwrap()).unwrap();
        for document in [&mut document, &mut Document::recovered(&kept).unwrap()] {
            let why = document.save(&path).unwrap_err().to_string();
            assert!(why.contains("changed by another program") && document.is_changed(), "{why}");
        }
        assert_eq!(std::fs::read_to_string(&path).unwrap(), theirs);
        document.save_over(&path).unwrap();
        assert!(std::fs::read_to_string(&path).unwrap().contains("-2.0") && !document.is_changed_on_disk());
        // A file that is gone is written again.
        std::fs::remove_file(&path).unwrap();
        document.save(&path).unwrap();
    }

    #[test]
    fn a_saved_file_keeps_its_byte_order_mark_and_line_ends() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let content = format!("\u{feff}{}", SCENE.replace('\n', "\r\n"));
        std::fs::write(&path, &content).unwrap();
        let mut document = Document::open(&path).unwrap();
        assert_eq!(document.text(), SCENE);
        document.set(&"solver.substeps".parse().unwrap(), Some(3.into())).unwrap();
        let kept: KeptScene = toml::from_str(&toml::to_string(&document.kept()).unwrap()).unwrap();
        for document in [&mut Document::recovered(&kept).unwrap(), &mut document] {
            document.save_over(&path).unwrap();
            let saved = std::fs::read_to_string(&path).unwrap();
            assert_eq!(saved, format!("{content}\r\n[solver]\r\nsubsteps = 3\r\n"));
        }
    }

    #[cfg(unix)]
    #[test]
    fn saving_keeps_permissions_and_a_link_whose_folder_names_are_relative_to() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        std::fs::create_dir(&inner).unwrap();
        let (file, link) = (inner.join("real.toml"), folder.path().join("scene.toml"));
        std::fs::write(&file, SCENE).unwrap();
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o600)).unwrap();
        std::os::unix::fs::symlink("inner/real.toml", &link).unwrap();
        let mut document = Document::open(&link).unwrap();
        document.set(&"solver.substeps".parse().unwrap(), Some(3.into())).unwrap();
        document.save(&link).unwrap();
        assert!(link.is_symlink() && std::fs::read_to_string(&file).unwrap() == document.text());
        assert!(document.text().contains("\"a.hair\""), "{}", document.text());
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o600);
    }
}
