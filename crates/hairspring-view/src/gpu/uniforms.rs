//! The uniforms of a frame. Their layouts are those of `wgsl/frame.wgsl`, `wgsl/fiber.wgsl` and
//! `wgsl/sweep.wgsl`.

use super::{constants::DIRECTIONS, ribbons::most_pieces};
use crate::{
    camera::View,
    frame::{Frame, HairDraw, MeshDraw},
    ground::Floor,
    hair::{
        color,
        shade::{Fiber, VARIES, pigment},
    },
    lighting::Light,
    shadow::{self, contact::Contact, density::Grid, depth_map, splat::UNIT, sweep},
};
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

/// A lamp: `Lamp` of the shaders.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Lamp {
    direction: [f32; 4],
    color: [f32; 4],
}

/// `Frame` of the shaders, where the fields are documented.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Uniforms {
    eye: [f32; 3],
    focal: f32,
    right: [f32; 3],
    slots: u32,
    up: [f32; 3],
    tolerance: f32,
    forward: [f32; 3],
    pieces: f32,
    size: [f32; 2],
    depths: [f32; 2],
    lamps: [Lamp; 3],
    sky: [f32; 3],
    gain: f32,
    ground: [f32; 3],
    voxel: f32,
    center: [f32; 3],
    map_scale: f32,
    edge: [f32; 3],
    map_side: f32,
    map_right: [f32; 3],
    map_left: f32,
    map_up: [f32; 3],
    map_top: f32,
    map_toward: [f32; 3],
    map_low: f32,
    grid_origin: [f32; 3],
    map_range: f32,
    grid_size: [f32; 3],
    triangles: u32,
    floor_key: [f32; 3],
    floor_height: f32,
    floor_sky: [f32; 3],
    floor_extent: f32,
    floor_color: [f32; 3],
    floor_colored: f32,
    floor_middle: [f32; 2],
    contact_low: [f32; 2],
    contact_size: [f32; 2],
    contact_texel: f32,
    softness: f32,
    shade_low: [f32; 2],
    shade_high: [f32; 2],
    plain: [f32; 3],
    is_plain: f32,
}

/// The transform of the bodies' depth map, as in `DepthMap::fill`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    /// Side [texels]; 0 if there are no bodies.
    pub side: u32,
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    scale: f32,
    origin: Vec2,
    low: f32,
    range: f32,
}

impl Map {
    /// Creates the map of a frame's bodies, with at most `most` texels per side.
    pub fn new(frame: &Frame, most: u32) -> Self {
        let toward = frame.lighting.key.direction.try_normalize().unwrap_or(Vec3::Y);
        let right = toward.any_orthonormal_vector();
        let up = toward.cross(right);
        let flat = |p: &Vec3| Vec3::new(p.dot(right), p.dot(up), p.dot(toward));
        let points = frame.bodies.iter().flat_map(|b: &MeshDraw| b.positions).filter(|p| p.is_finite());
        let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (low, high) = points.map(flat).fold(none, |b, p| (b.0.min(p), b.1.max(p)));
        let extent = (high - low).truncate().max_element();
        let side = match extent > 0.0 && extent.is_finite() {
            true => frame.quality.shadow_texels.clamp(64, 8192).min(most),
            false => 0,
        };
        let border = depth_map::border(frame);
        let scale = if side > 0 { (side as f32 - 2.0 * border) / extent } else { 0.0 };
        // Depth 0 marks empty texels, so the lowest point of a body is slightly above 0.
        let room = 1e-3 + 0.01 * (high.z - low.z);
        let (low_z, range) = if side > 0 { (low.z - room, high.z - low.z + 2.0 * room) } else { (0.0, 1.0) };
        let origin = if side > 0 { Vec2::splat(border) - low.truncate() * scale } else { Vec2::ZERO };
        Self { side, right, up, toward, scale, origin, low: low_z, range }
    }
}

