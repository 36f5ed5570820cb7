//! The shaders' sources, and the numbers that they share with the CPU renderer. Each number is defined once,
//! in Rust, and is written into every shader as a constant.

use super::{Gpu, follow};
use crate::{
    body::{self, skin},
    camera, ground,
    hair::{color, project, ribbon, segment, shade},
    shadow::{self, density, depth_map, splat},
    tonemap,
};
use glam::{Mat3, Vec3};
use std::fmt::Write;

/// Pieces per instance of the indexed draw. Its 4 × BATCH vertices have 16-bit indices.
pub(super) const BATCH: u32 = 1024;
/// Maximum number of pieces of equal depth that are put into a fixed order.
const TIDY: u32 = 1024;
/// Samples per pixel for the outlines of bodies.
pub(super) const SAMPLES: u32 = 4;
/// Number of directions for the light sweeps: three lamps and the parts of the sky.
pub(super) const DIRECTIONS: usize = 3 + shadow::SKY.len();

/// One shader: the files that it is assembled from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    name: &'static str,
    parts: &'static [&'static str],
}

macro_rules! source {
    ($name:literal: $($part:literal),*) => {
        Source { name: $name, parts: &[$(include_str!(concat!("wgsl/", $part, ".wgsl"))),*] }
    };
}

pub(super) const FOLLOW: Source = source!("follow": "follow");
pub(super) const DENSITY: Source = source!("density": "frame", "fiber", "strands", "density");
pub(super) const WALLS: Source = source!("walls": "frame", "walls");
pub(super) const SWEEP: Source = source!("sweep": "frame", "sweep");
pub(super) const BODY: Source = source!("body": "frame", "light", "body");
pub(super) const SETTLE: Source = source!("settle": "frame", "settle");
pub(super) const POINTS: Source = source!("points": "frame", "light", "fiber", "strands", "points");
pub(super) const SORT: Source = source!("sort": "frame", "curve", "sort");
pub(super) const RIBBON: Source = source!("ribbon": "frame", "fiber", "curve", "ribbon");
pub(super) const DEVELOP: Source = source!("develop": "frame", "light", "ground", "develop");

impl Source {
    /// The complete source text.
    fn text(self) -> String {
        self.parts.iter().fold(constants(), |all, part| all + part)
    }

    /// Compiles the shader.
    pub fn module(self, gpu: &Gpu) -> wgpu::ShaderModule {
        gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.text().into()),
        })
    }
}

