//! The animations of a glTF document.

use serde::Deserialize;

#[derive(Deserialize)]
pub(in crate::gltf) struct Animation {
    pub name: Option<String>,
    #[serde(default)]
    pub channels: Vec<Channel>,
    #[serde(default)]
    pub samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
pub(in crate::gltf) struct Channel {
    pub sampler: usize,
    pub target: ChannelTarget,
}

#[derive(Deserialize)]
#[serde(from = "FileTarget")]
pub(in crate::gltf) struct ChannelTarget {
    /// `None` if the channel moves no node.
    pub node: Option<usize>,
    pub path: Path,
}

/// A target as the file has it.
#[derive(Deserialize)]
struct FileTarget {
    node: Option<usize>,
    path: Path,
    #[serde(default)]
    extensions: TargetExtensions,
}

#[derive(Default, Deserialize)]
struct TargetExtensions {
    #[serde(rename = "KHR_animation_pointer")]
    pointer: Option<Pointer>,
}

#[derive(Deserialize)]
struct Pointer {
    pointer: String,
}

impl From<FileTarget> for ChannelTarget {
    /// A pointer such as `/nodes/2/rotation` is the same as a node and a path.
    fn from(FileTarget { node, path, extensions }: FileTarget) -> Self {
        let Some(Pointer { pointer }) = extensions.pointer else { return Self { node, path } };
        let of_node = pointer.strip_prefix("/nodes/").and_then(|rest| rest.split_once('/'));
        let (node, property) = of_node.map_or((None, ""), |(node, property)| (node.parse().ok(), property));
        let path = match property {
            "translation" => Path::Translation,
            "rotation" => Path::Rotation,
            "scale" => Path::Scale,
            "weights" => Path::Weights,
            _ => Path::Other,
        };
        Self { node, path }
    }
}

#[derive(Clone, Copy, Deserialize, Eq, Hash, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(in crate::gltf) enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
    #[serde(other)]
    Other,
}

#[derive(Deserialize)]
pub(in crate::gltf) struct Sampler {
    pub input: usize,
    pub output: usize,
    #[serde(default)]
    pub interpolation: Interpolation,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, Hash, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
pub(in crate::gltf) enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
}
