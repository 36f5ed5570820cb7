// What stands between the lamps and a place: the counterpart of the lookups in `shadow/mod.rs` and `shadow/depth_map.rs`.

/// Optical depth towards key, rim and fill, and the share of the sky seen.
@group(0) @binding(10) var volume: texture_3d<f32>;
/// Of the slanting parts of the sky, the share that is seen.
@group(0) @binding(11) var slants: texture_3d<f32>;
@group(0) @binding(12) var smooth_sampler: sampler;
/// The bodies as the key lamp sees them; greater is nearer the lamp, 0: nothing.
@group(0) @binding(13) var heights: texture_depth_2d;

/// Where in the grid a place lies, 0 to 1 along each axis, and whether it does.
fn in_grid(p: vec3f) -> vec4f {
    let q = (p - frame.grid_origin) / frame.voxel;
    let inside = frame.voxel > 0.0 && all(q >= vec3f(0.0)) && all(q < frame.grid_size - 1.0);
    return vec4f((q + 0.5) / frame.grid_size, select(0.0, 1.0, inside));
}

/// `Shadow::light`.
fn shadow_light(p: vec3f) -> vec4f {
    let at = in_grid(p);
    return select(vec4f(0.0, 0.0, 0.0, 1.0), textureSampleLevel(volume, smooth_sampler, at.xyz, 0.0), at.w > 0.0);
}

/// Where a ray enters a box, and whether it does.
fn entry(p: vec3f, toward: vec3f, low: vec3f, high: vec3f) -> vec4f {
    let a = (low - p) / toward;
    let b = (high - p) / toward;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(near.x, max(near.y, near.z));
    let leave = min(far.x, min(far.y, far.z));
    return vec4f(clamp(p + toward * enter, low, high), select(0.0, 1.0, enter >= 0.0 && enter < leave));
}

/// `Shadow::around`.
fn shadow_around(p: vec3f) -> vec4f {
    if frame.voxel <= 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let margin = vec3f(2.0 * frame.voxel);
    let low = frame.grid_origin + margin;
    let high = frame.grid_origin + (frame.grid_size - 1.0) * frame.voxel - margin;
    if all(p >= low) && all(p <= high) {
        return shadow_light(p);
    }
    var found = vec4f(0.0);
    for (var k = 0; k < 3; k++) {
        let q = entry(p, frame.lamps[k].direction, low, high);
        if q.w > 0.0 {
            found[k] = shadow_light(q.xyz)[k];
        }
    }
    // The first part of the sky, straight above, is what the mean holds beside the others.
    var open = 1.0;
    let above = entry(p, SKY[0], low, high);
    if above.w > 0.0 {
        let at = in_grid(above.xyz).xyz;
        let others = dot(textureSampleLevel(slants, smooth_sampler, at, 0.0), vec4f(1.0));
        open = 5.0 * textureSampleLevel(volume, smooth_sampler, at, 0.0).w - others;
    }
    for (var k = 0; k < 4; k++) {
        let q = entry(p, SKY[k + 1], low, high);
        if q.w > 0.0 {
            open += textureSampleLevel(slants, smooth_sampler, in_grid(q.xyz).xyz, 0.0)[k];
        } else {
            open += 1.0;
        }
    }
    found.w = open / 5.0;
    return found;
}

/// `Shadow::key_around`.
fn key_around(p: vec3f) -> f32 {
    if frame.voxel <= 0.0 {
        return 0.0;
    }
    let margin = vec3f(2.0 * frame.voxel);
    let low = frame.grid_origin + margin;
    let high = frame.grid_origin + (frame.grid_size - 1.0) * frame.voxel - margin;
    if all(p >= low) && all(p <= high) {
        return shadow_light(p).x;
    }
    let q = entry(p, frame.lamps[0].direction, low, high);
    return select(0.0, shadow_light(q.xyz).x, q.w > 0.0);
}

/// `DepthMap::texel`: texel coordinates and height of a place.
fn texel(p: vec3f) -> vec3f {
    let xy = vec2f(dot(p, frame.map_right), dot(p, frame.map_up)) * frame.map_scale;
    return vec3f(xy + vec2f(frame.map_left, frame.map_top), dot(p, frame.map_toward));
}

/// Share of light that passes one texel of the map to a height.
fn passes(at: vec2i, height: f32) -> f32 {
    let depth = textureLoad(heights, at, 0);
    let over = frame.map_low + depth * frame.map_range - height;
    return select(1.0 - clamp(over * SLOPE, 0.0, 1.0), 1.0, depth <= 0.0);
}

