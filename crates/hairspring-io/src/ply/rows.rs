//! Rows of the elements of a PLY file.

use super::{LISTS, STRANDS};
use glam::Vec3;
use hairspring_scene::linear_from_srgb;
use ply_rs_bw::ply::{
    Property, PropertyAccess,
    PropertyAccessResult::{self, Ignored, Set, UnsupportedType},
};

/// A row of an element that is not read. It takes no memory.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

/// A point. Properties that the file does not declare are zero.
#[derive(Default)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub radius: f32,
    pub width: f32,
    /// Linear RGB.
    pub color: Vec3,
    /// Number of its strand.
    pub strand: f64,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(value) = number(&property) else { return Ignored };
        let single = value as f32;
        match name {
            "x" => self.position.x = single,
            "y" => self.position.y = single,
            "z" => self.position.z = single,
            "radius" => self.radius = single,
            "width" => self.width = single,
            "red" => self.color.x = channel(&property, single),
            "green" => self.color.y = channel(&property, single),
            "blue" => self.color.z = channel(&property, single),
            _ if STRANDS.contains(&name) => self.strand = value,
            _ => return Ignored,
        }
        Set
    }
}

/// The two vertices of an edge.
#[derive(Default)]
pub(super) struct Edge(pub [u32; 2]);

impl PropertyAccess for Edge {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let slot = match name {
            "vertex1" => &mut self.0[0],
            "vertex2" => &mut self.0[1],
            _ => return Ignored,
        };
        // Some programs write all numbers as floats.
        let whole = number(&property).filter(|v| (0.0..=f64::from(u32::MAX)).contains(v) && v.fract() == 0.0);
        let Some(vertex) = whole else { return UnsupportedType };
        *slot = vertex as u32;
        Set
    }
}

/// The vertices of a strand, root first.
#[derive(Default)]
pub(super) struct Strand(pub Vec<u32>);

impl PropertyAccess for Strand {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !LISTS.contains(&name) {
            return Ignored;
        }
        let Some(vertices) = property.to_u32_list() else { return UnsupportedType };
        self.0 = vertices;
        Set
    }
}

/// The value of a property that is one number.
fn number(property: &Property) -> Option<f64> {
    Some(match property {
        Property::Char(v) => f64::from(*v),
        Property::UChar(v) => f64::from(*v),
        Property::Short(v) => f64::from(*v),
        Property::UShort(v) => f64::from(*v),
        Property::Int(v) => f64::from(*v),
        Property::UInt(v) => f64::from(*v),
        Property::Float(v) => f64::from(*v),
        Property::Double(v) => *v,
        _ => return None,
    })
}

/// The linear value of a channel of a color: whole numbers of 8 or 16 bits are sRGB, as images have them.
fn channel(property: &Property, value: f32) -> f32 {
    match property {
        Property::UChar(_) => linear_from_srgb(value / 255.0),
        Property::UShort(_) => linear_from_srgb(value / 65535.0),
        _ => value,
    }
}
