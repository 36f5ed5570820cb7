//! The fields of `[groom.maps]`.

use super::file::FileName;
use serde::Deserialize;
use toml::Spanned;

/// A field of [`MapsFile`].
pub(super) type Field = Option<Spanned<MapFile>>;

/// `maps` of a groom: what varies over the scalp. Each field is the value of its map at the root of a strand.
#[derive(Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct MapsFile {
    /// Multiplier of the bending stiffness.
    pub bend: Field,
    /// Multiplier of the damping.
    pub damping: Field,
    /// Multiplier of the air drag.
    pub drag: Field,
    /// Multiplier of the friction.
    pub friction: Field,
    /// Multiplier of the static charge.
    pub charge: Field,
    /// Multiplier of the global shape's frequency.
    pub global_shape: Field,
    /// Multiplier of the radius.
    pub radius: Field,
    /// Multiplier of the flatness.
    pub flatness: Field,
    /// Multiplier of the tether.
    pub tether: Field,
    /// Share of a strand's length that is left, as by a cut.
    pub length: Field,
    /// Share of the strands that are kept.
    pub density: Field,
    /// Direction in which grown hair leaves the skin.
    pub comb: Field,
}

impl MapsFile {
    /// Returns all maps by name.
    pub(super) fn all(&self) -> [(&'static str, &Field); 12] {
        [
            ("bend", &self.bend),
            ("damping", &self.damping),
            ("drag", &self.drag),
            ("friction", &self.friction),
            ("charge", &self.charge),
            ("global_shape", &self.global_shape),
            ("radius", &self.radius),
            ("flatness", &self.flatness),
            ("tether", &self.tether),
            ("length", &self.length),
            ("density", &self.density),
            ("comb", &self.comb),
        ]
    }
}

/// Where a map has its values, and their range.
#[derive(Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct MapFile {
    /// A picture, at the texture coordinates of the root.
    pub texture: Option<FileName>,
    /// The colors of the body's vertices, at the root.
    pub vertex_colors: bool,
    /// A text of numbers, one for each strand; three for each strand of `comb`.
    pub values: Option<FileName>,
    /// The part of a color that is used.
    pub channel: Channel,
    /// Value of the parameter where the map is 0.
    pub low: f32,
    /// Value of the parameter where the map is 1.
    pub high: f32,
}

impl Default for MapFile {
    fn default() -> Self {
        Self {
            texture: None,
            vertex_colors: false,
            values: None,
            channel: Channel::default(),
            low: 0.0,
            high: 1.0,
        }
    }
}

impl MapFile {
    /// Number of sources.
    pub(super) fn sources(&self) -> usize {
        usize::from(self.texture.is_some())
            + usize::from(self.vertex_colors)
            + usize::from(self.values.is_some())
    }
}

/// A part of a color.
#[derive(Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Channel {
    /// The mean of the three.
    #[default]
    Gray,
    Red,
    Green,
    Blue,
}
