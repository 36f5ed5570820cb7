// Every point of every strand: where it is on the screen, and its color. The counterpart of `hair/project.rs` and `hair/color.rs`.

/// Three numbers a point, linear RGB; none where no style has colors.
@group(0) @binding(6) var<storage, read> colors: array<f32>;
/// Place [pixels], share of the depth range, and width [pixels], with a minus sign where the strand does not go on.
@group(0) @binding(7) var<storage, read_write> dots: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> lights: array<u32>;

/// `Track::project`: the width is below 0 where there is no such point.
fn dot_of(i: u32, scale: f32) -> vec4f {
    let p = point(i);
    let at = project(p);
    let width = radii[i] * scale / at.z;
    let known = finite(p.x) && finite(p.y) && finite(p.z) && finite(width) && finite(at.x) && finite(at.y);
    if !known || !(at.z > NEAR && abs(at.x) < MAX_PLACE && abs(at.y) < MAX_PLACE && width >= 0.0) {
        return vec4f(0.0, 0.0, 0.0, -1.0);
    }
    let depth = saturate((at.z - ROOT_BIAS - frame.depths.x) / (frame.depths.y - frame.depths.x));
    // A strand ends in the ground.
    let under = frame.floor_extent > 0.0 && p.y < frame.floor_height;
    return vec4f(at.xy, depth, select(min(width, MAX_WIDTH), 0.0, under));
}

/// `shade::pigment`.
fn pigment_of(color: vec3f) -> vec3f {
    let known = finite(color.x) && finite(color.y) && finite(color.z);
    return log2(clamp(select(vec3f(0.2), color, known), vec3f(0.002), vec3f(0.98)));
}

@compute @workgroup_size(256)
fn place(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let slot = id.y * groups.x * 256u + id.x;
    if slot >= frame.slots {
        return;
    }
    let strand = strands[owners[slot]];
    let style = styles[strand.style];
    let k = slot - strand.slot;
    let i = strand.first + k;
    var here = dot_of(i, style.width);
    if here.w < 0.0 {
        dots[slot] = vec4f(0.0, 0.0, 0.0, -1.0);
        lights[slot] = 0u;
        return;
    }
    let last = strand.count - 1u;
    let linked = k < last && dot_of(min(i + 1u, strand.first + last), style.width).w >= 0.0;
    dots[slot] = vec4f(here.xyz, bitcast<f32>(bitcast<u32>(here.w) | select(0x80000000u, 0u, linked)));

    let p = point(i);
    let way = point(strand.first + min(k + 1u, last)) - point(strand.first + max(k, 1u) - 1u);
    let length2 = dot(way, way);
    let along = select(vec3f(0.0, 1.0, 0.0), way * inverseSqrt(length2), length2 > 1e-30 && length2 < 1e30);
    var pigment = mix(style.root, style.tip, f32(k) / f32(max(last, 1u)));
    if strand.colored != 0u {
        pigment = pigment_of(vec3f(colors[3u * i], colors[3u * i + 1u], colors[3u * i + 2u]));
    }
    pigment *= 1.0 + style.variation * random(strand.number);
    let tilt = style.tilt + TILTS * random(~strand.number);
    lights[slot] = pack_light(shade(p, along, pigment, shadow_light(p), body_light(p), tilt, style));
}