impl Uniforms {
    /// `depths`: nearest and farthest depth of hair [m]; `grid`: the grid of its shadow, if there is hair;
    /// `floor`: the visible ground, and the fraction of the sky that bodies leave it; `slots`: points of
    /// strands; `triangles`: triangles of bodies.
    pub fn new(
        frame: &Frame,
        view: &View,
        depths: [f32; 2],
        grid: Option<&Grid>,
        map: &Map,
        (floor, contact): (Option<&Floor>, &Contact),
        [slots, triangles]: [usize; 2],
    ) -> Self {
        // Lights that are not finite are turned off, so that they do not spoil the picture.
        let finite = |v: Vec3| if v.is_finite() { v.to_array() } else { [0.0; 3] };
        let lamp = |l: &Light| Lamp {
            direction: l.direction.normalize_or(Vec3::Y).extend(0.0).to_array(),
            color: Vec3::from_array(finite(l.color)).extend(0.0).to_array(),
        };
        let lighting = &frame.lighting;
        let gain = lighting.exposure.exp2();
        let tolerance = frame.quality.smoothness.clamp(0.02, 4.0);
        Self {
            eye: view.eye.to_array(),
            focal: view.focal,
            right: view.right.to_array(),
            slots: slots as u32,
            up: view.up.to_array(),
            tolerance: if tolerance.is_nan() { f32::MAX } else { tolerance },
            forward: view.forward.to_array(),
            pieces: most_pieces(slots),
            size: view.center.map(|n| 2.0 * n),
            depths,
            lamps: [lamp(&lighting.key), lamp(&lighting.rim), lamp(&lighting.fill)],
            sky: finite(lighting.sky),
            gain: if gain.is_finite() { gain } else { 0.0 },
            ground: finite(lighting.ground),
            voxel: grid.map_or(0.0, |g| g.voxel),
            center: finite(frame.background.center),
            map_scale: map.scale,
            edge: finite(frame.background.edge),
            map_side: map.side as f32,
            map_right: map.right.to_array(),
            map_left: map.origin.x,
            map_up: map.up.to_array(),
            map_top: map.origin.y,
            map_toward: map.toward.to_array(),
            map_low: map.low,
            grid_origin: grid.map_or([0.0; 3], |g| g.origin.to_array()),
            map_range: map.range,
            grid_size: grid.map_or([1.0; 3], |g| g.size.map(|n| n as f32)),
            triangles: triangles as u32,
            floor_key: floor.map_or([0.0; 3], |f| f.key.to_array()),
            floor_height: floor.map_or(0.0, |f| f.height),
            floor_sky: floor.map_or([0.0; 3], |f| f.sky.to_array()),
            floor_extent: floor.map_or(0.0, |f| f.extent),
            floor_color: floor.and_then(|f| f.color).unwrap_or_default().to_array(),
            floor_colored: floor.and_then(|f| f.color).map_or(0.0, |_| 1.0),
            floor_middle: floor.map_or([0.0; 2], |f| f.middle.to_array()),
            contact_low: contact.low.to_array(),
            contact_size: contact.size.map(|n| n as f32),
            contact_texel: contact.texel.max(1e-6),
            softness: shadow::softness(map.scale, grid.map_or(0.0, |g| g.voxel)),
            shade_low: floor.map_or([0.0; 2], |f| f.shade[0].to_array()),
            shade_high: floor.map_or([0.0; 2], |f| f.shade[1].to_array()),
            plain: frame.background.plain().unwrap_or_default().to_array(),
            is_plain: frame.background.plain().map_or(0.0, |_| 1.0),
        }
    }
}

/// `Style` of the shaders: the values that all strands of a [`HairDraw`] share.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Style {
    root: [f32; 3],
    variation: f32,
    tip: [f32; 3],
    width: f32,
    spread: [f32; 3],
    tilt: f32,
    specular: f32,
    backlight: f32,
    scatter: f32,
    density: f32,
}

impl Style {
    /// `focal`: pixels per unit of slope; `voxel`: side of the shadow's voxels [m].
    pub fn new(hair: &HairDraw, focal: f32, voxel: f32) -> Self {
        let look = hair.look;
        let fiber = Fiber::new(look, 0.0);
        let [root, tip] = color::ends(look).map(|color| pigment(color).to_array());
        Self {
            root,
            variation: look.variation.clamp(0.0, 1.0) * VARIES,
            tip,
            width: 2.0 * hair.width_scale * focal,
            spread: fiber.spread,
            tilt: fiber.tilt,
            specular: fiber.specular,
            backlight: fiber.backlight,
            scatter: fiber.scatter,
            density: hair.width_scale * look.shadow * UNIT / voxel.max(1e-9),
        }
    }
}

/// `Sweep` of the shaders.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Sweep {
    weights: [f32; 4],
    offset: i32,
    side: u32,
    across: u32,
    along: u32,
    row: [u32; 2],
    rows: [u32; 2],
    slices: u32,
    down: u32,
    half: f32,
    bodies: u32,
}

/// All directions of the light sweeps, in the order of `Shadow::fill`: key, rim, fill, and the parts of the
/// sky. For the key lamp, bodies are in the depth map and not in the voxels.
pub(super) fn sweeps(frame: &Frame, grid: &Grid) -> [Sweep; DIRECTIONS] {
    let lamps = &frame.lighting;
    let directions = [lamps.key.direction, lamps.rim.direction, lamps.fill.direction];
    let mut out = [Sweep::default(); DIRECTIONS];
    for (k, direction) in directions.into_iter().chain(shadow::SKY).enumerate() {
        let Some(s) = sweep::Sweep::new(grid, direction) else { continue };
        out[k] = Sweep {
            weights: s.weights,
            offset: s.offset as i32,
            side: s.side as u32,
            across: s.across as u32,
            along: s.along as u32,
            row: s.row.map(|n| n as u32),
            rows: s.rows.map(|n| n as u32),
            slices: s.slices as u32,
            down: s.down as u32,
            half: 0.5 * s.length,
            bodies: (k > 0) as u32,
        };
    }
    out
}
