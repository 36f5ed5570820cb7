// Follow hairs: the counterpart of the library's `follow/carry.rs`, `follow/style.rs` and `follow/keep_out.rs`. One invocation a strand, for
// curls and flyaways swing in a frame that is carried from point to point. `gpu/follow.rs` writes all of it.

struct Groom {
    strands: u32,
    /// Its first point among all styles' points.
    first: u32,
    colliders: u32,
    clump: f32,
    /// [m]
    curl_radius: f32,
    /// Angle of the curl in a meter of hair [rad/m].
    curl_rate: f32,
    /// [m]
    noise: f32,
}

struct Follower {
    /// Its first point among the groom's.
    first: u32,
    /// Its points; the highest bit: it is a guide.
    count: u32,
    /// Of each guide the first point among all guides', and the number of its last.
    guides: array<u32, 3>,
    lasts: array<u32, 3>,
    weights: array<f32, 3>,
    /// Where the curl and the four waves of the noise begin [rad].
    phases: array<f32, 5>,
}

struct Collider {
    /// Axes of its own space in the world, and its place [m] across them.
    x: vec4f,
    y: vec4f,
    z: vec4f,
    /// End of a capsule's axis and its radius; half of a box; node (0, 0, 0) of a field and its cell [m].
    a: vec4f,
    /// The axis's other end [m].
    b: vec4f,
    /// Nodes of a field; planes of a hull.
    size: vec3u,
    /// Its first number in `shapes`.
    first: u32,
    kind: u32,
}

@group(0) @binding(0) var<uniform> groom: Groom;
@group(0) @binding(1) var<storage, read> followers: array<Follower>;
/// Three numbers a point of the rest pose [m].
@group(0) @binding(2) var<storage, read> rest: array<f32>;
/// Three words a point: where it rides on its guides, 16 bits each, and how deep it may be inside a collider [m].
@group(0) @binding(3) var<storage, read> rides: array<u32>;
/// Three numbers a guide point of the rest pose [m].
@group(0) @binding(4) var<storage, read> guides: array<f32>;
/// Three vectors a guide point: axes of the rest pose as they lie now, and where it is now [m] across them.
@group(0) @binding(5) var<storage, read> carriers: array<vec4f>;
@group(0) @binding(6) var<storage, read> colliders: array<Collider>;
/// Distances of fields [m], and hulls' planes: four numbers each.
@group(0) @binding(7) var<storage, read> shapes: array<f32>;
/// Three numbers a point of all styles [m].
@group(0) @binding(8) var<storage, read_write> points: array<f32>;

const GUIDE: u32 = 0x80000000u;
const TURN: f32 = 6.283185307;

fn unit(v: vec3f, otherwise: vec3f) -> vec3f {
    let length2 = dot(v, v);
    return select(otherwise, v * inverseSqrt(length2), length2 > 1e-37 && length2 < 1e37);
}

/// Any unit vector across a unit vector (Duff et al. 2017), the same as the library's.
fn across(v: vec3f) -> vec3f {
    let sign = select(1.0, -1.0, (bitcast<u32>(v.z) & 0x80000000u) != 0u);
    let a = -1.0 / (sign + v.z);
    return vec3f(v.x * v.y * a, sign + v.y * v.y * a, -v.y);
}

/// Sine and cosine; angles of many turns are brought to one first, for a card's own sine is exact there alone.
fn wave(angle: f32) -> vec2f {
    let near = angle - TURN * round(angle / TURN);
    return vec2f(sin(near), cos(near));
}

/// Where a guide point is now.
fn guide_point(k: u32) -> vec3f {
    return vec3f(carriers[3u * k].w, carriers[3u * k + 1u].w, carriers[3u * k + 2u].w);
}

/// Where a guide point carries a point of the rest pose.
fn carried(k: u32, p: vec3f) -> vec3f {
    let d = p - vec3f(guides[3u * k], guides[3u * k + 1u], guides[3u * k + 2u]);
    return guide_point(k) + (carriers[3u * k].xyz * d.x + carriers[3u * k + 1u].xyz * d.y + carriers[3u * k + 2u].xyz * d.z);
}

/// Place on a guide, from 0 to its last point.
fn ride(word: u32, last: u32) -> f32 {
    return f32(word & 0xffffu) * (f32(last) / 65535.0);
}

