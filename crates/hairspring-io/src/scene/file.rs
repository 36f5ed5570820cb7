//! The fields of a scene file. Every field that is not said to be needed may be left out.

use glam::{EulerRot, Quat, Vec3};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::Key,
    forces::charge::Charged,
    groom::{Growth, Thicken},
    settings::{Effects, Neighbours, Solver, Volume, Wind},
};
use hairspring_scene::{Camera, Collider, Ground, Guides, HairLook, Hand, Shape};
use serde::{Deserialize, Deserializer, de};
use std::{collections::BTreeMap, path::PathBuf};
use toml::Spanned;

use crate::Axis;

/// A file named in a scene, relative to the scene's folder, with its place for messages.
pub(super) type FileName = Spanned<PathBuf>;

/// A whole scene file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    /// Shown in reports. Default: the file's name.
    pub name: Option<String>,
    /// The scene that is made by code, in place of `body`.
    pub builtin: Option<BuiltinFile>,
    /// Gravity [m/s²]. Default (0, −9.81, 0).
    #[serde(default = "earth")]
    pub gravity: Vec3,
    /// What is drawn and what hair grows on.
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
    /// Things beside the body that move by themselves.
    #[serde(default)]
    pub prop: Vec<PropFile>,
    /// The hairstyles; one is needed, or `builtin`.
    #[serde(default)]
    pub groom: Vec<GroomFile>,
    /// Materials by name: `preset`, then any field of a material over it.
    #[serde(default)]
    pub material: BTreeMap<String, Spanned<toml::Table>>,
    /// The wind of all points.
    #[serde(default)]
    pub wind: Wind,
    /// What blows besides.
    #[serde(default)]
    pub wind_source: Vec<WindSource>,
    /// Eddies in the air.
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
    /// How hair meets hair.
    #[serde(default)]
    pub volume: Volume,
    /// How strands meet their neighbours, one by one.
    #[serde(default)]
    pub neighbours: Neighbours,
    /// Where the scene is seen from. Default: framed automatically.
    pub camera: Option<Camera>,
    /// What it stands on in the picture.
    #[serde(default)]
    pub ground: Ground,
    /// What hands hold to the hair.
    #[serde(default)]
    pub hand: Vec<Hand>,
}

/// `[builtin]`: a bust with a head of hair, and further grooms, colliders and settings over it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BuiltinFile {
    /// The hairstyle, a preset's name. Default wavy.
    pub style: Option<Spanned<String>>,
    /// Hairs on the scalp. Default 100,000.
    pub strands: Option<Spanned<u32>>,
    /// A number of guides, or "all". Default 2,000.
    #[serde(default, deserialize_with = "guides_or_default")]
    pub guides: Option<Guides>,
    /// Name of a `[material.NAME]` or a preset. Default: the style's.
    pub material: Option<OneOrMore>,
    /// Whether it nods, turns and shakes where there is no `[clip]`. Default true.
    pub motion: Option<bool>,
    /// How the head of hair is drawn: any field of a look. Default: the style's.
    pub look: Option<Spanned<toml::Table>>,
    /// What is laid over its follow hairs.
    #[serde(default)]
    pub effects: Effects,
}

/// `[body]`, `[collision]` and `[[sheet]]`.
#[derive(PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyFile {
    /// `.glb`, `.gltf`, `.obj` or `.tfxmesh`; needed.
    pub file: FileName,
    /// Metres in one unit of the file [m]. Default: by the format, or guessed and said.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default y.
    pub up: Option<Axis>,
    /// Names of the parts to keep. Default: all.
    pub parts: Option<Vec<String>>,
    /// MakeHuman rig (JSON) of an `.obj`; needs `weights`.
    pub rig: Option<FileName>,
    /// MakeHuman skin weights (JSON) of an `.obj`; needs `rig`.
    pub weights: Option<FileName>,
    /// Linear RGB colour of the whole surface, 0 to 1. Default: the file's.
    pub color: Option<Vec3>,
    /// 0 (glossy) to 1 (matt), of the whole surface. Default: the file's.
    pub roughness: Option<f32>,
    /// `[collision]`, `[[sheet]]` and `more` only: the body's joint that carries a mesh without joints of its own. Default: the body's first.
    pub joint: Option<String>,
    /// Further files of the same body: eyes, clothes, hands. They move with it, by the joints of the same names or `joint`.
    #[serde(default)]
    pub more: Vec<BodyFile>,
    /// `[[sheet]]` only: how far hair stays from the mesh, on both sides [m]. Default 0.002.
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
    /// Metres in one unit of the file [m]. Default: by the format, or guessed and said.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default: by the format, or guessed and said.
    pub up: Option<Axis>,
    /// First frame that is used, counted from 0. Default 0.
    #[serde(default)]
    pub start: usize,
    /// A joint of the motion, such as "Head", that drives the whole body as one rigid piece. Default: joints move the body's joints of the same names.
    pub joint: Option<String>,
    /// With `joint`, needed: the point of the body that it turns about [m].
    pub pivot: Option<Vec3>,
    /// With `joint`: the frame in which the joint counts as being at rest, counted from 0. Default: `start`.
    pub rest_frame: Option<usize>,
    /// With `joint`: what is kept of the way through the world: "keep", "in-place" (bobbing only) or "none". Default "in-place".
    pub travel: Option<TravelName>,
    /// In place of `file`: the body is one rigid piece that goes from key to key, and is at rest at each.
    #[serde(default)]
    pub keys: Vec<KeyFile>,
    /// With `joint`: direction that the body faces, about +Y from +Z [degrees]. Default 0.
    pub facing: Option<f32>,
}

