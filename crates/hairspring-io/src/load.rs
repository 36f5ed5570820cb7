//! Opens a file; its extension selects the format.

use crate::{
    Character, Error, Motion, Problem, ReadOptions, Result, bvh,
    bytes::{open_regular, read_regular},
    clip_choice::{first_note, pick_clip},
    contents, csv, external, gltf, hair, obj, ply,
    repair_notes::{Lost, repair_notes, strands_without_points},
    strands::Read,
    strays::give_up_far_strands,
    text, tfx, tfxbone, tfxmesh,
    units::{FileUnits, FitUnit, UnitHint, apply_to_body, settle},
    unused_vertices, usc,
};
use hairspring::{
    body::Body,
    groom::{Groom, Repairs, first_imprecise, sanitize},
};
use std::{io, path::Path};

/// The supported kinds of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Cem Yuksel's `.hair`: a groom.
    Hair,
    /// TressFX `.tfx`: a groom.
    Tfx,
    /// USC-HairSalon's `.data`: a groom.
    Usc,
    /// TressFX `.tfxbone`: the bones that a groom's roots follow.
    TfxBone,
    /// TressFX `.tfxmesh`: a skinned body.
    TfxMesh,
    /// Wavefront `.obj`: a body, or a groom of polylines.
    Obj,
    /// `.gltf`, `.glb` or `.vrm`: a body with motions, or a groom of lines.
    Gltf,
    /// Biovision `.bvh`: a motion.
    Bvh,
    /// `.usd`, `.usda`, `.usdc` or `.usdz`: grooms and bodies that move, by the Python package.
    Usd,
    /// Alembic `.abc`: grooms and bodies that move, by the Python package.
    Alembic,
    /// `.pc2`: positions of points over time.
    Pc2,
    /// `.csv`: a groom as a table of points.
    Csv,
    /// `.ply`: a groom of polylines.
    Ply,
    /// `.toml`: a scene.
    Scene,
}

impl Format {
    /// All formats.
    const ALL: [Format; 14] = [
        Format::Hair,
        Format::Tfx,
        Format::Usc,
        Format::TfxBone,
        Format::TfxMesh,
        Format::Obj,
        Format::Gltf,
        Format::Bvh,
        Format::Usd,
        Format::Alembic,
        Format::Pc2,
        Format::Csv,
        Format::Ply,
        Format::Scene,
    ];

    /// Formats that hold a groom. These can also be written.
    pub const GROOMS: [Format; 3] = [Format::Hair, Format::Tfx, Format::Usc];

    /// Other formats that a groom is read from: curves or tables of points.
    pub const CURVES: [Format; 4] = [Format::Obj, Format::Csv, Format::Ply, Format::Gltf];

    /// Formats that the Python package reads and writes.
    pub const EXTERNAL: [Format; 2] = [Format::Usd, Format::Alembic];

    /// Returns the format for a path's extension, ignoring case; `None` for an unknown extension.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|format| format.extensions().contains(&extension.as_str()))
    }

    /// Returns the format's usual extension, without the dot.
    pub fn name(self) -> &'static str {
        self.extensions()[0]
    }

    /// Returns all extensions of the format, without the dot.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Hair => &["hair"],
            Self::Tfx => &["tfx"],
            Self::Usc => &["data"],
            Self::TfxBone => &["tfxbone"],
            Self::TfxMesh => &["tfxmesh"],
            Self::Obj => &["obj"],
            Self::Gltf => &["gltf", "glb", "vrm"],
            Self::Bvh => &["bvh"],
            Self::Usd => &["usd", "usda", "usdc", "usdz"],
            Self::Alembic => &["abc"],
            Self::Pc2 => &["pc2"],
            Self::Csv => &["csv"],
            Self::Ply => &["ply"],
            Self::Scene => &["toml"],
        }
    }
}

/// The content of a file, with notes about how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// The content, in meters, Y up.
    pub value: T,
    /// The file's format.
    pub format: Format,
    /// Meters in one unit of the file [m].
    pub scale: f32,
    /// What was repaired in a groom; zero for other content.
    pub repairs: Repairs,
    /// What was guessed and what was left out, one sentence each, to be shown to the user.
    pub notes: Vec<String>,
}

/// Largest file that is read [bytes]: 4 GiB, about 300 million points.
const MAX_FILE: u64 = 4 << 30;

/// Largest text that a program reads as a whole [bytes]: 64 MiB, about a million lines.
const MAX_TEXT: u64 = 64 << 20;

