//! The fields of a scene file. Every field is optional unless it is marked as required.

use glam::{EulerRot, Quat, Vec3};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::Key,
    forces::charge::Charged,
    groom::{Growth, Thicken},
    settings::{Effects, Neighbours, Solver, Volume, Wind},
};
use hairspring_scene::{Camera, Collider, Ground, Guides, HairLook, Hand, Shape, deserialize_optional_color};
use serde::{Deserialize, Deserializer, de};
use std::{collections::BTreeMap, path::PathBuf};
use toml::Spanned;

use crate::Axis;

/// A file named in a scene, relative to the scene's folder, with its position in the text for messages.
pub(super) type FileName = Spanned<PathBuf>;

/// A whole scene file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    /// Name in reports. Default: the file's name.
    pub name: Option<String>,
    /// The procedural scene, used instead of `body`.
    pub builtin: Option<BuiltinFile>,
    /// Gravity [m/s²]. Default (0, −9.81, 0).
    #[serde(default = "earth")]
    pub gravity: Vec3,
    /// The mesh that is drawn and that hair grows on.
    pub body: Option<BodyFile>,
    /// A closed mesh that hair collides with instead of the body's own.
    pub collision: Option<BodyFile>,
    /// Open meshes that hair collides with on both sides.
    #[serde(default)]
    pub sheet: Vec<BodyFile>,
    /// Further simple shapes that hair collides with.
    #[serde(default)]
    pub collider: Vec<Collider>,
    /// Motion of the body.
    pub clip: Option<ClipFile>,
    /// Objects that move independently of the body.
    #[serde(default)]
    pub prop: Vec<PropFile>,
    /// The hairstyles. At least one is required, unless `builtin` is given.
    #[serde(default)]
    pub groom: Vec<GroomFile>,
    /// Materials by name: `preset`, then any fields of a material that override it.
    #[serde(default)]
    pub material: BTreeMap<String, Spanned<toml::Table>>,
    /// The uniform wind.
    #[serde(default)]
    pub wind: Wind,
    /// Local wind sources.
    #[serde(default)]
    pub wind_source: Vec<WindSource>,
    /// Turbulence.
    #[serde(default)]
    pub turbulence: Turbulence,
    /// Wind occlusion by bodies and by hair.
    #[serde(default)]
    pub wind_occlusion: WindOcclusion,
    /// Charged bodies.
    #[serde(default)]
    pub charged: Vec<Charged>,
    /// Time steps and contact.
    #[serde(default)]
    pub solver: Solver,
    /// Contact between hairs.
    #[serde(default)]
    pub volume: Volume,
    /// Contact between neighboring strands, one by one.
    #[serde(default)]
    pub neighbours: Neighbours,
    /// The camera. Default: framed automatically.
    pub camera: Option<Camera>,
    /// The ground in the picture.
    #[serde(default)]
    pub ground: Ground,
    /// Tools that act on the hair.
    #[serde(default)]
    pub hand: Vec<Hand>,
}

/// `[builtin]`: a bust with a head of hair. Other grooms, colliders and settings can be added.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BuiltinFile {
    /// The hairstyle, a preset's name. Default wavy.
    pub style: Option<Spanned<String>>,
    /// Hairs on the scalp; 0 for a bald head. Default 100,000.
    pub strands: Option<Spanned<u32>>,
    /// A number of guides, or "all". Default 2,000.
    #[serde(default, deserialize_with = "guides_or_default")]
    pub guides: Option<Guides>,
    /// Name of a `[material.NAME]` or a preset. Default: the style's.
    pub material: Option<OneOrMore>,
    /// Whether the head nods, turns and shakes if there is no `[clip]`. Default true.
    pub motion: Option<bool>,
    /// How the hair is drawn: any fields of a look. Default: the style's.
    pub look: Option<Spanned<toml::Table>>,
    /// Styling effects of its follow hairs.
    #[serde(default)]
    pub effects: Effects,
}

