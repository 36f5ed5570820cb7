// Pieces into pixels: the counterpart of `hair/blend.rs`. A piece is a parallelogram that holds every pixel that it may touch; the share of
// a pixel that it covers is worked out there, exactly.

@group(0) @binding(1) var<storage, read> dots: array<vec4f>;
@group(0) @binding(2) var<storage, read> lights: array<u32>;
@group(0) @binding(3) var<storage, read> pieces: array<u32>;
@group(0) @binding(4) var<storage, read> starts: array<u32>;
/// Share of the depth range at which the body lies, and the share of the pixel that it covers.
@group(0) @binding(5) var body: texture_2d<f32>;

struct Ribbon {
    @builtin(position) at: vec4f,
    /// Linear RGB, and the share of the depth range.
    @location(0) @interpolate(linear) color: vec4f,
    /// The middle's distance from the pixel's across the walk, half the width across it [pixels], and the way from the strand's beginning and
    /// to its end along it, where they lie in this piece.
    @location(1) @interpolate(linear) place: vec4f,
    /// Whether the walk goes down rather than to the right.
    @location(2) @interpolate(flat) steep: u32,
}

/// `segment::hermite`.
fn hermite(a: vec2f, b: vec2f, ta: vec2f, tb: vec2f, u: f32) -> vec2f {
    let u2 = u * u;
    let u3 = u2 * u;
    return a * (2.0 * u3 - 3.0 * u2 + 1.0) + b * (3.0 * u2 - 2.0 * u3) + ta * (u3 - 2.0 * u2 + u) + tb * (u3 - u2);
}

/// The direction that halves two, or the second.
fn halved(a: vec2f, b: vec2f, here: vec2f) -> vec2f {
    let sum = a + b;
    let length2 = dot(sum, sum);
    return select(here, sum * inverseSqrt(length2), length2 > 1e-30);
}

@vertex
fn ribbon(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Ribbon {
    var out: Ribbon;
    out.at = vec4f(-2.0, -2.0, 0.0, 1.0);
    let number = instance * BATCH + vertex / 4u;
    if number >= starts[u32(DEPTHS) + 1u] {
        return out;
    }
    let piece = pieces[number];
    let slot = piece >> 8u;
    let k = f32((piece >> 4u) & 15u);
    let n = f32((piece & 15u) + 1u);
    let none = vec4f(0.0, 0.0, 0.0, -1.0);
    var z = none;
    if slot > 0u {
        z = dots[slot - 1u];
    }
    let a = dots[slot];
    let b = dots[slot + 1u];
    var c = none;
    if slot + 2u < frame.slots {
        c = dots[slot + 2u];
    }
    let curve = curve(z, a, b, c);
    let ta = halved(curve.before, curve.here, curve.here) * curve.length;
    let tb = halved(curve.here, curve.next, curve.here) * curve.length;
    var u = vec2f(k / n, (k + 1.0) / n);
    var start = select(hermite(a.xy, b.xy, ta, tb, u.x), a.xy, k == 0.0);
    var to = select(hermite(a.xy, b.xy, ta, tb, u.y), b.xy, k + 1.0 == n);
    var caps = vec2<bool>(k == 0.0 && all(curve.before == vec2f(0.0)), k + 1.0 == n && all(curve.next == vec2f(0.0)));

    // `Canvas::draw` and `walk`: along the longer axis, from its lower end.
    let steep = abs(to.x - start.x) < abs(to.y - start.y);
    if steep {
        start = start.yx;
        to = to.yx;
    }
    if start.x > to.x {
        let keep = start;
        start = to;
        to = keep;
        u = u.yx;
        caps = caps.yx;
    }
    let d = to - start;
    if d.x <= 1e-6 {
        return out;
    }
    let slope = d.y / d.x;
    let lean = 0.5 * sqrt(1.0 + slope * slope);
    let half = mix(vec2f(abs(a.w)), vec2f(abs(b.w)), u) * lean;
    let walk = vec2f(select(start.x, floor(start.x), caps.x), select(to.x, ceil(to.x), caps.y));
    let end = vertex & 1u;
    let side = select(-1.0, 1.0, (vertex & 2u) != 0u);
    let x = walk[end];
    // Along the piece, a little past its ends where it is capped.
    let t = (x - start.x) / d.x;
    let middle = start.y + slope * (x - start.x);
    let reach = (max(max(half.x, half.y), 0.5) + 0.75) * side;
    let at = select(vec2f(x, middle + reach), vec2f(middle + reach, x), steep);
    let pixel = at / frame.size * 2.0 - 1.0;
    out.at = vec4f(pixel.x, -pixel.y, 0.5, 1.0);
    let color = mix(open_light(lights[slot]), open_light(lights[slot + 1u]), mix(u.x, u.y, t));
    out.color = vec4f(color, mix(a.z, b.z, mix(u.x, u.y, t)));
    // A strand that goes on is everywhere far from its ends.
    let far = 1e4;
    let before = select(far, x - start.x, caps.x);
    let after = select(far, to.x - x, caps.y);
    out.place = vec4f(-reach, mix(half.x, half.y, t), before, after);
    out.steep = select(0u, 1u, steep);
    return out;
}

struct Seen {
    /// Hair before the body, and behind it: linear RGB times covering, covering.
    @location(0) before: vec4f,
    @location(1) behind: vec4f,
}

@fragment
fn cover(in: Ribbon) -> Seen {
    // An interval shorter than a pixel is drawn a pixel long, and fainter.
    let half = max(in.place.y, 0.0);
    let reach = max(half, 0.5);
    let low = max(in.place.x - reach, -0.5);
    let high = min(in.place.x + reach, 0.5);
    let ends = saturate(in.place.z + 0.5) * saturate(in.place.w + 0.5);
    let share = saturate((high - low) * half / reach * ends);
    let wall = textureLoad(body, vec2i(in.at.xy), 0).xy;
    let hidden = wall.y > 0.0 && in.color.w > wall.x;
    if share <= 0.0 || (hidden && wall.y >= 1.0) {
        discard;
    }
    let seen = vec4f(max(in.color.xyz, vec3f(0.0)), 1.0) * share;
    return Seen(select(seen, vec4f(0.0), hidden), select(vec4f(0.0), seen, hidden));
}
