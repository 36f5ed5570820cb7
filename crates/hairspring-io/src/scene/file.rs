//! The fields of a scene file. Every field is optional unless it is marked as required.

use glam::{EulerRot, Quat, Vec3};
use hairspring::{
    air::{Turbulence, WindOcclusion, WindSource},
    body::Key,
    forces::charge::Charged,
    material::PRESETS,
    settings::{Effects, Neighbours, Setting, Solver, Volume, When, Wind, define_settings},
};
use hairspring_scene::{
    Camera, Collider, Ground, Guides, Hand, InitialContact, Picture, SceneSheet, deserialize_optional_color,
};
use serde::{Deserialize, Deserializer};
use std::{collections::BTreeMap, path::PathBuf};
use toml::Spanned;

use super::groom_file::{GroomFile, Placement, guides};
use super::map_file::MapsFile;
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
        gravity: Vec3 = earth(), ["m/s²"], {vector -10000 to 10000};
        /// The mesh that is drawn and that hair grows on.
        body: Option<BodyFile>, "none", {table};
        /// A closed mesh that hair collides with instead of the body's own.
        collision: Option<BodyFile>, "none", {text "a table with the fields of `[body]`, and `joint`"},
            default "the body's own mesh";
        /// Open meshes that hair collides with on both sides.
        #[serde(default)]
        sheet: Vec<BodyFile>, "none", {
            text "any number of tables with the fields of `[body]`, `joint`, `thickness` and `initial`"
        }, default "none";
        /// Further simple shapes that hair collides with.
        #[serde(default)]
        collider: Vec<Collider>, "none", {table};
        /// Motion of the body.
        clip: Option<ClipFile>, "none", {table};
        /// Objects with a motion of their own: in the world, or carried by a joint of the body.
        #[serde(default)]
        prop: Vec<PropFile>, "none", {table};
        /// The grooms. At least one is required, unless `builtin` is given.
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
        /// Backdrop, light and shutter of pictures.
        #[serde(default)]
        picture: Picture, "none", {table};
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
        /// Number of hairs on the scalp of the built-in head, 0 for a bald head. A human head has about 100,000. Fewer
        /// hairs are drawn wider, so that the scalp stays covered.
        strands: Option<Spanned<u32>> = 100_000, "strands", {0 to 10000000};
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
        /// Parameters that vary over the scalp, as `groom.maps`: textures or lists of numbers. The texture coordinates
        /// are those of the scalp seen from above: the crown is the middle, the face is below, and her left is on the
        /// right.
        #[serde(default)]
        maps: MapsFile, "none", {text "the fields of `groom.maps` without `comb` and `vertex_colors`"}, default "none";
    }
}

define_settings! {
    /// `[body]`, `[collision]` and `[[sheet]]`.
    #[derive(PartialEq)]
    file struct BodyFile {
        /// File of the mesh.
        file: FileName, "none", {text "`.glb`, `.gltf`, `.vrm`, `.obj`, `.tfxmesh`; with the Python package `.usd`, `.abc`"};
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
        #[serde(default, deserialize_with = "deserialize_optional_color")]
        color: Option<Vec3>, "linear RGB", {color}, default "the file's";
        /// Roughness of the whole surface, instead of the file's: 0 is glossy, 1 is matte.
        roughness: Option<f32>, "fraction", {0 to 1}, default "the file's";
        /// Position, rotation and scale of a mesh without joints, after `scale` and `up`. The mesh is scaled, then rotated,
        /// then moved.
        transform: Option<Placement>, "none", {text "a table with the fields of `groom.transform`"},
            default "none of them";
        /// `[body]` only: motion of its vertices, which must be those of the mesh, in its unit and axes.
        vertex_cache: Option<FileName>, "none", {text "`.pc2`, or numbered meshes such as `body.####.obj`"}, default "the file's own, or none";
        /// Frame rate of `vertex_cache`.
        vertex_rate: Option<f64> = 24.0, ["Hz"], {0.01 to 1000000}, when When::Given("body.vertex_cache");
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
        /// `[[sheet]]` only: what happens to hair that passes through the mesh before the scene begins. `keep`: it
        /// stays as it is. `push`: the mesh closes in on it from outside in a pre-roll of two seconds, or of
        /// `solver.preroll` if that is longer.
        initial: Option<InitialContact> = "keep", "none", {words <InitialContact as Setting>::WORDS};
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
        /// Frame rate of the motion file, instead of the one that it states.
        rate: Option<f64>, ["Hz"], {0.01 to 1000000}, default "from the file";
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
    /// One `[[prop]]`: an object with a motion of its own.
    #[derive(PartialEq)]
    file struct PropFile {
        /// Name of the joint that the prop adds to the body. Colliders, tools and the like use it to follow the
        /// prop.
        name: String, "none", {text "any text, except the name of another joint"};
        /// The prop's mesh, at its position before it moves. Without a mesh, the prop is invisible.
        mesh: Option<BodyFile>, "none", {text "a table with the fields of `[body]`"}, default "none";
        /// The body's joint that carries the prop. The keys move the prop relative to that joint. Its coordinates
        /// are those of the body at rest.
        joint: Option<String>, "none", {text "the name of a joint of the body or of a prop above"},
            default "none: the prop moves independently of the body";
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

/// A name or a list of names.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "expected a material's name, such as \"soft\", or a list of names; its settings are in a table of their own, such as [material.soft]"
)]
pub(super) enum OneOrMore {
    One(String),
    More(Vec<String>),
}

fn earth() -> Vec3 {
    Vec3::new(0.0, -9.81, 0.0)
}

/// Like [`guides`], for a table that may omit the field.
fn guides_or_default<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Guides>, D::Error> {
    guides(from).map(Some)
}
