//! Formats that a host program reads and writes: USD and Alembic, by the Python package.

use crate::{
    Axis, Character, Error, Format, Problem, ReadOptions, Result, load, motion::check_positions,
    strands::Read, units::FileUnits,
};
use hairspring::{groom::Groom, material::Material};
use std::{
    path::{Path, PathBuf},
    sync::{OnceLock, RwLock},
};

/// What an external reader returns: Y up, in meters if the unit is known.
pub struct ExternalFile<T> {
    /// The content.
    pub value: T,
    /// Whether the file states its unit, or the options do. Otherwise it is guessed.
    pub unit_known: bool,
    /// What was left out, one sentence each.
    pub notes: Vec<String>,
}

/// Why an external reader returns nothing, in a sentence without the name of the file.
#[derive(Clone, Debug)]
pub enum ExternalError {
    /// The file has nothing of the kind that was to be read.
    Absent(String),
    /// The content of the file is wrong.
    Invalid(String),
}

/// Reads and writes the formats of [`Format::EXTERNAL`]. Errors are sentences without the name of the file.
pub trait ExternalFormats: Send + Sync {
    /// Reads all curves of a file as one groom.
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn read_groom(
        &self,
        path: &Path,
        options: &ReadOptions,
    ) -> std::result::Result<ExternalFile<Groom>, ExternalError>;

    /// Reads the meshes of a file as one body.
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn read_body(
        &self,
        path: &Path,
        options: &ReadOptions,
    ) -> std::result::Result<ExternalFile<Character>, ExternalError>;

    /// Returns the other files that `path` consists of, such as the layers of a USD stage.
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn used_files(&self, path: &Path) -> std::result::Result<Vec<PathBuf>, String>;

    /// Begins to write strands that move to one file.
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn write_cache(
        &self,
        path: &Path,
        description: &CacheDescription,
    ) -> std::result::Result<Box<dyn CacheWriter>, String>;
}

/// What does not change in a file of strands that move.
#[derive(Clone, Debug, Default)]
pub struct CacheDescription {
    /// Frames per second [Hz].
    pub fps: f64,
    /// Number of the first frame.
    pub first_frame: f64,
    /// Number of samples.
    pub frames: u32,
    /// Samples per frame, 1 or more.
    pub per_frame: u32,
    /// The grooms, and their names.
    pub grooms: Vec<(String, Groom)>,
    /// Strands of each groom that are simulated; shape `[grooms][strands]`.
    pub guides: Vec<Vec<bool>>,
    /// Materials of each groom, one per group; shape `[grooms][groups]`.
    pub materials: Vec<Vec<Material>>,
    /// The scene or groom that was baked.
    pub source: String,
    /// USD file that the written one is an animated layer over.
    pub over: Option<PathBuf>,
}

/// A file of strands that move, one frame after the other. The file appears under its name when it is finished.
pub trait CacheWriter {
    /// Writes the points of all grooms at `frame`, one groom after the other [m], and their velocities [m/s].
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn frame(
        &mut self,
        frame: f64,
        points: &[glam::Vec3],
        velocities: &[glam::Vec3],
    ) -> std::result::Result<(), String>;

    /// Completes the file.
    ///
    /// # Errors
    /// Returns a sentence with the cause and the remedy.
    fn finish(self: Box<Self>) -> std::result::Result<(), String>;
}

static FORMATS: OnceLock<RwLock<Option<Box<dyn ExternalFormats>>>> = OnceLock::new();

/// Sets what reads and writes the external formats in this process. It replaces an earlier one.
pub fn set_external_formats(formats: Box<dyn ExternalFormats>) {
    *FORMATS.get_or_init(RwLock::default).write().unwrap_or_else(|e| e.into_inner()) = Some(formats);
}

/// Calls `act` with what reads and writes the external formats.
fn with_formats<T>(
    path: &Path,
    act: impl FnOnce(&dyn ExternalFormats) -> std::result::Result<T, String>,
) -> Result<T> {
    let formats = FORMATS.get_or_init(RwLock::default).read().unwrap_or_else(|e| e.into_inner());
    let unsupported = |reason: String| Error::Unsupported { path: path.to_owned(), reason };
    let Some(formats) = formats.as_deref() else {
        let reason = "USD and Alembic are read and written by the program of the Python package; install it with \
                      `pip install .[usd,alembic]`";
        return Err(unsupported(reason.into()));
    };
    act(formats).map_err(unsupported)
}

