//! The fields of a `[[groom]]`.

use super::file::{FileName, OneOrMore, turn};
use super::map_file::MapsFile;
use crate::Axis;
use glam::{Affine3A, Vec3};
use hairspring::{
    groom::{Growth, Thicken},
    settings::{Effects, define_settings},
};
use hairspring_scene::{Guides, HairLook, Shape};
use serde::{Deserialize, Deserializer, de};
use toml::Spanned;

define_settings! {
    /// One `[[groom]]`.
    file struct GroomFile {
        /// Name of the groom in lists.
        name: Option<String>, "none", {text "any text"}, default "the file's name";
        /// File of the strands.
        file: Option<FileName>, "none", {text "`.hair`, `.tfx`, `.data`, `.obj`, `.csv`, `.ply`, `.glb`, `.gltf`; with the Python package `.usd`, `.abc`"}, default "required, or `grow`";
        /// Hair grown from the body, used instead of a file.
        grow: Option<Spanned<GrowFile>>, "none", {table};
        /// Follow hairs added around each strand.
        #[serde(default)]
        thicken: Thicken, "none", {table};
        /// Size of one unit of the file.
        scale: Option<f32>, ["m"], {above 0}, default "from the format, or guessed and reported";
        /// The axis that points up.
        up: Option<Axis>, "none", {words &["y", "z"]}, default "`\"z\"` for `.hair`, `\"y\"` otherwise";
        /// Whether the last point of each strand is its root. `nearest`: of each strand whose last point is
        /// nearer to the skin than the first.
        #[serde(default, deserialize_with = "reverse")]
        reverse: Reverse = false, "none", {text "`true`, `false`, `\"nearest\"`"};
        /// Source of the color of a file that has a color per point: the file, or `look`.
        colors: Option<ColorSource>, "none", {words &["file", "look"]}, default "`\"file\"`";
        /// Placement of the groom, applied after `scale` and `up`.
        #[serde(default)]
        transform: Placement, "none", {table};
        /// Name of a `[material.NAME]` or a preset, or a list of them, one per group.
        material: Option<OneOrMore>, "none", {
            text "the name of a `[material.NAME]` or of a preset, or a list of them, one per group of the file"
        }, default "a single human hair";
        /// Number of simulated hairs. The other hairs follow up to three of them. Too few guides move hair in
        /// slabs; many cost time. `file`: the guides that the groom's file names.
        #[serde(default, deserialize_with = "guides")]
        guides: Guides, "strands", {text "1 or more, `\"all\"`, `\"file\"`"},
            default "`\"file\"`: the file's own, or 2,000";
        /// How it is drawn.
        #[serde(default)]
        look: HairLook, "none", {table};
        /// Styling effects of follow hairs.
        #[serde(default)]
        effects: Effects, "none", {table};
        /// Parameters that vary over the scalp: `bend`, `damping`, `drag`, `friction`, `charge`, `global_shape`,
        /// `radius`, `flatness`, `tether`, `length`, `density`, `comb`.
        #[serde(default)]
        maps: MapsFile, "none", {
            text "a table of maps; each has a `texture`, `vertex_colors = true` or `values`, and may have `channel`, `low` and `high`"
        }, default "none";
        /// File of bones: each root binds to skin that follows one of its bones. Needs a skinned body.
        bones: Option<FileName>, "none", {text "`.tfxbone`"}, default "none";
    }
}

/// Which strands of a file have their root at the last point.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) enum Reverse {
    #[default]
    None,
    All,
    /// Those that end nearer to the skin than they begin.
    Nearest,
}

/// Where the color of hair comes from if the groom's file has a color per point.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ColorSource {
    File,
    Look,
}

/// The inputs that determine a groom's strands.
#[derive(PartialEq)]
pub(super) struct GroomGeometry<'a> {
    files: [&'a Option<FileName>; 2],
    grow: Option<Grown<'a>>,
    thicken: Thicken,
    units: (Option<f32>, Option<Axis>),
    reverse: Reverse,
    colors: Option<ColorSource>,
    transform: Placement,
    guides: Guides,
    maps: &'a MapsFile,
}

impl GroomFile {
    /// Returns the inputs that determine the groom's strands.
    pub(super) fn geometry(&self) -> GroomGeometry<'_> {
        GroomGeometry {
            files: [&self.file, &self.bones],
            grow: self.grow.as_ref().map(|grow| grow.get_ref().geometry()),
            thicken: self.thicken,
            units: (self.scale, self.up),
            reverse: self.reverse,
            colors: self.colors,
            transform: self.transform,
            guides: self.guides,
            maps: &self.maps,
        }
    }

    /// The byte where the groom's source is named, for messages.
    pub(super) fn start(&self) -> usize {
        let grow = self.grow.as_ref().map(|g| g.span().start);
        self.file.as_ref().map(|f| f.span().start).or(grow).unwrap_or(0)
    }
}

