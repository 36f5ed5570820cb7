//! The fields of a scene file. Every field is optional unless it is marked as required.

use glam::{EulerRot, Quat, Vec3};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::Key,
    forces::charge::Charged,
    groom::{Growth, Thicken},
    material::PRESETS,
    settings::{Effects, Neighbours, Solver, Volume, When, Wind, define_settings},
};
use hairspring_scene::{Camera, Collider, Ground, Guides, HairLook, Hand, SceneSheet, Shape};
use serde::{Deserialize, Deserializer, de};
use std::{collections::BTreeMap, path::PathBuf};
use toml::Spanned;

use crate::Axis;

/// A file named in a scene, relative to the scene's folder, with its position in the text for messages.
pub(super) type FileName = Spanned<PathBuf>;

define_settings! {
    /// A whole scene file.
    file struct SceneFile {
        /// Name in reports.
        name: Option<String>, "none", {text "any text"}, default "the file's name";
        /// The procedural scene, used instead of `body`.
        builtin: Option<BuiltinFile>, "none", {table};
        /// Direction and magnitude of gravity. With a sag-free start, hair is in static balance under any gravity:
        /// it keeps its shape and only swings differently. To see it give way, turn `solver.sag_free` off.
        #[serde(default = "earth")]
        gravity: Vec3 = earth(), ["m/s²"], {vector};
        /// The mesh that is drawn and that hair grows on.
        body: Option<BodyFile>, "none", {table};
        /// A closed mesh that hair collides with instead of the body's own.
        collision: Option<BodyFile>, "none", {text "a table with the fields of `[body]`, and `joint`"},
            default "the body's own mesh";
        /// Open meshes that hair collides with on both sides.
        #[serde(default)]
        sheet: Vec<BodyFile>, "none", {
            text "any number of tables with the fields of `[body]`, `joint` and `thickness`"
        }, default "none";
        /// Further simple shapes that hair collides with.
        #[serde(default)]
        collider: Vec<Collider>, "none", {table};
        /// Motion of the body.
        clip: Option<ClipFile>, "none", {table};
        /// Objects that move independently of the body.
        #[serde(default)]
        prop: Vec<PropFile>, "none", {table};
        /// The hairstyles. At least one is required, unless `builtin` is given.
        #[serde(default)]
        groom: Vec<GroomFile>, "none", {table};
        /// Materials by name: `preset`, then any fields of a material that override it.
        #[serde(default)]
        material: BTreeMap<String, Spanned<toml::Table>>, "none", {table};
        /// The uniform wind.
        #[serde(default)]
        wind: Wind, "none", {table};
        /// Local wind sources.
        #[serde(default)]
        wind_source: Vec<WindSource>, "none", {table};
        /// Turbulence.
        #[serde(default)]
        turbulence: Turbulence, "none", {table};
        /// Wind occlusion by bodies and by hair.
        #[serde(default)]
        wind_occlusion: WindOcclusion, "none", {table};
        /// Charged bodies.
        #[serde(default)]
        charged: Vec<Charged>, "none", {table};
        /// Time steps and contact.
        #[serde(default)]
        solver: Solver, "none", {table};
        /// Contact between hairs.
        #[serde(default)]
        volume: Volume, "none", {table};
        /// Contact between neighboring strands, one by one.
        #[serde(default)]
        neighbours: Neighbours, "none", {table};
        /// The camera. By default, the scene is framed automatically.
        camera: Option<Camera>, "none", {table};
        /// The ground in the picture.
        #[serde(default)]
        ground: Ground, "none", {table};
        /// Tools that act on the hair.
        #[serde(default)]
        hand: Vec<Hand>, "none", {table};
    }
}