/// Every number that Rust and the shaders share.
fn constants() -> String {
    let mut out = String::new();
    let numbers = [
        ("NEAR", camera::NEAR),
        ("MAX_WIDTH", project::MAX_WIDTH),
        ("MAX_PLACE", project::MAX_PLACE),
        ("ROOT_BIAS", project::ROOT_BIAS),
        ("DEPTHS", ribbon::DEPTHS),
        ("TILTS", shade::TILTS.to_radians()),
        ("BEAM", shade::BEAM),
        ("SCATTERED_FLOOR", shade::SCATTERED.0),
        ("SCATTERED_PIGMENT", shade::SCATTERED.1),
        ("BEHIND_BODY", shade::BEHIND_BODY),
        ("REFLECTANCE", shade::REFLECTANCE),
        ("R_STRENGTH", shade::R.0),
        ("R_FLOOR", shade::R.1),
        ("TT_SLOPE", shade::TT.0),
        ("TT_OFFSET", shade::TT.1),
        ("BENT_OVER", shade::BENT.0[0]),
        ("BENT_TIMES", shade::BENT.0[1]),
        ("ENTER_SLOPE", shade::BENT.1[0]),
        ("ENTER", shade::BENT.1[1]),
        ("TRT_SLOPE", shade::TRT.0[0]),
        ("TRT_OFFSET", shade::TRT.0[1]),
        ("TRT_STRENGTH", shade::TRT.1),
        ("TRT_PATH", shade::TRT.2),
        ("MULTIPLE_FACING", shade::MULTIPLE.0),
        ("MULTIPLE_ROUND", shade::MULTIPLE.1),
        ("HAIR_SHEEN", shade::SHEEN),
        ("MAX_LIGHT", color::MAX_LIGHT),
        ("UNIT", splat::UNIT),
        ("SPACING", splat::SPACING),
        ("LONGEST", splat::LONGEST),
        ("WALL", density::WALL),
        ("SKY_LAW", shadow::SKY_LAW),
        ("HAIR_BIAS", shadow::HAIR_BIAS),
        ("SKIN_BIAS", shadow::SKIN_BIAS),
        ("SLOPE", depth_map::SLOPE),
        ("SOFT_RADIUS", depth_map::RADIUS as f32),
        ("LAMP", depth_map::LAMP),
        ("WIDEST", depth_map::WIDEST),
        ("STEEPEST", depth_map::STEEPEST),
        ("BOUNCE", skin::BOUNCE),
        ("KEY_BOUNCE", skin::KEY_BOUNCE),
        ("HAIR_SHADE", skin::HAIR_SHADE),
        ("SKIN_REFLECTANCE", skin::REFLECTANCE),
        ("SKIN_LOBE", skin::LOBES.0),
        ("SKIN_SHARP", skin::LOBES.1),
        ("SHEEN", skin::SHEEN),
        ("MATTE", skin::MATTE),
        ("FADE_FROM", ground::FADE[0]),
        ("FADE_TO", ground::FADE[1]),
        ("POOL_FROM", ground::POOL[0]),
        ("POOL_TO", ground::POOL[1]),
        ("FILM_A", tonemap::FILM[0]),
        ("FILM_B", tonemap::FILM[1]),
        ("FILM_C", tonemap::FILM[2]),
        ("FILM_D", tonemap::FILM[3]),
        ("FILM_E", tonemap::FILM[4]),
    ];
    for (name, value) in numbers {
        // The format has enough digits to give exactly the same number, and is read alike by both languages.
        let _ = writeln!(out, "const {name}: f32 = {value:e}f;");
    }
    for (name, value) in [
        ("CHANNEL_GREEN", color::CHANNELS[1].1),
        ("CHANNEL_BLUE", color::CHANNELS[2].1),
        ("BATCH", BATCH),
        ("TIDY", TIDY),
        ("DIRECTIONS", DIRECTIONS as u32),
        ("CAPSULE", follow::CAPSULE),
        ("CUBOID", follow::CUBOID),
        ("PLANES", follow::PLANES),
        ("FIELD", follow::FIELD),
    ] {
        let _ = writeln!(out, "const {name}: u32 = {value}u;");
    }
    let _ = writeln!(out, "const SAMPLES: i32 = {SAMPLES};");
    let tops = color::CHANNELS.map(|(top, _)| top);
    let sky = shadow::SKY.map(vector);
    let _ = writeln!(out, "const CHANNEL_TOPS: vec3f = {};", vector(Vec3::from_array(tops)));
    let bounce = vector(skin::SKIN.0 * shade::KEY_BOUNCE);
    let _ = writeln!(out, "const HAIR_KEY_BOUNCE: vec3f = {bounce};");
    let _ = writeln!(out, "const WRAP: vec3f = {};", vector(skin::WRAP));
    let outline: [String; 8] = std::array::from_fn(|k| {
        let [x, y] = body::SAMPLES.map(|axis| axis[k]);
        format!("vec2f({x:e}f, {y:e}f)")
    });
    let _ = writeln!(out, "const OUTLINE: array<vec2f, 8> = array({});", outline.join(", "));
    let _ = writeln!(out, "const SKY: array<vec3f, {}> = array({});", sky.len(), sky.join(", "));
    let _ = writeln!(out, "const FILM_IN: mat3x3f = {};", matrix(&tonemap::FILM_IN));
    let _ = writeln!(out, "const FILM_OUT: mat3x3f = {};", matrix(&tonemap::FILM_OUT));
    out
}

fn vector(v: Vec3) -> String {
    format!("vec3f({:e}f, {:e}f, {:e}f)", v.x, v.y, v.z)
}

fn matrix(m: &Mat3) -> String {
    let columns = [m.x_axis, m.y_axis, m.z_axis].map(vector);
    format!("mat3x3f({})", columns.join(", "))
}

/// Maximum number of pieces of one segment (see [`segment::MAX_PIECES`]). Four bits of a piece hold its
/// number.
pub(super) const MAX_PIECES: f32 = segment::MAX_PIECES;

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    /// Validates the shaders with the compiler alone, without a GPU, and with only the capabilities of every
    /// WebGPU device.
    #[test]
    fn every_shader_is_valid() {
        for source in [FOLLOW, DENSITY, WALLS, SWEEP, BODY, SETTLE, POINTS, SORT, RIBBON, DEVELOP] {
            let text = source.text();
            let module = naga::front::wgsl::parse_str(&text)
                .unwrap_or_else(|e| panic!("{}: {}", source.name, e.emit_to_string(&text)));
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|e| panic!("{}: {}", source.name, e.emit_to_string(&text)));
        }
    }

    #[test]
    fn numbers_are_written_as_they_are() {
        let text = constants();
        assert!(
            text.contains("const BEAM: f32 = 6.2e-1f;") && text.contains("const CHANNEL_BLUE: u32 = 22u;")
        );
    }
}