define_settings! {
    /// `grow` of a groom: where hair grows, and how. [`Growth`] defines its other parameters.
    file struct GrowFile {
        /// Names of the body parts that hair grows on.
        parts: Option<Vec<String>>, "none", {text "names of parts of the body"}, default "all";
        /// The joint that the skin must follow most.
        joint: Option<String>, "none", {text "the name of a joint of the body"}, default "any";
        /// A shape in the space of the body's rest pose. Hair grows only on skin inside it.
        inside: Option<Shape>, ["m"], {text "a shape, as in `[[collider]]`"}, default "everywhere";
        /// See [`Growth`].
        strands: Option<u32>, "none", {table};
        /// See [`Growth`].
        points: Option<u32>, "none", {table};
        /// See [`Growth`].
        length: Option<f32>, "none", {table};
        /// See [`Growth`].
        spread: Option<f32>, "none", {table};
        /// See [`Growth`].
        fall: Option<f32>, "none", {table};
    }
}

/// Where hair grows (parts, joint, shape), and how.
type Grown<'a> = (&'a Option<Vec<String>>, &'a Option<String>, &'a Option<Shape>, Growth);

impl GrowFile {
    /// Returns all its fields.
    fn geometry(&self) -> Grown<'_> {
        (&self.parts, &self.joint, &self.inside, self.growth())
    }

    /// Returns the settings, with defaults for the fields that are left out.
    pub(super) fn growth(&self) -> Growth {
        let base = Growth::default();
        Growth {
            strands: self.strands.unwrap_or(base.strands),
            points: self.points.unwrap_or(base.points),
            length: self.length.unwrap_or(base.length),
            spread: self.spread.unwrap_or(base.spread),
            fall: self.fall.unwrap_or(base.fall),
        }
    }
}

define_settings! {
    /// `transform` of a groom or a mesh: scale, then rotation about X, Y and Z in this order, then translation.
    #[derive(Clone, Copy, PartialEq)]
    #[serde(default)]
    file struct Placement {
        /// Position of the groom, applied after scale and rotation.
        position: Vec3 = Vec3::ZERO, ["m"], {vector};
        /// Rotation of the groom about X, then Y, then Z.
        rotation: Vec3 = Vec3::ZERO, ["degrees"], {vector};
        /// Scale of the groom: one factor, or one for each of x, y and z. Negative values mirror.
        #[serde(deserialize_with = "factors")]
        scale: Vec3 = 1.0, "factor", {text "finite and not 0"};
    }
}

impl Placement {
    /// Returns the transform.
    pub(super) fn to_affine(self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, turn(self.rotation), self.position)
    }
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: Vec3::ZERO, rotation: Vec3::ZERO, scale: Vec3::ONE }
    }
}

/// A number of guides, `"all"` or `"file"`.
pub(super) fn guides<'de, D: Deserializer<'de>>(from: D) -> Result<Guides, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number of guides above 0, \"all\" or \"file\"")]
    enum Named {
        Count(u32),
        Name(String),
    }
    match Named::deserialize(from)? {
        Named::Count(n) if n > 0 => Ok(Guides::Count(n)),
        Named::Name(name) if name == "all" => Ok(Guides::All),
        Named::Name(name) if name == "file" => Ok(Guides::FromGroom),
        _ => Err(de::Error::custom("expected a number of guides above 0, \"all\" or \"file\"")),
    }
}

/// `true`, `false` or `"nearest"`.
fn reverse<'de, D: Deserializer<'de>>(from: D) -> Result<Reverse, D::Error> {
    const EXPECTED: &str = "expected true, false or \"nearest\"";
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected true, false or \"nearest\"")]
    enum Named {
        Switch(bool),
        Name(String),
    }
    match Named::deserialize(from)? {
        Named::Switch(false) => Ok(Reverse::None),
        Named::Switch(true) => Ok(Reverse::All),
        Named::Name(name) if name == "nearest" => Ok(Reverse::Nearest),
        Named::Name(_) => Err(de::Error::custom(EXPECTED)),
    }
}

/// One factor, or three.
fn factors<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a factor or three of them")]
    enum Factor {
        One(f32),
        Three(Vec3),
    }
    Ok(match Factor::deserialize(from)? {
        Factor::One(x) => Vec3::splat(x),
        Factor::Three(v) => v,
    })
}