define_settings! {
    /// `[builtin]`: a bust with a head of hair. Other grooms, colliders and settings can be added.
    file struct BuiltinFile {
        /// Hairstyle of the built-in head. It sets cut, wave, color and material together.
        style: Option<Spanned<String>> = "wavy", "none", {words &PRESETS};
        /// Number of hairs on the scalp of the built-in head. A human head has about 100,000. Fewer hairs are drawn
        /// wider, so that the scalp stays covered.
        strands: Option<Spanned<u32>> = 100_000, "strands", {1 to 10000000};
        /// Number of simulated hairs. The other hairs follow up to three of them.
        #[serde(default, deserialize_with = "guides_or_default")]
        guides: Option<Guides> = 2_000, "strands", {text "1 or more, or `\"all\"`"};
        /// Name of a `[material.NAME]` or a preset.
        material: Option<OneOrMore>, "none", {text "the name of a `[material.NAME]` or of a preset"},
            default "the style's own preset";
        /// Whether the built-in head nods, turns and shakes when the scene has no motion of its own.
        motion: Option<bool> = true, "none", {switch}, when When::HasNot("clip");
        /// How the hair is drawn.
        look: Option<Spanned<toml::Table>>, "none", {text "the fields of `groom.look`"}, default "the style's";
        /// Styling effects of its follow hairs.
        #[serde(default)]
        effects: Effects, "none", {text "the fields of `groom.effects`"}, default "none of them";
    }
}

define_settings! {
    /// `[body]`, `[collision]` and `[[sheet]]`.
    #[derive(PartialEq)]
    file struct BodyFile {
        /// File of the mesh.
        file: FileName, "none", {text "`.glb`, `.gltf`, `.obj`, `.tfxmesh`"};
        /// Size of one unit of the file.
        scale: Option<f32>, ["m"], {above 0}, default "from the format, or guessed and reported";
        /// The axis that points up.
        up: Option<Axis> = "y", "none", {words &["y", "z"]};
        /// Names of the parts to keep.
        parts: Option<Vec<String>>, "none", {text "names of parts of the file"}, default "all";
        /// MakeHuman rig of an `.obj`.
        rig: Option<FileName>, "none", {text "a MakeHuman rig (JSON); needs `weights`"}, default "none";
        /// MakeHuman skin weights of an `.obj`.
        weights: Option<FileName>, "none", {text "MakeHuman skin weights (JSON); needs `rig`"}, default "none";
        /// Color of the whole surface, instead of the file's.
        color: Option<Vec3>, "linear RGB", {color}, default "the file's";
        /// Roughness of the whole surface, instead of the file's: 0 is glossy, 1 is matte.
        roughness: Option<f32>, "fraction", {0 to 1}, default "the file's";
        /// `[collision]`, `[[sheet]]` and `more` only: the body's joint that moves a mesh without joints of its
        /// own.
        joint: Option<String>, "none", {text "the name of a joint of the body"}, default "the body's first";
        /// Additional files of the same body: eyes, clothes, hands. They move with it, by the joints of the same
        /// names or by `joint`.
        #[serde(default)]
        more: Vec<BodyFile>, "none", {text "any number of tables with the fields of `[body]`, and `joint`"},
            default "none";
        /// `[[sheet]]` only: distance that hair keeps from the mesh, on both sides.
        thickness: Option<f32> = SceneSheet::THICKNESS, ["m"], {above 0};
    }
}

define_settings! {
    /// `[clip]`.
    #[derive(PartialEq)]
    file struct ClipFile {
        /// File of the motion.
        file: Option<FileName>, "none", {text "`.bvh`, `.glb`, `.gltf`"}, default "the body's own motions";
        /// Name of the motion in a `.glb`.
        name: Option<String>, "none", {text "the name of a motion"}, default "the first";
        /// Size of one unit of the file.
        scale: Option<f32>, ["m"], {above 0}, default "from the format, or guessed and reported";
        /// The axis that points up.
        up: Option<Axis>, "none", {words &["y", "z"]}, default "from the format, or guessed and reported";
        /// First frame of the motion file that is used.
        #[serde(default)]
        start: usize = 0, "frame index, from 0", {text "0 or more"};
        /// A joint of the motion, such as "Head", that drives the whole body as one rigid piece.
        joint: Option<String>, "none", {text "the name of a joint of the motion"},
            default "joints move the body joints of the same names";
        /// The point of the body that it rotates around.
        pivot: Option<Vec3>, ["m"], {vector}, default "the origin with `keys`; required with `joint`";
        /// Frame in which the joint that drives the body counts as being at rest.
        rest_frame: Option<usize>, "frame index, from 0", {text "0 or more"}, default "`start`", when DRIVEN;
        /// How much of the motion through the world is kept. `in-place`: only the vertical motion.
        travel: Option<TravelName> = "in-place", "none", {words &["keep", "in-place", "none"]}, when DRIVEN;
        /// Keys of a motion that is used instead of a file: the body is one rigid piece that moves from key to key,
        /// and is at rest at each key.
        #[serde(default)]
        keys: Vec<KeyFile> = [0.0; 0], "list", {text "in order of `time`, from 0 to 3600 [s]"};
        /// Direction that the body faces, as an angle around +Y from +Z.
        facing: Option<f32> = 0.0, ["degrees"], {finite}, when DRIVEN;
    }
}

