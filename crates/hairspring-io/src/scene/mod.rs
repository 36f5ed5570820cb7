//! Scene files: TOML that describes grooms, a body, its motion and settings. `docs/scene.md` documents every
//! field.

mod air;
mod body;
mod body_unit;
mod builtin;
mod check;
mod collision;
mod exact_arrays;
mod expected;
mod file;
mod geometry;
mod groom;
mod groom_file;
mod grow;
mod hull_points;
mod implausible;
pub mod inactive;
mod map_file;
mod maps;
mod material;
mod motion;
mod namesakes;
pub mod parameters;
mod props;
mod sentence;
mod settings;
mod vertex_cache;

use crate::{
    Error, Format, Loaded, Problem, ReadOptions, Result, load,
    load::read_mesh,
    text::as_text,
    units::{UnitHint, WholeBody},
};
use exact_arrays::Exact;
use file::{FileName, SceneFile};
use glam::Affine3A;
use groom_file::GroomFile;
use hairspring::groom::Repairs;
use hairspring_scene::{Scene, Shape};
use sentence::{line_at, line_of_key, problem};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Reads a scene file and all files that it names, relative to its own folder.
///
/// # Errors
/// Returns an error for an unknown field (with its line and the most similar valid name), a value out of
/// range, a named file that is missing or malformed, or parts that do not fit together (a missing joint or
/// motion).
pub fn read_scene(path: &Path) -> Result<Loaded<Scene>> {
    read_scene_text(path, &scene_text(path)?)
}

/// Reads the text of a scene file, which is not checked.
///
/// # Errors
/// Returns an error if the file is missing, unreadable or of another kind.
pub fn scene_text(path: &Path) -> Result<String> {
    if Format::of(path) != Some(Format::Scene) {
        let reason = "unknown extension; a scene file ends in .toml".into();
        return Err(Error::Unsupported { path: path.to_owned(), reason });
    }
    let data = load::bytes_of(path)?;
    Ok(as_text(&data).into_owned())
}

/// Reads the text of a scene file that does not need to be saved, as if it were in `path`. Files are named
/// relative to the folder of `path`.
///
/// # Errors
/// See [`read_scene`].
pub fn read_scene_text(path: &Path, text: &str) -> Result<Loaded<Scene>> {
    let file = parse(text).map_err(|p| p.in_file(path))?;
    let mut reader = Reader::new(path, text, &file.groom);
    let mut scene = reader.settings(&file)?;
    reader.geometry(&file, &mut scene)?;
    reader.notes.extend(material::unused(&file));
    reader.notes.extend(implausible::notes(&file));
    reader.notes.extend(implausible::half_placed(text, &file));
    reader.notes.extend(inactive::notes(text, &file, &scene));
    let Reader { repairs, notes, .. } = reader;
    Ok(Loaded { value: scene, format: Format::Scene, scale: 1.0, repairs, notes: load::plain(notes) })
}

/// Reads only the settings of such a text, for `Stage::update_settings`. This is fast. The scene is that of
/// [`read_scene_text`] without its geometry: grooms have their materials, guides, effects and look, but no
/// strands, and there is no body, collision mesh, sheet or clip. The only files that are opened are those of
/// convex hulls of colliders, and that of the body if a hull's file has no unit, with those of grooms if they decide its
/// unit.
///
/// # Errors
/// See [`read_scene`], except for errors about other files and the body's joints.
pub fn read_settings(path: &Path, text: &str) -> Result<Scene> {
    let file = parse(text).map_err(|p| p.in_file(path))?;
    Reader::new(path, text, &file.groom).settings(&file)
}