/// Returns whether a file of a format for meshes holds a groom: an `.obj` file with polylines and no face before them, or
/// a glTF file whose primitives are all lines. A file that cannot be read holds none.
pub fn holds_only_curves(path: &Path) -> bool {
    let held = match Format::of(path) {
        Some(Format::Obj) => obj::holds_polylines,
        Some(Format::Gltf) => gltf::holds_only_lines,
        _ => return false,
    };
    bytes_of(path).is_ok_and(|data| held(&data))
}

/// Reads a groom from a `.hair`, `.tfx`, `.data` or `.csv` file, or from the curves of an `.obj`, `.ply`, `.gltf`
/// or `.glb` file, and repairs it (`groom::sanitize`).
///
/// # Errors
/// Returns an error if the file is missing, unreadable, of another kind, malformed or without strands.
pub fn read_groom(path: &Path, options: &ReadOptions) -> Result<Loaded<Groom>> {
    read_groom_on(path, options, None)
}

/// Like [`read_groom`], on a body that helps to guess the unit.
pub(crate) fn read_groom_on(
    path: &Path,
    options: &ReadOptions,
    fit: Option<FitUnit<'_>>,
) -> Result<Loaded<Groom>> {
    let known = [&Format::GROOMS[..], &Format::CURVES, &Format::EXTERNAL].concat();
    let format = format_of(path, &known, "a groom")?;
    check_scale(path, options)?;
    let external = Format::EXTERNAL.contains(&format);
    let read: Read = if external {
        external::read_groom(path, options)?
    } else {
        let data = bytes_of(path)?;
        match format {
            Format::Hair => hair::read(&data, options.up),
            Format::Tfx => tfx::read(&data),
            Format::Obj => obj::read_groom(&data),
            Format::Csv => csv::read(&data),
            Format::Ply => ply::read(&data),
            Format::Gltf => gltf::read_groom(&data, &|name| sibling(path, name)),
            _ => usc::read(&data),
        }
        .map_err(|p| p.in_file(path))?
    };
    // External readers have already applied the options.
    let options = if external { &ReadOptions::default() } else { options };
    let (mut groom, scale, notes) = match read.groom.strand_count() {
        0 => (read.groom, 1.0, Vec::new()),
        _ => read.finish(options, fit),
    };
    let lost = Lost { far: give_up_far_strands(&mut groom), pointless: strands_without_points(&groom) };
    check_groom(path, &groom)?;
    let repairs = sanitize(&mut groom);
    let notes = notes.into_iter().chain(repair_notes(&groom, &repairs, &lost)).collect();
    Ok(Loaded { value: groom, format, scale, repairs, notes: plain(notes) })
}

/// Checks that a groom has strands with points, near enough to the origin.
fn check_groom(path: &Path, groom: &Groom) -> Result<()> {
    if groom.strand_count() == 0 {
        return Err(Problem::whole("the file holds no strands").in_file(path));
    }
    if !groom.points.iter().any(|p| p.is_finite()) {
        let text = "no strand has a finite point; export the hair again";
        return Err(Problem::whole(text).in_file(path));
    }
    match first_imprecise(groom) {
        Some(far) => Err(Problem::whole(far.to_string()).in_file(path)),
        None => Ok(()),
    }
}

/// Reads a body from a `.gltf`, `.glb`, `.vrm`, `.obj` or `.tfxmesh` file, with the motions that it holds.
///
/// # Errors
/// Returns an error if the file is missing, unreadable, of another kind or malformed, or if its mesh has no
/// triangles or no size.
pub fn read_body(path: &Path, options: &ReadOptions) -> Result<Loaded<Character>> {
    read_mesh(path, options, UnitHint::None)
}

/// Like [`read_body`]. `hint` helps to guess the unit of the file.
pub(crate) fn read_mesh(path: &Path, options: &ReadOptions, hint: UnitHint<'_>) -> Result<Loaded<Character>> {
    let loaded = read_character(path, options, hint)?;
    if loaded.value.body.mesh.triangles.is_empty() {
        let text = match holds_only_curves(path) {
            // Lines that are wrong are so for a groom, too.
            true => {
                gltf::read_groom(&bytes_of(path)?, &|name| sibling(path, name))
                    .map_err(|p| p.in_file(path))?;
                "the file has lines but no triangles, so it is no body; name it as a groom"
            }
            false => "the file has no triangles, so it is no body; export a mesh with faces",
        };
        // What a glTF file hides or leaves out is the cause.
        let notes = loaded.notes.iter().filter(|_| loaded.format == Format::Gltf);
        let noted: String = notes.map(|note| format!(" ({note})")).collect();
        return Err(Problem::whole(format!("{text}{noted}")).in_file(path));
    }
    let mesh = &loaded.value.body.mesh;
    let mut corners = mesh.triangles.iter().flatten().map(|v| mesh.positions[*v as usize]);
    let first = corners.next();
    if corners.all(|corner| Some(corner) == first) {
        let text = "all vertices of its triangles are at one place, so it has no size; export it again";
        return Err(Problem::whole(text).in_file(path));
    }
    Ok(loaded)
}

