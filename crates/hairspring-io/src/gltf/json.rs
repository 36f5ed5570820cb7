//! The parts of a glTF document that this reader uses (glTF 2.0 §5). Everything else is skipped while the text
//! is parsed: textures, cameras, lights, extras, attributes and extensions of exporters. A file is therefore
//! never refused because of an object that is not used here.

mod animation;

use crate::Problem;
pub(super) use animation::{Animation, Interpolation, Path};
use serde::{Deserialize, de::IgnoredAny};

/// A document.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    pub scene: Option<usize>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub skins: Vec<Skin>,
    #[serde(default)]
    pub animations: Vec<Animation>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<View>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    #[serde(default)]
    extensions: DocumentExtensions,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Default, Deserialize)]
struct DocumentExtensions {
    /// A VRM 0.x avatar. Version 1.0 is `VRMC_vrm`.
    #[serde(rename = "VRM")]
    vrm: Option<IgnoredAny>,
}

impl Document {
    /// Whether the file is a VRM 0.x avatar, which looks along -Z. All others look along +Z, as glTF does (§3.4).
    pub(super) fn looks_backward(&self) -> bool {
        self.extensions.vrm.is_some()
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    /// The version that a reader must know.
    min_version: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub name: Option<String>,
    #[serde(default)]
    pub children: Vec<usize>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub weights: Option<Vec<f32>>,
    /// Boxed, because few nodes have one and a file may have many nodes.
    pub matrix: Option<Box<[f32; 16]>>,
    pub translation: Option<[f32; 3]>,
    pub rotation: Option<[f32; 4]>,
    pub scale: Option<[f32; 3]>,
    #[serde(default)]
    extensions: NodeExtensions,
}

#[derive(Default, Deserialize)]
struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
    #[serde(rename = "KHR_node_visibility")]
    visibility: Option<Visibility>,
}

#[derive(Deserialize)]
struct Instancing {
    #[serde(default)]
    attributes: Instances,
}

/// Accessors of the transforms of a node's copies (`EXT_mesh_gpu_instancing`).
#[derive(Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct Instances {
    pub translation: Option<usize>,
    pub rotation: Option<usize>,
    pub scale: Option<usize>,
}

#[derive(Deserialize)]
struct Visibility {
    visible: Option<bool>,
}

impl Node {
    /// The copies of its mesh that the node draws in the place of one.
    pub(super) fn instances(&self) -> Option<&Instances> {
        self.extensions.instancing.as_ref().map(|instancing| &instancing.attributes)
    }

    /// Whether the node is drawn, with what is below it.
    pub(super) fn is_visible(&self) -> bool {
        self.extensions.visibility.as_ref().and_then(|v| v.visible).unwrap_or(true)
    }
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    pub weights: Option<Vec<f32>>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub targets: Vec<Target>,
    #[serde(default)]
    extensions: PrimitiveExtensions,
}

#[derive(Default, Deserialize)]
struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    draco: Option<IgnoredAny>,
}

impl Primitive {
    /// Whether the vertices are compressed and the accessors are empty.
    pub(super) fn is_only_draco(&self, document: &Document) -> bool {
        let position = self.attributes.position.and_then(|i| document.accessors.get(i));
        self.extensions.draco.is_some() && position.is_some_and(|a| a.buffer_view.is_none())
    }
}

/// Indices of the accessors of a primitive's vertices.
#[derive(Clone, Deserialize, Eq, Hash, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct Attributes {
    pub position: Option<usize>,
    pub normal: Option<usize>,
    #[serde(rename = "TEXCOORD_0")]
    pub uv: Option<usize>,
    #[serde(rename = "COLOR_0")]
    pub color: Option<usize>,
    /// Of the points of lines; glTF leaves the meaning of attributes that begin with `_` to programs.
    #[serde(rename = "_RADIUS")]
    pub radius: Option<usize>,
    /// Diameter of the points of lines.
    #[serde(rename = "_WIDTH")]
    pub width: Option<usize>,
    joints_0: Option<usize>,
    joints_1: Option<usize>,
    joints_2: Option<usize>,
    joints_3: Option<usize>,
    weights_0: Option<usize>,
    weights_1: Option<usize>,
    weights_2: Option<usize>,
    weights_3: Option<usize>,
}

impl Attributes {
    /// Returns the sets of joints and weights, as pairs of accessors. Four sets are sixteen weights a vertex,
    /// more than any program writes.
    pub(super) fn weight_sets(&self) -> impl Iterator<Item = (usize, usize)> {
        let joints = [self.joints_0, self.joints_1, self.joints_2, self.joints_3];
        let weights = [self.weights_0, self.weights_1, self.weights_2, self.weights_3];
        joints.into_iter().zip(weights).map_while(|(j, w)| j.zip(w))
    }

    /// Whether the vertices follow the joints of a skin.
    pub(super) fn has_joints(&self) -> bool {
        self.weight_sets().next().is_some()
    }
}

