// Depth order, farthest first: a count of pieces for each depth, where each depth's pieces begin, and the pieces into their places.

/// Four numbers a slot: see `points.wgsl`.
@group(0) @binding(1) var<storage, read> dots: array<vec4f>;
/// What becomes of each slot's segment: its depth's key in the upper 16 bits, its number of pieces in the lower.
@group(0) @binding(2) var<storage, read_write> plans: array<u32>;
/// Pieces of each depth; then, where its next piece goes.
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
/// First piece of each depth, and the end of the last; shape `[DEPTHS + 2]`.
@group(0) @binding(4) var<storage, read_write> starts: array<u32>;
/// A piece: slot, 24 bits; piece of the segment, 4 bits; one less than the segment's pieces, 4 bits.
@group(0) @binding(5) var<storage, read_write> pieces: array<u32>;
/// Arguments of the indirect draw.
@group(0) @binding(6) var<storage, read_write> drawing: array<u32, 5>;

/// As `Chunk::file`: whether a segment is seen, and how it is cut.
@compute @workgroup_size(256)
fn count(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.y * groups.x * 256u + id.x;
    if slot >= frame.slots {
        return;
    }
    plans[slot] = 0u;
    let a = dots[slot];
    if slot + 1u >= frame.slots || !linked(a) {
        return;
    }
    let none = vec4f(0.0, 0.0, 0.0, -1.0);
    var z = none;
    if slot > 0u {
        z = dots[slot - 1u];
    }
    let b = dots[slot + 1u];
    var c = none;
    if slot + 2u < frame.slots {
        c = dots[slot + 2u];
    }
    let curve = curve(z, a, b, c);
    let widest = max(abs(a.w), abs(b.w));
    let turns = turn(curve.before, curve.here) + turn(curve.next, curve.here);
    let reach = widest * 0.5 + 1.0 + curve.length * 0.105 * turns;
    let low = min(a.xy, b.xy) - reach;
    let high = max(a.xy, b.xy) + reach;
    if widest < 1e-4 || any(low >= frame.size) || any(high <= vec2f(0.0)) {
        return;
    }
    let key = u32((1.0 - 0.5 * (a.z + b.z)) * DEPTHS + 0.5);
    let n = u32(curve.count);
    plans[slot] = (key << 16u) | n;
    atomicAdd(&counts[key], n);
}

const KEYS: u32 = u32(DEPTHS) + 1u;
const SHARE: u32 = KEYS / 256u;
var<workgroup> sums: array<u32, 256>;

/// Where each depth begins. One group: each invocation adds up a run of depths.
@compute @workgroup_size(256)
fn scan(@builtin(local_invocation_index) k: u32) {
    var own = 0u;
    for (var i = 0u; i < SHARE; i++) {
        own += atomicLoad(&counts[k * SHARE + i]);
    }
    sums[k] = own;
    workgroupBarrier();
    for (var step = 1u; step < 256u; step *= 2u) {
        let before = select(0u, sums[max(k, step) - step], k >= step);
        workgroupBarrier();
        sums[k] += before;
        workgroupBarrier();
    }
    var at = sums[k] - own;
    for (var i = k * SHARE; i < (k + 1u) * SHARE; i++) {
        starts[i] = at;
        let n = atomicLoad(&counts[i]);
        atomicStore(&counts[i], at);
        at += n;
    }
    if k == 255u {
        starts[KEYS] = at;
        drawing[0] = 6u * BATCH;
        drawing[1] = (at + BATCH - 1u) / BATCH;
        drawing[2] = 0u;
        drawing[3] = 0u;
        drawing[4] = 0u;
    }
}

@compute @workgroup_size(256)
fn scatter(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.y * groups.x * 256u + id.x;
    if slot >= frame.slots {
        return;
    }
    let n = plans[slot] & 0xffffu;
    if n == 0u {
        return;
    }
    let first = atomicAdd(&counts[plans[slot] >> 16u], n);
    for (var i = 0u; i < n; i++) {
        pieces[first + i] = (slot << 8u) | (i << 4u) | (n - 1u);
    }
}

/// Which invocation came first is chance: pieces of one depth are brought into the order of their strands, so that a frame drawn twice is
/// the same picture. A depth that holds more than `TIDY` pieces (hair as flat as paper, seen from straight ahead) is left as it is.
@compute @workgroup_size(256)
fn tidy(@builtin(global_invocation_id) id: vec3u) {
    let first = starts[id.x];
    let end = starts[id.x + 1u];
    if end - first > TIDY {
        return;
    }
    for (var i = first + 1u; i < end; i++) {
        let piece = pieces[i];
        var j = i;
        while j > first && pieces[j - 1u] > piece {
            pieces[j] = pieces[j - 1u];
            j -= 1u;
        }
        pieces[j] = piece;
    }
}
