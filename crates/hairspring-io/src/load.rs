//! Opening a file by its name.

use crate::{
    Character, Error, Motion, Problem, ReadOptions, Result, bvh, gltf, hair, obj,
    strands::Read,
    tfx, tfxbone, tfxmesh,
    units::{FileUnits, Subject, apply_to_body, extent, settle},
    usc,
};
use hairspring::{
    body::Body,
    groom::{Groom, Repairs, first_imprecise, sanitize},
};
use std::{io, path::Path};

/// The kinds of file that are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Cem Yuksel's `.hair`: a groom.
    Hair,
    /// TressFX `.tfx`: a groom.
    Tfx,
    /// USC-HairSalon's `.data`: a groom.
    Usc,
    /// TressFX `.tfxbone`: bones of a groom's roots.
    TfxBone,
    /// TressFX `.tfxmesh`: a skinned body.
    TfxMesh,
    /// Wavefront `.obj`: a body.
    Obj,
    /// `.gltf` or `.glb`: a body with motions.
    Gltf,
    /// Biovision `.bvh`: a motion.
    Bvh,
    /// `.toml`: a scene.
    Scene,
}

impl Format {
    /// Formats that hold a groom, and can be written.
    pub const GROOMS: [Format; 3] = [Format::Hair, Format::Tfx, Format::Usc];

    /// The format of a path's extension, upper and lower case alike; `None` for any other.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match extension.as_str() {
            "hair" => Self::Hair,
            "tfx" => Self::Tfx,
            "data" => Self::Usc,
            "tfxbone" => Self::TfxBone,
            "tfxmesh" => Self::TfxMesh,
            "obj" => Self::Obj,
            "gltf" | "glb" => Self::Gltf,
            "bvh" => Self::Bvh,
            "toml" => Self::Scene,
            _ => return None,
        })
    }

    /// Its usual extension, without the dot.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hair => "hair",
            Self::Tfx => "tfx",
            Self::Usc => "data",
            Self::TfxBone => "tfxbone",
            Self::TfxMesh => "tfxmesh",
            Self::Obj => "obj",
            Self::Gltf => "gltf",
            Self::Bvh => "bvh",
            Self::Scene => "toml",
        }
    }
}

/// What was read, and what is to be said about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// The content, in metres, Y up.
    pub value: T,
    /// The file's format.
    pub format: Format,
    /// Metres in one unit of the file [m].
    pub scale: f32,
    /// What was repaired in a groom; zero for anything else.
    pub repairs: Repairs,
    /// Guesses made and things left out, a sentence each, to be shown to the user.
    pub notes: Vec<String>,
}

/// Largest file that is read [bytes]: 4 GiB, some 300 million points.
const MAX_FILE: u64 = 4 << 30;

/// Reads a hairstyle from a `.hair`, `.tfx` or `.data` file and repairs it (`groom::sanitize`).
///
/// # Errors
/// A file that is missing, unreadable, of another kind, broken or without strands.
pub fn read_groom(path: &Path, options: &ReadOptions) -> Result<Loaded<Groom>> {
    let format = format_of(path, &Format::GROOMS, "a hairstyle")?;
    check_scale(path, options)?;
    let data = bytes_of(path)?;
    let read: std::result::Result<Read, Problem> = match format {
        Format::Hair => hair::read(&data),
        Format::Tfx => tfx::read(&data),
        _ => usc::read(&data),
    };
    let read = read.map_err(|p| p.in_file(path))?;
    if read.groom.strand_count() == 0 {
        return Err(Problem::whole("the file holds no strands").in_file(path));
    }
    let (mut groom, scale, notes) = read.finish(options);
    if let Some(far) = first_imprecise(&groom) {
        return Err(Problem::whole(far.to_string()).in_file(path));
    }
    let repairs = sanitize(&mut groom);
    Ok(Loaded { value: groom, format, scale, repairs, notes })
}

/// Reads a body from a `.gltf`, `.glb`, `.obj` or `.tfxmesh` file, with the motions that it holds.
///
/// # Errors
/// A file that is missing, unreadable, of another kind or broken.
pub fn read_body(path: &Path, options: &ReadOptions) -> Result<Loaded<Character>> {
    let format = format_of(path, &[Format::Gltf, Format::Obj, Format::TfxMesh], "a body")?;
    check_scale(path, options)?;
    let data = bytes_of(path)?;
    let mut units = FileUnits::default();
    let (mut character, mut notes) = match format {
        Format::Gltf => {
            // Metres and Y up by the specification (§3.4).
            units.scale = Some(1.0);
            gltf::parse(&data, &|name| sibling(path, name))
        }
        Format::Obj => obj::parse(&data).map(|mesh| (still(Body::rigid(mesh)), Vec::new())),
        _ => tfxmesh::parse(&data).map(|body| (still(body), Vec::new())),
    }
    .map_err(|p| p.in_file(path))?;
    let extent = extent(character.body.mesh.positions.iter().copied());
    let (scale, turn) = settle(options, units, Subject::Body, extent, &mut notes);
    apply_to_body(&mut character.body, &mut character.clips, scale, turn);
    Ok(Loaded { value: character, format, scale, repairs: Repairs::default(), notes })
}