/// One `[[prop]]`: a thing beside the body that moves by itself.
#[derive(PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PropFile {
    /// The joint that it adds to the body's: what colliders, hands and the like name to go with it; needed.
    pub name: String,
    /// How it looks, where it is before it moves: any field of `body`. Default: nothing is seen of it.
    pub mesh: Option<BodyFile>,
    /// Its way, as that of `clip`. Default: it rests.
    #[serde(default)]
    pub keys: Vec<KeyFile>,
    /// The point of it that it turns about [m]. Default 0.
    #[serde(default)]
    pub pivot: Vec3,
}

/// A key of `[clip]` and of `[[prop]]`.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyFile {
    /// When [s]; needed, and after that of the key before.
    pub time: f32,
    /// How far from its rest it is [m]. Default 0.
    #[serde(default)]
    pub position: Vec3,
    /// How it is turned about `pivot`: about X, then Y, then Z [degrees]. Default 0.
    #[serde(default)]
    pub rotation: Vec3,
}

impl KeyFile {
    /// The key.
    pub(super) fn key(&self) -> Key {
        Key { time: self.time, position: self.position, rotation: turn(self.rotation) }
    }
}

/// A turn about X, then Y, then Z [degrees].
pub(super) fn turn(degrees: Vec3) -> Quat {
    let [x, y, z] = degrees.to_array().map(f32::to_radians);
    Quat::from_euler(EulerRot::ZYX, z, y, x)
}

/// [`Travel`] as a scene file names it.
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
    /// `.hair`, `.tfx` or `.data`; needed, or `grow`.
    pub file: Option<FileName>,
    /// Hair grown from the body, in place of a file.
    pub grow: Option<Spanned<GrowFile>>,
    /// Follow hairs added around each strand.
    #[serde(default)]
    pub thicken: Thicken,
    /// Metres in one unit of the file [m]. Default: by the format, or guessed and said.
    pub scale: Option<f32>,
    /// The axis that points up, "y" or "z". Default: z for `.hair`, y otherwise.
    pub up: Option<Axis>,
    /// Where the hairstyle stands, after `scale` and `up`.
    #[serde(default)]
    pub transform: Placement,
    /// Name of a `[material.NAME]` or a preset, or a list of them, one a group. Default: a lone fibre of human hair.
    pub material: Option<OneOrMore>,
    /// Which strands are simulated: a number, "all", or "file". Default "file".
    #[serde(default, deserialize_with = "guides")]
    pub guides: Guides,
    /// How it is drawn.
    #[serde(default)]
    pub look: HairLook,
    /// What is laid over follow hairs.
    #[serde(default)]
    pub effects: Effects,
    /// `.tfxbone`: each root binds to skin that follows one of its bones; needs a skinned body.
    pub bones: Option<FileName>,
}

/// What a groom's strands are made from.
#[derive(PartialEq)]
pub(super) struct GroomGeometry<'a> {
    files: [&'a Option<FileName>; 2],
    grow: Option<Grown<'a>>,
    thicken: Thicken,
    units: (Option<f32>, Option<Axis>),
    transform: Placement,
    guides: Guides,
}

impl GroomFile {
    /// What its strands are made from.
    pub(super) fn geometry(&self) -> GroomGeometry<'_> {
        GroomGeometry {
            files: [&self.file, &self.bones],
            grow: self.grow.as_ref().map(|grow| grow.get_ref().geometry()),
            thicken: self.thicken,
            units: (self.scale, self.up),
            transform: self.transform,
            guides: self.guides,
        }
    }

    /// The byte where the groom says what it is, for messages.
    pub(super) fn start(&self) -> usize {
        let grow = self.grow.as_ref().map(|g| g.span().start);
        self.file.as_ref().map(|f| f.span().start).or(grow).unwrap_or(0)
    }
}

/// `grow` of a groom: where hair grows, and how.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GrowFile {
    /// Names of the parts of the body that it grows on. Default: all.
    pub parts: Option<Vec<String>>,
    /// The joint that the skin must follow more than any other. Default: any.
    pub joint: Option<String>,
    /// A shape in the space of the body's rest pose: hair grows on skin inside it. Default: everywhere.
    pub inside: Option<Shape>,
    /// Strands. Default 1,000.
    pub strands: Option<u32>,
    /// Points of a strand. Default 16.
    pub points: Option<u32>,
    /// Longest strand [m]. Default 0.1.
    pub length: Option<f32>,
    /// How much shorter the shortest strand is, 0 to 1. Default 0.2.
    pub spread: Option<f32>,
    /// How far strands bend over, 0 (not) to 1 (tips point down). Default 0.5.
    pub fall: Option<f32>,
}

/// Where hair grows (parts, joint, shape), and how.
type Grown<'a> = (&'a Option<Vec<String>>, &'a Option<String>, &'a Option<Shape>, Growth);

impl GrowFile {
    /// All that it says.
    fn geometry(&self) -> Grown<'_> {
        (&self.parts, &self.joint, &self.inside, self.growth())
    }

    /// Its settings with the defaults for what is left out.
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

/// `transform` of a groom: scaled, then turned about X, Y and Z in this order, then moved.
#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Placement {
    /// Where its origin goes [m]. Default 0.
    pub position: Vec3,
    /// Turns about X, then Y, then Z [degrees]. Default 0.
    pub rotation: Vec3,
    /// Factor, or one each along x, y, z; below 0 mirrors. Default 1.
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

/// The same, where the table may be there without it.
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
