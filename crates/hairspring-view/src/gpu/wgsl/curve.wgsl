// One segment on the screen: the counterpart of `hair/segment.rs`.

struct Curve {
    /// Unit directions of the segment before, of this one and of the next; zero where there is none.
    before: vec2f,
    here: vec2f,
    next: vec2f,
    /// [pixels]
    length: f32,
    /// Straight pieces that it is drawn as.
    count: f32,
}

fn linked(dot: vec4f) -> bool {
    return (bitcast<u32>(dot.w) & 0x80000000u) == 0u;
}

fn direction(way: vec2f) -> vec2f {
    let length2 = dot(way, way);
    return select(vec2f(0.0), way * inverseSqrt(length2), length2 > 1e-30);
}

fn turn(other: vec2f, here: vec2f) -> f32 {
    return select(length(other - here), 0.0, all(other == vec2f(0.0)));
}

/// `Segment::new` and the count of `Segment::pieces`, for the segment from `a` to `b`.
fn curve(z: vec4f, a: vec4f, b: vec4f, c: vec4f) -> Curve {
    var out: Curve;
    out.before = select(vec2f(0.0), direction(a.xy - z.xy), linked(z));
    out.here = direction(b.xy - a.xy);
    out.next = select(vec2f(0.0), direction(c.xy - b.xy), linked(b));
    out.length = length(b.xy - a.xy);
    let bend = out.length * 0.0625 * (turn(out.before, out.here) + turn(out.next, out.here));
    out.count = clamp(ceil(sqrt(bend / frame.tolerance)), 1.0, frame.pieces);
    return out;
}