/// `DepthMap::light`.
fn body_light(p: vec3f) -> f32 {
    let t = texel(p);
    let at = t.xy - 0.5;
    let edge = frame.map_side - 2.5;
    if frame.map_scale <= 0.0 || !(all(at > vec2f(1.0)) && all(at < vec2f(edge))) {
        return 1.0;
    }
    let height = t.z + HAIR_BIAS;
    let corner = vec2i(floor(at));
    let share = at - floor(at);
    let above = mix(passes(corner, height), passes(corner + vec2i(1, 0), height), share.x);
    let below = mix(passes(corner + vec2i(0, 1), height), passes(corner + vec2i(1, 1), height), share.x);
    return mix(above, below, share.y);
}

/// `DepthMap::soft_light`.
fn soft_body_light(p: vec3f) -> f32 {
    let t = texel(p);
    let margin = SOFT_RADIUS + 0.5;
    let edge = frame.map_side - 1.0 - SOFT_RADIUS;
    if frame.map_scale <= 0.0 || !(all(t.xy > vec2f(margin)) && all(t.xy < vec2f(edge))) {
        return 1.0;
    }
    let at = t.xy - 0.5;
    let height = t.z + SKIN_BIAS;
    let corner = vec2i(floor(at)) + 1 - i32(SOFT_RADIUS);
    let share = at - floor(at);
    var sum = 0.0;
    for (var y = 0; y < 2 * i32(SOFT_RADIUS); y++) {
        let down = 1.0 - abs(f32(y) + 1.0 - SOFT_RADIUS - share.y) / SOFT_RADIUS;
        for (var x = 0; x < 2 * i32(SOFT_RADIUS); x++) {
            let across = 1.0 - abs(f32(x) + 1.0 - SOFT_RADIUS - share.x) / SOFT_RADIUS;
            sum += down * across * passes(corner + vec2i(x, y), height);
        }
    }
    return sum / (SOFT_RADIUS * SOFT_RADIUS);
}

/// Height of a tap of the map above the plane through `t` with this slope; far below it for empty texels and outside of
/// the map. The plane is evaluated in the middle of the texel.
fn tap_over(t: vec3f, place: vec2f, slope: vec2f) -> f32 {
    let at = floor(t.xy + place);
    if !(all(at >= vec2f(0.0)) && all(at < vec2f(frame.map_side))) {
        return -1e9;
    }
    let depth = textureLoad(heights, vec2i(at), 0);
    let plane = t.z + dot(at + 0.5 - t.xy, slope);
    return select(frame.map_low + depth * frame.map_range - plane, -1e9, depth <= 0.0);
}

/// `DepthMap::area_light`.
fn area_body_light(p: vec3f, n: vec3f) -> f32 {
    if frame.map_scale <= 0.0 {
        return 1.0;
    }
    let t = texel(p) + vec3f(0.0, 0.0, SKIN_BIAS);
    let facing = max(dot(n, frame.map_toward), STEEPEST);
    let slope = vec2f(dot(n, frame.map_right), dot(n, frame.map_up)) / (-facing * frame.map_scale);
    var spacing = max(WIDEST * frame.map_scale / SOFT_RADIUS, 1.0);
    var sum = 0.0;
    var count = 0.0;
    for (var y = 0.5 - SOFT_RADIUS; y < SOFT_RADIUS; y += 1.0) {
        for (var x = 0.5 - SOFT_RADIUS; x < SOFT_RADIUS; x += 1.0) {
            let over = tap_over(t, vec2f(x, y) * spacing, slope);
            sum += max(over, 0.0);
            count += select(0.0, 1.0, over > 0.0);
        }
    }
    if count <= 0.0 {
        return 1.0;
    }
    spacing = max(min(LAMP * sum / count, WIDEST) * frame.map_scale / SOFT_RADIUS, 1.0);
    var lit = 0.0;
    for (var y = 0.5 - SOFT_RADIUS; y < SOFT_RADIUS; y += 1.0) {
        for (var x = 0.5 - SOFT_RADIUS; x < SOFT_RADIUS; x += 1.0) {
            let over = tap_over(t, vec2f(x, y) * spacing, slope);
            let weight = (1.0 - abs(x) / SOFT_RADIUS) * (1.0 - abs(y) / SOFT_RADIUS);
            lit += weight * (1.0 - clamp(over * SLOPE, 0.0, 1.0));
        }
    }
    return lit / (SOFT_RADIUS * SOFT_RADIUS);
}