/// `[body]`, `[collision]` and `[[sheet]]`.
#[derive(PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyFile {
    /// `.glb`, `.gltf`, `.obj` or `.tfxmesh`. Required.
    pub file: FileName,
    /// Meters in one unit of the file [m]. Default: by the format, or guessed with a note.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default y.
    pub up: Option<Axis>,
    /// Names of the parts to keep. Default: all.
    pub parts: Option<Vec<String>>,
    /// MakeHuman rig (JSON) of an `.obj`; needs `weights`.
    pub rig: Option<FileName>,
    /// MakeHuman skin weights (JSON) of an `.obj`; needs `rig`.
    pub weights: Option<FileName>,
    /// Linear RGB color of the whole surface, 0 to 1. Default: the file's.
    #[serde(default, deserialize_with = "deserialize_optional_color")]
    pub color: Option<Vec3>,
    /// Roughness of the whole surface, 0 (glossy) to 1 (matte). Default: the file's.
    pub roughness: Option<f32>,
    /// `[collision]`, `[[sheet]]` and `more` only: the body's joint that moves a mesh without joints of its
    /// own. Default: the body's first joint.
    pub joint: Option<String>,
    /// Additional files of the same body: eyes, clothes, hands. They move with it, by the joints of the same
    /// names or by `joint`.
    #[serde(default)]
    pub more: Vec<BodyFile>,
    /// `[[sheet]]` only: distance that hair keeps from the mesh, on both sides [m]. Default 0.002.
    pub thickness: Option<f32>,
}

/// `[clip]`.
#[derive(PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClipFile {
    /// `.bvh`, `.glb` or `.gltf`. Default: the body's own motions.
    pub file: Option<FileName>,
    /// Name of the motion in a `.glb`. Default: the first.
    pub name: Option<String>,
    /// Meters in one unit of the file [m]. Default: by the format, or guessed with a note.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default: by the format, or guessed with a note.
    pub up: Option<Axis>,
    /// Frames per second of a `.bvh` file [Hz]. Default: by the file's frame time.
    pub rate: Option<f64>,
    /// First frame that is used, counted from 0. Default 0.
    #[serde(default)]
    pub start: usize,
    /// A joint of the motion, such as "Head", that drives the whole body as one rigid piece. Default: the
    /// joints of the motion move the body's joints of the same names.
    pub joint: Option<String>,
    /// Required with `joint`: the point of the body that it rotates around [m].
    pub pivot: Option<Vec3>,
    /// With `joint`: the frame in which the joint is at rest, counted from 0. Default: `start`.
    pub rest_frame: Option<usize>,
    /// With `joint`: how much of the motion through the world is kept: "keep", "in-place" (vertical only) or
    /// "none". Default "in-place".
    pub travel: Option<TravelName>,
    /// Used instead of `file`: the body is one rigid piece that moves from key to key, and is at rest at each
    /// key.
    #[serde(default)]
    pub keys: Vec<KeyFile>,
    /// With `joint`: direction that the body faces, as an angle around +Y from +Z [degrees]. Default 0.
    pub facing: Option<f32>,
}

/// One `[[prop]]`: an object that moves independently of the body.
#[derive(PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PropFile {
    /// Name of the joint that the prop adds to the body. Colliders, tools and the like use it to follow the
    /// prop. Required.
    pub name: String,
    /// The prop's mesh, at its position before it moves: any field of `body`. Default: the prop is invisible.
    pub mesh: Option<BodyFile>,
    /// The keys of its motion, as in `clip`. Default: it does not move.
    #[serde(default)]
    pub keys: Vec<KeyFile>,
    /// The point of the prop that it rotates around [m]. Default 0.
    #[serde(default)]
    pub pivot: Vec3,
}

/// A key of `[clip]` and of `[[prop]]`.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyFile {
    /// Time of the key [s]. Required, and later than that of the previous key.
    pub time: f32,
    /// Translation from the rest position [m]. Default 0.
    #[serde(default)]
    pub position: Vec3,
    /// Rotation around `pivot`: about X, then Y, then Z [degrees]. Default 0.
    #[serde(default)]
    pub rotation: Vec3,
}

impl KeyFile {
    /// Converts the entry to a key.
    pub(super) fn key(&self) -> Key {
        Key { time: self.time, position: self.position, rotation: turn(self.rotation) }
    }
}

/// A rotation about X, then Y, then Z [degrees].
pub(super) fn turn(degrees: Vec3) -> Quat {
    let [x, y, z] = degrees.to_array().map(f32::to_radians);
    Quat::from_euler(EulerRot::ZYX, z, y, x)
}

