// What every shader of a frame knows: `gpu/uniforms.rs` writes it.

struct Lamp {
    /// Unit direction towards the lamp.
    direction: vec3f,
    color: vec3f,
}

struct Frame {
    eye: vec3f,
    /// Pixels per unit of slope.
    focal: f32,
    right: vec3f,
    /// Points of strands.
    slots: u32,
    up: vec3f,
    /// How far a drawn strand may stray from its curve [pixels].
    tolerance: f32,
    forward: vec3f,
    /// Most pieces that a segment is drawn as.
    pieces: f32,
    /// Of the picture [pixels].
    size: vec2f,
    /// Nearest and farthest depth of hair [m].
    depths: vec2f,
    /// Key, rim and fill.
    lamps: array<Lamp, 3>,
    sky: vec3f,
    /// Exposure, as a factor.
    gain: f32,
    ground: vec3f,
    /// Side of a voxel of the hair's grid [m]; 0: no hair.
    voxel: f32,
    /// Linear RGB of the backdrop.
    center: vec3f,
    /// Texels of the bodies' depth map in a meter; 0: no map.
    map_scale: f32,
    edge: vec3f,
    /// Side of the map [texels].
    map_side: f32,
    map_right: vec3f,
    map_left: f32,
    map_up: vec3f,
    map_top: f32,
    map_toward: vec3f,
    /// Height above the origin's plane at which the map's depth is 0 [m].
    map_low: f32,
    /// Middle of the grid's first voxel [m].
    grid_origin: vec3f,
    /// What the map's depth is multiplied by to give heights [m].
    map_range: f32,
    /// Voxels along each axis.
    grid_size: vec3f,
    /// Triangles of bodies.
    triangles: u32,
    /// `Floor`. What a white card on the ground reflects of the key lamp.
    floor_key: vec3f,
    /// [m]
    floor_height: f32,
    /// The same of sky and room.
    floor_sky: vec3f,
    /// How large what stands on it is [m]; 0: there is no ground to be seen.
    floor_extent: f32,
    floor_color: vec3f,
    /// 1: the ground has that color; 0: it is the backdrop.
    floor_colored: f32,
    floor_middle: vec2f,
    /// `Contact`. X and Z of the first texel's corner [m].
    contact_low: vec2f,
    /// Texels along X and Z; 0: none.
    contact_size: vec2f,
    /// Side of a texel [m].
    contact_texel: f32,
    /// `shadow::softness` [m].
    softness: f32,
    /// Box around all shadow of the key lamp, X and Z [m].
    shade_low: vec2f,
    shade_high: vec2f,
    /// `Background::plain`.
    plain: vec3f,
    /// 1: the backdrop is plain.
    is_plain: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

/// Whether a number is one: bits are asked, because a compiler may take for granted that numbers are finite.
fn finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

/// `camera::View::project`: pixels from the top left corner, and meters along the axis.
fn project(p: vec3f) -> vec3f {
    let d = p - frame.eye;
    let depth = dot(d, frame.forward);
    let scale = frame.focal / depth;
    return vec3f(0.5 * frame.size + scale * vec2f(dot(d, frame.right), -dot(d, frame.up)), depth);
}