/// Reads a body, which may have joints and motions but no mesh.
fn read_character(path: &Path, options: &ReadOptions, hint: UnitHint<'_>) -> Result<Loaded<Character>> {
    let known = [&[Format::Gltf, Format::Obj, Format::TfxMesh], &Format::EXTERNAL[..]].concat();
    let format = format_of(path, &known, "a body")?;
    check_scale(path, options)?;
    if Format::EXTERNAL.contains(&format) {
        let (character, units, notes) = external::read_body(path, options)?;
        return Ok(in_meters(character, format, &ReadOptions::default(), units, hint, notes));
    }
    let data = bytes_of(path)?;
    let mut units = FileUnits::default();
    let (character, notes) = match format {
        Format::Gltf => {
            // The specification requires meters and Y up (§3.4).
            units.scale = Some(1.0);
            gltf::parse(&data, &|name| sibling(path, name))
        }
        Format::Obj => obj::parse_with_notes(&data).map(|(mut mesh, mut notes)| {
            notes.extend(unused_vertices::keep_inside(&mut mesh));
            (still(Body::rigid(mesh)), notes)
        }),
        _ => tfxmesh::parse(&data).map(|body| (still(body), Vec::new())),
    }
    .map_err(|p| p.in_file(path))?;
    Ok(in_meters(character, format, options, units, hint, notes))
}

/// Converts a body to meters and Y up.
fn in_meters(
    mut character: Character,
    format: Format,
    options: &ReadOptions,
    units: FileUnits,
    hint: UnitHint<'_>,
    mut notes: Vec<String>,
) -> Loaded<Character> {
    let (scale, turn) = settle(options, units, &character.body.mesh, hint, &mut notes);
    apply_to_body(&mut character.body, &mut character.clips, scale, turn);
    character.morphs.convert(scale, turn);
    if let Some(cache) = &mut character.vertex_cache {
        cache.frames.iter_mut().flatten().for_each(|p| *p = turn * (*p * scale));
    }
    let parts = character.body.mesh.parts.iter_mut().map(|part| &mut part.name);
    let joints = character.body.joints.iter_mut().map(|joint| &mut joint.name);
    make_printable(parts.chain(joints));
    Loaded { value: character, format, scale, repairs: Repairs::default(), notes: plain(notes) }
}

/// Reads a motion from a `.bvh` file, or the animation called `name` from a `.gltf` or `.glb` file. If `name`
/// is `None`, the first animation is read.
///
/// # Errors
/// Returns an error if the file is missing, unreadable, of another kind or malformed, or if there is no such
/// animation.
pub fn read_motion(path: &Path, name: Option<&str>, options: &ReadOptions) -> Result<Loaded<Motion>> {
    read_motion_at(path, name, options, None)
}

/// Like [`read_motion`]. `rate` replaces the frame rate of a `.bvh` file [Hz].
pub(crate) fn read_motion_at(
    path: &Path,
    name: Option<&str>,
    options: &ReadOptions,
    rate: Option<f64>,
) -> Result<Loaded<Motion>> {
    let format = format_of(path, &[Format::Bvh, Format::Gltf], "a motion")?;
    if format == Format::Bvh {
        check_scale(path, options)?;
        let data = bytes_of(path)?;
        let read = bvh::read_in_meters(&data, options, rate);
        let (mut motion, scale, notes) = read.map_err(|p| p.in_file(path))?;
        motion.clip.name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        make_printable(motion.joints.iter_mut().map(|joint| &mut joint.name).chain([&mut motion.clip.name]));
        return Ok(Loaded { value: motion, format, scale, repairs: Repairs::default(), notes: plain(notes) });
    }
    let Loaded { value: mut character, scale, mut notes, .. } =
        read_character(path, options, UnitHint::None)?;
    let clip = pick_clip(&character.clips, name).map_err(|text| Problem::whole(text).in_file(path))?;
    notes.extend(first_note(&character.clips, name).map(|note| text::name(&note)));
    if character.morphs.moves(clip) {
        notes.push(
            "its animated morph targets are left out, because they move only the body of their own file; name the file as the body, too"
                .into(),
        );
    }
    let motion = Motion { joints: character.body.joints, clip: character.clips.swap_remove(clip) };
    Ok(Loaded { value: motion, format, scale, repairs: Repairs::default(), notes })
}

