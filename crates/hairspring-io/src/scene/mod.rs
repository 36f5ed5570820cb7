//! Scene files: TOML that names grooms, a body, its motion and settings (`docs/scene.md` shows every field).

mod air;
mod body;
mod builtin;
mod check;
mod file;
mod geometry;
mod groom;
mod grow;
mod material;
mod motion;
mod props;
mod sentence;
mod settings;

use crate::{Error, Format, Loaded, Problem, ReadOptions, Result, load, read_body, text::as_text};
use file::{FileName, SceneFile};
use hairspring::groom::Repairs;
use hairspring_scene::{Scene, Shape};
use sentence::{line_at, line_of_key, problem};
use std::path::{Path, PathBuf};

/// Reads a scene file and all files that it names, relative to its own folder.
///
/// # Errors
/// A field that is not known (with its line and the nearest right name), a value out of range, a named file that is
/// missing or broken, or parts that do not fit together (a joint or motion that is not there).
pub fn read_scene(path: &Path) -> Result<Loaded<Scene>> {
    if Format::of(path) != Some(Format::Scene) {
        let reason = "a scene is read from .toml, told by the extension".into();
        return Err(Error::Unsupported { path: path.to_owned(), reason });
    }
    let data = load::bytes_of(path)?;
    read_scene_text(path, &as_text(&data))
}

/// Reads the text of a scene file that need not be saved, as if it were in `path`: files are named relative to its folder.
///
/// # Errors
/// As [`read_scene`].
pub fn read_scene_text(path: &Path, text: &str) -> Result<Loaded<Scene>> {
    let file = parse(text).map_err(|p| p.in_file(path))?;
    let mut reader = Reader::new(path, text);
    let mut scene = reader.settings(&file)?;
    reader.geometry(&file, &mut scene)?;
    let Reader { repairs, notes, .. } = reader;
    Ok(Loaded { value: scene, format: Format::Scene, scale: 1.0, repairs, notes })
}

/// Reads the settings of such a text, at once: the scene of [`read_scene_text`] without its geometry, for `Stage::update_settings`. Grooms are there, with their
/// materials, guides, effects and look, and have no strands; there is no body, collision mesh, sheet or clip. No file is opened but those of
/// colliders' hulls.
///
/// # Errors
/// As [`read_scene`], but for what concerns other files and the body's joints.
pub fn read_settings(path: &Path, text: &str) -> Result<Scene> {
    let file = parse(text).map_err(|p| p.in_file(path))?;
    Reader::new(path, text).settings(&file)
}

/// Whether two texts of scene files that can both be read differ in nothing but what `Stage::update_settings` takes up: the hair, the body and its motion are the
/// same. False where one is no scene file.
///
/// Beside the files, a material's `radius` is geometry, because hair is drawn by it, and so are `guides`, `solver.collide_body` and `solver.preroll`. A hull's file is a
/// setting.
pub fn same_geometry(a: &str, b: &str) -> bool {
    let (Ok(a_file), Ok(b_file)) = (parse(a), parse(b)) else { return false };
    match (geometry::asked(a, &a_file), geometry::asked(b, &b_file)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Reads the text of a scene file without the files that it names: whether all fields are known and in range.
///
/// # Errors
/// As [`read_scene`], but for what concerns other files.
pub fn check_text(text: &str) -> std::result::Result<(), Problem> {
    parse(text).map(|_| ())
}

fn parse(text: &str) -> std::result::Result<SceneFile, Problem> {
    let file: SceneFile = toml::from_str(text).map_err(|e| problem(text, &e))?;
    check::ranges(text, &file)?;
    if let Some(named) = &file.builtin {
        builtin::settings(text, &file, named)?;
    }
    for groom in &file.groom {
        material::of_groom(text, &file, groom)?;
    }
    Ok(file)
}

/// Follows a scene file's names to their files.
struct Reader<'a> {
    path: &'a Path,
    text: &'a str,
    notes: Vec<String>,
    repairs: Repairs,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path, text: &'a str) -> Self {
        Self { path, text, notes: Vec::new(), repairs: Repairs::default() }
    }

    /// The path of a file that the scene names.
    fn resolve(&self, name: &FileName) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name.get_ref())
    }

    /// What a reader returned for the file `name`, with who asked for it if it is not there.
    fn named<T>(&self, result: Result<T>, name: &FileName, what: &str) -> Result<T> {
        result.map_err(|error| match error {
            Error::NotFound { path, .. } => {
                let line = line_at(self.text, name.span().start);
                let why = format!(": it is the {what} that {}, line {line}, names", self.path.display());
                Error::NotFound { path, why }
            }
            other => other,
        })
    }

    fn note(&mut self, file: &Path, notes: Vec<String>) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        self.notes.extend(notes.into_iter().map(|n| format!("{name}: {n}")));
    }

    /// The error that the value of the key nearest after `near` is wrong.
    fn wrong(&self, near: usize, key: &str, text: String) -> Error {
        let from = line_at(self.text, near);
        Problem::line(line_of_key(self.text, from, key).unwrap_or(from), text).in_file(self.path)
    }

    /// A shape that is named near byte `near`, with the points of a hull from its file.
    fn shape(&mut self, named: &Shape, near: usize) -> Result<Shape> {
        let Shape::Hull { file: Some(file), scale, .. } = named else { return Ok(named.clone()) };
        let file = toml::Spanned::new(near..near, file.clone());
        let path = self.resolve(&file);
        let loaded = self.named(read_body(&path, &ReadOptions { scale: *scale, up: None }), &file, "hull")?;
        self.note(&path, loaded.notes);
        let shape = Shape::Hull { points: loaded.value.body.mesh.positions, file: None, scale: None };
        if shape.obstacle().is_none() {
            let text = format!("the vertices of {} span no volume", path.display());
            return Err(self.wrong(near, "shape", text));
        }
        Ok(shape)
    }
}