/// Reads a motion from a `.bvh` file, or the animation called `name` (the first without one) from a `.gltf` or `.glb`.
///
/// # Errors
/// A file that is missing, unreadable, of another kind or broken, or an animation that is not there.
pub fn read_motion(path: &Path, name: Option<&str>, options: &ReadOptions) -> Result<Loaded<Motion>> {
    let format = format_of(path, &[Format::Bvh, Format::Gltf], "a motion")?;
    if format == Format::Bvh {
        check_scale(path, options)?;
        let data = bytes_of(path)?;
        let (mut motion, scale, notes) = bvh::read_in_metres(&data, options).map_err(|p| p.in_file(path))?;
        motion.clip.name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        return Ok(Loaded { value: motion, format, scale, repairs: Repairs::default(), notes });
    }
    let Loaded { value: character, scale, notes, .. } = read_body(path, options)?;
    let clip = pick_clip(&character.clips, name).map_err(|text| Problem::whole(text).in_file(path))?.clone();
    let motion = Motion { joints: character.body.joints, clip };
    Ok(Loaded { value: motion, format, scale, repairs: Repairs::default(), notes })
}

/// Reads the bones of a groom's roots from a `.tfxbone` file.
///
/// # Errors
/// A file that is missing, unreadable, of another kind or broken.
pub fn read_bones(path: &Path) -> Result<tfxbone::RootBones> {
    format_of(path, &[Format::TfxBone], "the bones of roots")?;
    tfxbone::parse(&bytes_of(path)?).map_err(|p| p.in_file(path))
}

/// The clip called `name` (upper and lower case alike), or the first; the sentence names those that there are.
pub(crate) fn pick_clip<'a>(
    clips: &'a [hairspring::body::Clip],
    name: Option<&str>,
) -> std::result::Result<&'a hairspring::body::Clip, String> {
    let found = match name {
        Some(name) => clips.iter().find(|c| c.name.eq_ignore_ascii_case(name)),
        None => clips.first(),
    };
    found.ok_or_else(|| {
        let known: Vec<&str> = clips.iter().map(|c| c.name.as_str()).collect();
        match name {
            Some(name) => format!("there is no motion called {name:?}; there are: {}", list(&known)),
            None => "the file holds no motion".into(),
        }
    })
}

/// Names in a sentence.
pub(crate) fn list(names: &[&str]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

fn still(body: Body) -> Character {
    Character { body, clips: Vec::new() }
}

/// The format of `path`, which must be among `known`.
fn format_of(path: &Path, known: &[Format], what: &str) -> Result<Format> {
    Format::of(path).filter(|f| known.contains(f)).ok_or_else(|| {
        let names: Vec<String> = known.iter().map(|f| format!(".{}", f.name())).collect();
        let reason = format!("{what} is read from {}, told by the extension", names.join(", "));
        Error::Unsupported { path: path.to_owned(), reason }
    })
}

fn check_scale(path: &Path, options: &ReadOptions) -> Result<()> {
    match options.scale {
        Some(s) if !(s.is_finite() && s > 0.0) => {
            let reason = format!("a scale of {s} metres a unit is not above 0");
            Err(Error::Unsupported { path: path.to_owned(), reason })
        }
        _ => Ok(()),
    }
}

/// All bytes of a file.
pub(crate) fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    let unreadable = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => Error::NotFound { path: path.to_owned(), why: String::new() },
        _ => Error::Unreadable { path: path.to_owned(), source },
    };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > MAX_FILE {
        let text = format!("the file has {size} bytes, more than the {MAX_FILE} that are read");
        return Err(Problem::limit(crate::Place::Whole, text).in_file(path));
    }
    std::fs::read(path).map_err(unreadable)
}

/// The bytes of a file beside `path`: in its folder or below, never above.
fn sibling(path: &Path, name: &str) -> Option<Vec<u8>> {
    let inside = Path::new(name).components().all(|c| matches!(c, std::path::Component::Normal(_)));
    let beside = path.parent().unwrap_or(Path::new("")).join(name);
    inside.then(|| bytes_of(&beside).ok()).flatten()
}