/// Outward normal and distance, negative inside, for a place of the collider's own space; what is outside is only told to be so.
fn inside(c: Collider, p: vec3f) -> vec4f {
    let outside = vec4f(0.0, 0.0, 0.0, 1.0);
    if c.kind == CAPSULE {
        let axis = c.b.xyz - c.a.xyz;
        let d = p - c.a.xyz;
        let t = saturate(dot(d, axis) / max(dot(axis, axis), 1e-12));
        let out = d - axis * t;
        let length = sqrt(max(dot(out, out), 1e-30));
        return vec4f(out / length, length - c.a.w);
    }
    if c.kind == CUBOID {
        let q = abs(p) - c.a.xyz;
        let most = max(q.x, max(q.y, q.z));
        if most > 0.0 {
            return outside;
        }
        let x = q.x >= most;
        let y = !x && q.y >= most;
        let face = select(select(vec3f(0.0, 0.0, 1.0), vec3f(0.0, 1.0, 0.0), y), vec3f(1.0, 0.0, 0.0), x);
        return vec4f(select(face, -face, p < vec3f(0.0)), most);
    }
    if c.kind == PLANES {
        var deepest = vec4f(0.0, 0.0, 0.0, -3.4e38);
        for (var k = 0u; k < c.size.x; k++) {
            let i = c.first + 4u * k;
            let normal = vec3f(shapes[i], shapes[i + 1u], shapes[i + 2u]);
            let height = dot(normal, p) - shapes[i + 3u];
            if height > 0.0 {
                return outside;
            }
            if height > deepest.w {
                deepest = vec4f(normal, height);
            }
        }
        return deepest;
    }
    // `Grid::distance_lanes`.
    let top = vec3f(c.size - 1u);
    let at = (p - c.a.xyz) / c.a.w;
    let near = clamp(at, vec3f(0.0), top - 1e-3);
    let cell = min(floor(near), top - 1.0);
    let f = near - cell;
    let node = vec3u(cell);
    let i = c.first + (node.z * c.size.y + node.y) * c.size.x + node.x;
    let dy = c.size.x;
    let dz = c.size.x * c.size.y;
    let low = vec4f(shapes[i], shapes[i + dy], shapes[i + dz], shapes[i + dz + dy]);
    let high = vec4f(shapes[i + 1u], shapes[i + dy + 1u], shapes[i + dz + 1u], shapes[i + dz + dy + 1u]);
    let x = mix(low, high, f.x);
    let y = mix(x.xz, x.yw, f.y);
    let slope = mix((high - low).xz, (high - low).yw, f.y);
    let gradient = vec3f(mix(slope.x, slope.y, f.z), mix(x.y - x.x, x.w - x.z, f.z), y.y - y.x);
    let distance = mix(y.x, y.y, f.z) + length(at - near) * c.a.w;
    return vec4f(gradient * inverseSqrt(max(dot(gradient, gradient), 1e-30)), distance);
}

/// The place where a point is no deeper inside a collider than it may be.
fn keep_out(place: vec3f, allowed: f32) -> vec3f {
    var p = place;
    for (var k = 0u; k < groom.colliders; k++) {
        let c = colliders[k];
        let d = p - vec3f(c.x.w, c.y.w, c.z.w);
        let found = inside(c, vec3f(dot(c.x.xyz, d), dot(c.y.xyz, d), dot(c.z.xyz, d)));
        let out = max(allowed - found.w, 0.0);
        p += (c.x.xyz * found.x + c.y.xyz * found.y + c.z.xyz * found.z) * out;
    }
    return p;
}

@compute @workgroup_size(64)
fn follow(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let number = id.y * groups.x * 64u + id.x;
    if number >= groom.strands {
        return;
    }
    var hair = followers[number];
    let count = hair.count & ~GUIDE;
    let last = f32(count - 1u);
    let displaced = groom.curl_radius > 0.0 || groom.noise > 0.0;
    let start = wave(hair.phases[0]);
    var before = vec3f(0.0);
    var tangent = vec3f(0.0, 1.0, 0.0);
    var normal = vec3f(0.0);
    var arc = 0.0;
    for (var i = 0u; i < count; i++) {
        let k = hair.first + i;
        var p = vec3f(0.0);
        if (hair.count & GUIDE) != 0u {
            p = guide_point(hair.guides[0] + i);
        } else {
            let p0 = vec3f(rest[3u * k], rest[3u * k + 1u], rest[3u * k + 2u]);
            let words = vec3u(rides[3u * k], rides[3u * k] >> 16u, rides[3u * k + 1u]);
            for (var g = 0u; g < 3u; g++) {
                if hair.weights[g] == 0.0 {
                    continue;
                }
                let at = ride(words[g], hair.lasts[g]);
                let n = min(u32(at), hair.lasts[g] - 1u);
                let a = carried(hair.guides[g] + n, p0);
                let b = carried(hair.guides[g] + n + 1u, p0);
                p += (a + (b - a) * (at - f32(n))) * hair.weights[g];
            }
            let s = f32(i) / last;
            if i > 0u && groom.clump > 0.0 {
                let at = ride(words.x, hair.lasts[0]);
                let n = min(u32(at), hair.lasts[0] - 1u);
                let lead = mix(guide_point(hair.guides[0] + n), guide_point(hair.guides[0] + n + 1u), at - f32(n));
                p += (lead - p) * (groom.clump * s * sqrt(s));
            }
            let here = p;
            if i > 0u && displaced {
                let step = here - before;
                arc += length(step);
                let t = unit(step, tangent);
                if i == 1u {
                    normal = across(t);
                }
                normal = unit(normal - t * dot(normal, t), across(t));
                let side = cross(t, normal);
                let turn = wave(hair.phases[0] + arc * groom.curl_rate) - start;
                p += (normal * turn.y + side * turn.x) * (groom.curl_radius * min(s, 0.25) * 4.0);
                let sway = vec2f(
                    0.7 * wave(hair.phases[1] + s * 4.0).x + 0.3 * wave(hair.phases[2] + s * 11.0).x,
                    0.7 * wave(hair.phases[3] + s * 4.0).x + 0.3 * wave(hair.phases[4] + s * 11.0).x,
                );
                p += (normal * sway.x + side * sway.y) * (groom.noise * s * s);
                tangent = t;
            }
            before = here;
            if i > 0u {
                p = keep_out(p, bitcast<f32>(rides[3u * k + 2u]));
            }
        }
        let at = 3u * (groom.first + k);
        points[at] = p.x;
        points[at + 1u] = p.y;
        points[at + 2u] = p.z;
    }
}
