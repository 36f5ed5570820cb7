// Optical depth towards each lamp and part of the sky for every voxel: the counterpart of `shadow/sweep.rs` and the end of `Shadow::fill`.

/// `sweep::Sweep`.
struct Sweep {
    /// Of the four voxels before.
    weights: vec4f,
    /// Way to the first of them, in voxels of memory.
    offset: i32,
    /// Steps in memory: along a row, to the next row, to the next slice.
    side: u32,
    across: u32,
    along: u32,
    /// First and past-last voxel of a row, and row of a slice.
    row: vec2u,
    rows: vec2u,
    slices: u32,
    /// 1: slices are walked from the last.
    down: u32,
    /// Half the way of a ray through a slice [voxels].
    half: f32,
    /// 1: bodies count too.
    bodies: u32,
}

@group(0) @binding(1) var<storage, read> sums: array<u32>;
@group(0) @binding(2) var<storage, read> walls: array<u32>;
/// Optical depth of a voxel: hair alone, and hair and bodies.
@group(0) @binding(3) var<storage, read_write> density: array<vec2f>;
/// One direction's after the other.
@group(0) @binding(4) var<storage, read_write> depths: array<f32>;
@group(0) @binding(5) var<uniform> sweeps: array<Sweep, DIRECTIONS>;
/// Which slice it is, counted from the lamp's side.
@group(0) @binding(6) var<uniform> slice: u32;
@group(0) @binding(7) var volume: texture_storage_3d<rgba16float, write>;
@group(0) @binding(8) var slants: texture_storage_3d<rgba16float, write>;

fn voxels() -> u32 {
    let size = vec3u(frame.grid_size);
    return size.x * size.y * size.z;
}

/// `density::blur` of all three axes at once, and walls.
@compute @workgroup_size(64)
fn blur(@builtin(global_invocation_id) id: vec3u) {
    let size = vec3i(frame.grid_size);
    let here = vec3i(id);
    if any(here >= size) {
        return;
    }
    let at = (here.z * size.y + here.y) * size.x + here.x;
    var sum = 0.0;
    for (var z = -1; z <= 1; z++) {
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let q = here + vec3i(x, y, z);
                if all(q >= vec3i(0)) && all(q < size) {
                    let weight = f32((2 - abs(x)) * (2 - abs(y)) * (2 - abs(z)));
                    sum += weight * f32(sums[(q.z * size.y + q.y) * size.x + q.x]);
                }
            }
        }
    }
    let hair = sum / (64.0 * UNIT);
    density[at] = vec2f(hair, select(hair, max(hair, WALL), walls[at] != 0u));
}

/// One slice of all directions.
@compute @workgroup_size(16, 16)
fn sweep(@builtin(global_invocation_id) id: vec3u) {
    let s = sweeps[id.z];
    let i = s.row.x + id.x;
    let j = s.rows.x + id.y;
    if slice >= s.slices || i >= s.row.y || j >= s.rows.y {
        return;
    }
    let k = select(slice, s.slices - 1u - slice, s.down != 0u);
    let at = k * s.along + j * s.across + i * s.side;
    let start = u32(i32(at) + s.offset);
    let own = id.z * voxels();
    let before = vec4f(
        depths[own + start], depths[own + start + s.side],
        depths[own + start + s.across], depths[own + start + s.side + s.across],
    );
    let there = vec4f(
        density[start][s.bodies], density[start + s.side][s.bodies],
        density[start + s.across][s.bodies], density[start + s.side + s.across][s.bodies],
    );
    depths[own + at] = dot(s.weights, before) + s.half * (density[at][s.bodies] + dot(s.weights, there));
}

/// `shadow::sky_open`.
fn sky_open(depth: f32) -> f32 {
    return 1.0 / (1.0 + SKY_LAW * depth);
}

@compute @workgroup_size(64)
fn gather(@builtin(global_invocation_id) id: vec3u) {
    let size = vec3u(frame.grid_size);
    if any(id >= size) {
        return;
    }
    let at = (id.z * size.y + id.y) * size.x + id.x;
    let n = voxels();
    var open: vec4f;
    for (var k = 0u; k < 4u; k++) {
        open[k] = sky_open(depths[(4u + k) * n + at]);
    }
    let mean = (sky_open(depths[3u * n + at]) + dot(open, vec4f(1.0))) / 5.0;
    textureStore(volume, id, vec4f(depths[at], depths[n + at], depths[2u * n + at], mean));
    textureStore(slants, id, open);
}
