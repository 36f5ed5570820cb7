// How much hair is where: the counterpart of `shadow/splat.rs`. Sums are whole numbers, so that any order gives the same.

@group(0) @binding(7) var<storage, read_write> sums: array<atomic<u32>>;

/// `splat::segments`, for the segment that begins in a slot.
@compute @workgroup_size(256)
fn splat(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.y * groups.x * 256u + id.x;
    if slot >= frame.slots {
        return;
    }
    let strand = strands[owners[slot]];
    let k = slot - strand.slot;
    if k + 1u >= strand.count {
        return;
    }
    let i = strand.first + k;
    let a = point(i);
    let way = (point(i + 1u) - a) / frame.voxel;
    // In voxels from the grid's corner.
    let start = (a - frame.grid_origin) / frame.voxel + 0.5;
    let length = length(way);
    let amount = length * (radii[i] + radii[i + 1u]) * styles[strand.style].density;
    if !(finite(length) && finite(amount) && amount > 0.0 && length < LONGEST) {
        return;
    }
    let places = max(ceil(length / SPACING), 1.0);
    let each = u32(min(amount / places, UNIT));
    for (var n = 0.5; n < places; n += 1.0) {
        let at = start + way * (n / places);
        if all(at >= vec3f(0.0)) && all(at < frame.grid_size) {
            let voxel = vec3u(at);
            let size = vec3u(frame.grid_size);
            atomicAdd(&sums[(voxel.z * size.y + voxel.y) * size.x + voxel.x], each);
        }
    }
}