/// The condition under which the options of a rigid body that a joint drives have an effect.
const DRIVEN: When = When::Given("clip.joint");

define_settings! {
    /// One `[[prop]]`: an object that moves independently of the body.
    #[derive(PartialEq)]
    file struct PropFile {
        /// Name of the joint that the prop adds to the body. Colliders, tools and the like use it to follow the
        /// prop.
        name: String, "none", {text "any text, except the name of another joint"};
        /// The prop's mesh, at its position before it moves. Without a mesh, the prop is invisible.
        mesh: Option<BodyFile>, "none", {text "a table with the fields of `[body]`"}, default "none";
        /// The keys of its motion, as in `clip`. Without keys, it does not move.
        #[serde(default)]
        keys: Vec<KeyFile> = [0.0; 0], "list", {text "in order of `time`, from 0 to 3600 [s]"};
        /// The point of the prop that it rotates around.
        #[serde(default)]
        pivot: Vec3 = Vec3::ZERO, ["m"], {vector};
    }
}

define_settings! {
    /// A key of `[clip]` and of `[[prop]]`.
    #[derive(Clone, Copy, PartialEq)]
    file struct KeyFile {
        /// Time of the key. Each key is later than the one before.
        time: f32, ["s"], {0 to 3600};
        /// Translation from the rest position.
        #[serde(default)]
        position: Vec3 = Vec3::ZERO, ["m"], {vector};
        /// Rotation around `pivot`: about X, then Y, then Z.
        #[serde(default)]
        rotation: Vec3 = Vec3::ZERO, ["degrees"], {vector};
    }
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

define_settings! {
    /// One `[[groom]]`.
    file struct GroomFile {
        /// File of the strands.
        file: Option<FileName>, "none", {text "`.hair`, `.tfx`, `.data`"}, default "required, or `grow`";
        /// Hair grown from the body, used instead of a file.
        grow: Option<Spanned<GrowFile>>, "none", {table};
        /// Follow hairs added around each strand.
        #[serde(default)]
        thicken: Thicken, "none", {table};
        /// Size of one unit of the file.
        scale: Option<f32>, ["m"], {above 0}, default "from the format, or guessed and reported";
        /// The axis that points up.
        up: Option<Axis>, "none", {words &["y", "z"]}, default "`\"z\"` for `.hair`, `\"y\"` otherwise";
        /// Placement of the hairstyle, applied after `scale` and `up`.
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
        /// File of bones: each root binds to skin that follows one of its bones. Needs a skinned body.
        bones: Option<FileName>, "none", {text "`.tfxbone`"}, default "none";
    }
}

/// The inputs that determine a groom's strands.
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
    /// Returns the inputs that determine the groom's strands.
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
    /// `transform` of a groom: scale, then rotation about X, Y and Z in this order, then translation.
    #[derive(Clone, Copy, PartialEq)]
    #[serde(default)]
    file struct Placement {
        /// Position of the hairstyle, applied after scale and rotation.
        position: Vec3 = Vec3::ZERO, ["m"], {vector};
        /// Rotation of the hairstyle about X, then Y, then Z.
        rotation: Vec3 = Vec3::ZERO, ["degrees"], {vector};
        /// Scale of the hairstyle: one factor, or one for each of x, y and z. Negative values mirror.
        #[serde(deserialize_with = "factors")]
        scale: Vec3 = 1.0, "factor", {text "finite and not 0"};
    }
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