/// Reads a file, and records the content of all files that it consists of for a manifest.
fn read<T>(
    path: &Path,
    read: impl FnOnce(&dyn ExternalFormats) -> std::result::Result<T, ExternalError>,
) -> Result<T> {
    // Reports a missing file as for other formats.
    load::bytes_of(path)?;
    let wrong = |reason: String| Problem::whole(reason).in_file(path);
    let (value, files) = with_formats(path, |formats| Ok((read(formats), formats.used_files(path))))?;
    let value = value.map_err(|error| match error {
        ExternalError::Absent(reason) => Error::Unsupported { path: path.to_owned(), reason },
        ExternalError::Invalid(reason) => wrong(reason),
    })?;
    let own = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    for file in files.map_err(wrong)?.iter().filter(|file| **file != own) {
        // By its place from the folder of `path`, which may be relative.
        let rest = own.parent().and_then(|folder| file.strip_prefix(folder).ok());
        load::bytes_of(&rest.map_or_else(|| file.clone(), |rest| path.with_file_name(rest)))?;
    }
    Ok(value)
}

/// Reads a groom, with its unit still to be guessed if it is not known.
pub(crate) fn read_groom(path: &Path, options: &ReadOptions) -> Result<Read> {
    let ExternalFile { value, unit_known, notes } = read(path, |formats| formats.read_groom(path, options))?;
    let mut groom = value;
    let radii = Some(std::mem::take(&mut groom.radii)).filter(|radii| !radii.is_empty());
    Ok(Read { groom, radii, true_radii: false, units: units(unit_known), notes })
}

/// Reads a body, with its unit still to be guessed if it is not known.
pub(crate) fn read_body(path: &Path, options: &ReadOptions) -> Result<(Character, FileUnits, Vec<String>)> {
    let ExternalFile { value, unit_known, notes } = read(path, |formats| formats.read_body(path, options))?;
    checked(&value).map_err(|problem| problem.in_file(path))?;
    Ok((value, units(unit_known), notes))
}

/// Checks that all positions of a body are finite.
fn checked(character: &Character) -> std::result::Result<(), Problem> {
    if let Some(vertex) = character.body.mesh.positions.iter().position(|p| !p.is_finite()) {
        let text = format!("vertex {vertex} is not finite; correct the mesh and export it again");
        return Err(Problem::whole(text));
    }
    character.vertex_cache.as_ref().map_or(Ok(()), |cache| check_positions(&cache.frames))
}

/// External readers apply the options that are given, and turn the content to Y up.
fn units(known: bool) -> FileUnits {
    FileUnits { scale: known.then_some(1.0), up: Some(Axis::Y) }
}

/// Checks whether there is a writer for a file of moving strands.
///
/// # Errors
/// Returns an error for another extension, or without a writer for the format.
pub fn check_cache_format(path: &Path) -> Result<()> {
    match Format::of(path) {
        Some(Format::Pc2) => Ok(()),
        _ => with_formats(path, |_| Ok(())),
    }
}

/// Begins to write strands that move to one file: `.pc2`, or an external format.
///
/// # Errors
/// Returns an error for another extension, without a writer for the format, or if the file cannot be written.
pub fn write_cache(path: &Path, description: &CacheDescription) -> Result<Box<dyn CacheWriter>> {
    match Format::of(path) {
        Some(Format::Pc2) => {
            let writer = crate::pc2::Writer::create(path, description);
            writer
                .map(|w| Box::new(w) as Box<dyn CacheWriter>)
                .map_err(|reason| Error::Unwritable { path: path.to_owned(), reason })
        }
        _ => with_formats(path, |formats| formats.write_cache(path, description)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hairspring::body::{Body, Mesh};
    use hairspring_scene::VertexCache;

    #[test]
    fn positions_that_are_not_finite_are_refused() {
        let body = |position: Vec3, frames: Option<Vec<Vec<Vec3>>>| Character {
            body: Body::rigid(Mesh { positions: vec![Vec3::ZERO, position], ..Mesh::default() }),
            vertex_cache: frames.map(|frames| VertexCache { rate: 24.0, frames }),
            ..Character::default()
        };
        let error = |body| checked(&body).unwrap_err().text;
        let good = vec![Vec3::ZERO, Vec3::X];
        assert_eq!(checked(&body(Vec3::X, None)), Ok(()));
        assert_eq!(checked(&body(Vec3::X, Some(vec![good.clone()]))), Ok(()));
        assert!(error(body(Vec3::NAN, None)).starts_with("vertex 1 is not finite"));
        let broken = vec![good, vec![Vec3::INFINITY, Vec3::X]];
        assert!(error(body(Vec3::X, Some(broken))).starts_with("vertex 0 of sample 1 is not finite"));
        assert!(error(body(Vec3::X, Some(vec![]))).starts_with("the file has no samples"));
    }
}