/// Whether two texts of scene files differ only in what `Stage::update_settings` can apply, so that the hair,
/// the body and its motion are the same. Returns false if either text is not a valid scene file.
///
/// Geometry is more than the files: it includes a material's `radius`, because hair is drawn with it, as well
/// as `guides`, `solver.collide_body` and `solver.preroll`. The file of a hull is a setting.
pub fn same_geometry(a: &str, b: &str) -> bool {
    let (Ok(a_file), Ok(b_file)) = (parse(a), parse(b)) else { return false };
    match (geometry::asked(a, &a_file), geometry::asked(b, &b_file)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Checks the text of a scene file without reading the files that it names: whether all fields are known and
/// in range.
///
/// # Errors
/// See [`read_scene`], except for errors about other files.
pub fn check_text(text: &str) -> std::result::Result<(), Problem> {
    parse(text).map(|_| ())
}

fn parse(text: &str) -> std::result::Result<SceneFile, Problem> {
    let file = toml::Deserializer::parse(text).and_then(|from| SceneFile::deserialize(Exact(from)));
    let file = file.map_err(|e| problem(text, &e))?;
    check::ranges(text, &file)?;
    if let Some(named) = &file.builtin {
        builtin::settings(text, &file, named)?;
    }
    for groom in &file.groom {
        material::of_groom(text, &file, groom)?;
    }
    material::check_all(text, &file)?;
    Ok(file)
}

/// What to do about a name with a backslash, which is no separator, or that of an escape sequence.
fn backslash_hint(name: &Path) -> &'static str {
    let name = name.to_string_lossy();
    if name.contains(char::is_control) {
        "; a backslash in double quotes begins an escape sequence: write paths with / or in single quotes"
    } else if name.contains('\\') && !cfg!(windows) {
        "; write paths with /"
    } else {
        ""
    }
}

/// Reads the files that a scene file names.
struct Reader<'a> {
    path: &'a Path,
    text: &'a str,
    grooms: &'a [GroomFile],
    notes: Vec<String>,
    repairs: Repairs,
    /// The body, once its first file is read.
    whole: Option<WholeBody>,
    /// The files of the body and of its motion, whose motions may be played.
    played: Vec<PathBuf>,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path, text: &'a str, grooms: &'a [GroomFile]) -> Self {
        let (notes, repairs) = (Vec::new(), Repairs::default());
        Self { path, text, grooms, notes, repairs, whole: None, played: Vec::new() }
    }

    /// Returns the path of a file that the scene names.
    fn resolve(&self, name: &FileName) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name.get_ref())
    }

    /// Returns a reader's result for the file `name`. If the file is missing or of another kind, the error says what
    /// refers to it.
    fn named<T>(&self, result: Result<T>, name: &FileName, what: &str) -> Result<T> {
        let line = line_at(self.text, name.span().start);
        result.map_err(|error| match error {
            Error::NotFound { path, why } if why.is_empty() => {
                let scene = self.path.display();
                let hint = backslash_hint(name.get_ref());
                let why = format!("; {scene}, line {line}, names it as the {what}{hint}");
                Error::NotFound { path, why }
            }
            // The content of the scene is wrong.
            Error::Unsupported { reason, .. } => {
                let file = name.get_ref().display();
                Problem::line(line, format!("the {what} \"{file}\": {reason}")).in_file(self.path)
            }
            other => other,
        })
    }

    fn note(&mut self, file: &Path, notes: Vec<String>) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        for note in notes.into_iter().map(|note| format!("{name}: {note}")) {
            // A scene may name a file more than once.
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// Creates an error about the value of the first `key` after `near`.
    fn wrong(&self, near: usize, key: &str, text: String) -> Error {
        let from = line_at(self.text, near);
        Problem::line(line_of_key(self.text, from, key).unwrap_or(from), text).in_file(self.path)
    }

    /// Returns a shape that is named near byte `near`, with the points of a hull read from its file.
    fn shape(&mut self, named: &Shape, near: usize) -> Result<Shape> {
        let Shape::Hull { file: Some(file), scale, .. } = named else { return Ok(named.clone()) };
        let file = toml::Spanned::new(near..near, file.clone());
        let path = self.resolve(&file);
        let options = ReadOptions { scale: *scale, up: None };
        let hint = self.whole.map_or(UnitHint::None, |whole| UnitHint::PartOf(whole, Affine3A::IDENTITY));
        let loaded = self.named(read_mesh(&path, &options, hint), &file, "hull")?;
        self.note_unplayed(&file, &loaded.value, "hull");
        let vertices = loaded.value.body.mesh.positions;
        let (count, points) = (vertices.len(), hull_points::outermost(vertices));
        let mut notes = loaded.notes;
        if points.len() < count {
            notes.push(format!(
                "the hull of its {count} vertices is made of the {} outermost; use a mesh of at most {} vertices to choose them",
                points.len(),
                Shape::MAX_POINTS
            ));
        }
        self.note(&path, notes);
        let shape = Shape::Hull { points, file: None, scale: None };
        if shape.collider_shape().is_none() {
            let text = format!("the vertices of {} span no volume", path.display());
            return Err(self.wrong(near, "shape", text));
        }
        Ok(shape)
    }
}
