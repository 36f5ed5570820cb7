// The voxels that a surface of a body passes through: `density::wall`.

@group(0) @binding(1) var<storage, read> positions: array<f32>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> walls: array<atomic<u32>>;

fn position(i: u32) -> vec3f {
    return vec3f(positions[3u * i], positions[3u * i + 1u], positions[3u * i + 2u]);
}

@compute @workgroup_size(64)
fn wall(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let t = id.y * groups.x * 64u + id.x;
    if t >= frame.triangles {
        return;
    }
    let triangle = triangles[t];
    let a = position(triangle.x);
    let b = position(triangle.y);
    let c = position(triangle.z);
    let low = min(a, min(b, c));
    let high = max(a, max(b, c));
    let longest = max(distance(a, b), max(distance(b, c), distance(c, a)));
    let end = frame.grid_origin + frame.grid_size * frame.voxel;
    if !finite(longest) || !(all(low <= end) && all(high >= frame.grid_origin)) {
        return;
    }
    let n = u32(clamp(ceil(longest / frame.voxel * 1.5), 1.0, 512.0));
    let size = vec3u(frame.grid_size);
    for (var i = 0u; i <= n; i++) {
        for (var j = 0u; j <= n - i; j++) {
            let p = a + (b - a) * (f32(i) / f32(n)) + (c - a) * (f32(j) / f32(n));
            let q = (p - frame.grid_origin) / frame.voxel + 0.5;
            if all(q >= vec3f(0.0)) && all(q < frame.grid_size) {
                let voxel = vec3u(q);
                atomicStore(&walls[(voxel.z * size.y + voxel.y) * size.x + voxel.x], 1u);
            }
        }
    }
}