/// A morph target: accessors of what is added to the vertices.
#[derive(Clone, Deserialize, Eq, Hash, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
pub(super) struct Target {
    pub position: Option<usize>,
    pub normal: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub joints: Vec<usize>,
    pub inverse_bind_matrices: Option<usize>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub name: Option<String>,
    #[serde(default)]
    pub pbr_metallic_roughness: Surface,
}

#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Surface {
    pub base_color_factor: [f32; 4],
    pub roughness_factor: f32,
}

impl Default for Surface {
    fn default() -> Self {
        Self { base_color_factor: [1.0; 4], roughness_factor: 1.0 }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub buffer_view: Option<usize>,
    #[serde(default)]
    pub byte_offset: usize,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: usize,
    #[serde(rename = "type")]
    pub shape: Shape,
    pub sparse: Option<Box<Sparse>>,
}

/// The number of components of an element.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Shape {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
}

impl Shape {
    pub(super) fn components(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 | Self::Mat2 => 4,
            Self::Mat3 => 9,
            Self::Mat4 => 16,
        }
    }
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub count: usize,
    pub indices: SparseArray,
    pub values: SparseArray,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseArray {
    pub buffer_view: usize,
    #[serde(default)]
    pub byte_offset: usize,
    /// Only of indices.
    pub component_type: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: usize,
    pub byte_length: usize,
    pub byte_stride: Option<usize>,
    #[serde(default)]
    extensions: ViewExtensions,
}

#[derive(Default, Deserialize)]
struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    ext: Option<IgnoredAny>,
    #[serde(rename = "KHR_meshopt_compression")]
    khr: Option<IgnoredAny>,
}

impl View {
    /// Whether a compressed copy of the bytes exists. The bytes themselves may then be absent.
    pub(super) fn is_meshopt(&self) -> bool {
        self.extensions.ext.is_some() || self.extensions.khr.is_some()
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub uri: Option<String>,
    pub byte_length: usize,
}

/// Required extensions that change nothing which is read here, by the beginning of their names: textures,
/// materials, lights, metadata, sound, physics and behavior.
const UNUSED: [&str; 24] = [
    "KHR_mesh_quantization",   // Read: an accessor has any component type.
    "EXT_mesh_gpu_instancing", // Read.
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "MSFT_packing_",
    "GOOGLE_texture_",
    "NV_materials_",
    "KHR_techniques_",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_animation_pointer",
    "KHR_xmp",
    "KHR_audio",
    "KHR_interactivity",
    "KHR_node_",
    "VRM",
    "KHR_physics_",
];

/// A sentence for a file whose meshes are compressed.
pub(super) fn compressed(extension: &str) -> Problem {
    let option = match extension {
        "KHR_draco_mesh_compression" => "export it without Draco (in Blender: Data, Compression, off)",
        _ => "export it without meshopt (gltfpack: without -c and -cc; gltf-transform: without meshopt)",
    };
    Problem::whole(format!("its meshes are compressed with {extension}, which is not read; {option}"))
}

/// Parses the JSON of a file.
pub(super) fn parse(json: &[u8]) -> Result<Document, Problem> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        /// Only the version, which is readable in files of any version.
        #[derive(Deserialize)]
        struct Versioned {
            asset: Asset,
        }
        match serde_json::from_slice::<Versioned>(json) {
            Ok(Versioned { asset }) if !asset.version.starts_with("2.") => version(&asset),
            _ => {
                let text: String = error.to_string().chars().take(300).collect();
                Problem::whole(format!("not a valid glTF file: {text}"))
            }
        }
    })?;
    if !document.asset.version.starts_with("2.") {
        return Err(version(&document.asset));
    }
    if let Some(needed) = document.asset.min_version.as_deref().filter(|v| is_above_2_0(v)) {
        let text = format!(
            "it needs a reader of glTF {needed:?} (asset.minVersion), and this one reads 2.0; export it as glTF 2.0"
        );
        return Err(Problem::whole(text));
    }
    for name in &document.extensions_required {
        match name.as_str() {
            "KHR_draco_mesh_compression" | "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
                return Err(compressed(name));
            }
            _ if UNUSED.iter().any(|known| name.starts_with(known)) => {}
            _ => {
                return Err(Problem::whole(format!(
                    "it requires the extension {name:?}, which is not supported; export it without"
                )));
            }
        }
    }
    Ok(document)
}

/// Whether a version, such as `2.1`, is above 2.0. So is one that is no pair of numbers.
fn is_above_2_0(version: &str) -> bool {
    let parts = version.split_once('.').map(|(major, minor)| (major.parse::<u32>(), minor.parse::<u32>()));
    !matches!(parts, Some((Ok(major), Ok(minor))) if (major, minor) <= (2, 0))
}

fn version(asset: &Asset) -> Problem {
    Problem::whole(format!("glTF version {:?} is not supported; export the file as glTF 2.0", asset.version))
}