/// [`Travel`] with the names used in a scene file.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum TravelName {
    Keep,
    InPlace,
    None,
}

/// One `[[groom]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GroomFile {
    /// `.hair`, `.tfx` or `.data`. Required, unless `grow` is given.
    pub file: Option<FileName>,
    /// Hair grown from the body, used instead of a file.
    pub grow: Option<Spanned<GrowFile>>,
    /// Follow hairs added around each strand.
    #[serde(default)]
    pub thicken: Thicken,
    /// Meters in one unit of the file [m]. Default: by the format, or guessed with a note.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default: z for `.hair`, y otherwise.
    pub up: Option<Axis>,
    /// Whether the last point of each strand is its root. Default false.
    #[serde(default)]
    pub reverse: bool,
    /// Source of the color of a file with a color per point: "file" or "look". Default "file".
    #[serde(default)]
    pub colors: ColorSource,
    /// Placement of the hairstyle, applied after `scale` and `up`.
    #[serde(default)]
    pub transform: Placement,
    /// Name of a `[material.NAME]` or a preset, or a list of them, one per group. Default: a single fiber of
    /// human hair.
    pub material: Option<OneOrMore>,
    /// Which strands are simulated: a number, "all", or "file". Default "file".
    #[serde(default, deserialize_with = "guides")]
    pub guides: Guides,
    /// How it is drawn.
    #[serde(default)]
    pub look: HairLook,
    /// Styling effects of follow hairs.
    #[serde(default)]
    pub effects: Effects,
    /// `.tfxbone`: each root binds to skin that follows one of its bones. Needs a skinned body.
    pub bones: Option<FileName>,
}

/// Where the color of hair comes from if the groom's file has a color per point.
#[derive(Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ColorSource {
    #[default]
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
    reverse: bool,
    colors: ColorSource,
    transform: Placement,
    guides: Guides,
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
        }
    }

    /// The byte where the groom's source is named, for messages.
    pub(super) fn start(&self) -> usize {
        let grow = self.grow.as_ref().map(|g| g.span().start);
        self.file.as_ref().map(|f| f.span().start).or(grow).unwrap_or(0)
    }
}

/// `grow` of a groom: where hair grows, and how.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GrowFile {
    /// Names of the body parts that hair grows on. Default: all.
    pub parts: Option<Vec<String>>,
    /// The joint that the skin must follow most. Default: any.
    pub joint: Option<String>,
    /// A shape in the space of the body's rest pose. Hair grows only on skin inside it. Default: everywhere.
    pub inside: Option<Shape>,
    /// Number of strands. Default 1,000.
    pub strands: Option<u32>,
    /// Points per strand. Default 16.
    pub points: Option<u32>,
    /// Length of the longest strand [m]. Default 0.1.
    pub length: Option<f32>,
    /// How much shorter the shortest strand is, as a fraction from 0 to 1. Default 0.2.
    pub spread: Option<f32>,
    /// How far strands bend down, 0 (not at all) to 1 (tips point down). Default 0.5.
    pub fall: Option<f32>,
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

/// `transform` of a groom: scale, then rotation about X, Y and Z in this order, then translation.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Placement {
    /// Translation of the origin [m]. Default 0.
    pub position: Vec3,
    /// Rotation about X, then Y, then Z [degrees]. Default 0.
    pub rotation: Vec3,
    /// One factor, or one for each of x, y and z. A negative factor mirrors. Default 1.
    #[serde(deserialize_with = "factors")]
    pub scale: Vec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: Vec3::ZERO, rotation: Vec3::ZERO, scale: Vec3::ONE }
    }
}

/// A name or a list of names.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a material's name or a list of names")]
pub(super) enum OneOrMore {
    One(String),
    More(Vec<String>),
}

fn earth() -> Vec3 {
    Vec3::new(0.0, -9.81, 0.0)
}

/// A number of guides, `"all"` or `"file"`.
fn guides<'de, D: Deserializer<'de>>(from: D) -> Result<Guides, D::Error> {
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

/// Like [`guides`], for a table that may omit the field.
fn guides_or_default<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Guides>, D::Error> {
    guides(from).map(Some)
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