/// Reads the bones that a groom's roots follow from a `.tfxbone` file.
///
/// # Errors
/// Returns an error if the file is missing, unreadable, of another kind or malformed.
pub fn read_bones(path: &Path) -> Result<tfxbone::RootBones> {
    format_of(path, &[Format::TfxBone], "root bones")?;
    let mut bones = tfxbone::parse(&bytes_of(path)?).map_err(|p| p.in_file(path))?;
    make_printable(bones.names.iter_mut());
    Ok(bones)
}

/// Joins names for a sentence.
pub(crate) fn list(names: &[&str]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

fn still(body: Body) -> Character {
    Character { body, ..Character::default() }
}

/// Returns the format of `path`, which must be one of `known`.
fn format_of(path: &Path, known: &[Format], what: &str) -> Result<Format> {
    Format::of(path).filter(|f| known.contains(f)).ok_or_else(|| {
        let names: Vec<String> =
            known.iter().flat_map(|f| f.extensions()).map(|extension| format!(".{extension}")).collect();
        let reason = format!("unknown extension; {what} is read from {}", names.join(", "));
        Error::Unsupported { path: path.to_owned(), reason }
    })
}

fn check_scale(path: &Path, options: &ReadOptions) -> Result<()> {
    match options.scale {
        Some(s) if !(s.is_finite() && s > 0.0) => {
            let reason = format!("the scale must be above 0, but is {s}");
            Err(Error::Unsupported { path: path.to_owned(), reason })
        }
        _ => Ok(()),
    }
}

/// Checks that a path leads to a regular file that can be opened: a pipe would wait for a writer, and a device has
/// no end.
///
/// # Errors
/// Returns an error that says what the path leads to instead.
pub fn check_file(path: &Path) -> Result<()> {
    open_regular(path).map(drop).map_err(|source| unreadable(path, source))
}

/// Reads all bytes of a regular file, at most 4 GiB. Its content must not be of another kind than its extension.
///
/// # Errors
/// Returns an error if the file is missing, larger, of another kind, or cannot be read; see [`check_file`].
pub fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    let data = any_bytes_of(path)?;
    contents::check(path, &data).map_err(|p| p.in_file(path))?;
    Ok(data)
}

/// Reads all bytes of a regular file.
fn any_bytes_of(path: &Path) -> Result<Vec<u8>> {
    let data = at_most(path, MAX_FILE)?;
    crate::observe::report(path, &data);
    Ok(data)
}

/// Reads a regular file of text in UTF-8, at most 64 MiB.
///
/// # Errors
/// Returns an error if the file is missing, larger, no such text, or cannot be read; see [`check_file`].
pub fn text_of(path: &Path) -> Result<String> {
    let not_text = |_| Problem::whole("the file is not text in UTF-8; save it as such").in_file(path);
    String::from_utf8(at_most(path, MAX_TEXT)?).map_err(not_text)
}

/// Reads a regular file of at most `limit` bytes.
fn at_most(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let data = read_regular(path, limit).map_err(|source| unreadable(path, source))?;
    data.ok_or_else(|| {
        let text = format!("the file is larger than the limit of {limit} bytes; split it");
        Problem::limit(crate::Place::Whole, text).in_file(path)
    })
}

fn unreadable(path: &Path, source: io::Error) -> Error {
    let path = path.to_owned();
    match source.kind() {
        io::ErrorKind::NotFound => Error::NotFound { path, why: String::new() },
        _ => Error::Unreadable { path, source },
    }
}

/// Reads a file next to `path`: in its folder or below, never above.
fn sibling(path: &Path, name: &str) -> Option<Vec<u8>> {
    if !Path::new(name).components().all(|c| matches!(c, std::path::Component::Normal(_))) {
        return None;
    }
    any_bytes_of(&path.with_file_name(name)).ok()
}

/// Escapes the characters of names that control a terminal.
pub(crate) fn make_printable<'a>(names: impl IntoIterator<Item = &'a mut String>) {
    for name in names {
        if let std::borrow::Cow::Owned(shown) = text::printable(name) {
            *name = shown;
        }
    }
}

/// Returns notes without the characters of a file that control a terminal.
pub(crate) fn plain(notes: Vec<String>) -> Vec<String> {
    notes.into_iter().map(|note| text::name(&note)).collect()
}
