// From the bodies' four samples to one place a pixel: `Bodies::draw`.

@group(0) @binding(1) var nearness: texture_depth_multisampled_2d;

@vertex
fn everywhere(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(f32(vertex & 1u) * 4.0 - 1.0, f32(vertex >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

/// Share of the depth range at which the body lies, and the share of the pixel that it covers.
@fragment
fn settle(@builtin(position) at: vec4f) -> @location(0) vec2f {
    var sum = 0.0;
    var n = 0.0;
    for (var s = 0; s < SAMPLES; s++) {
        let near = textureLoad(nearness, vec2i(at.xy), s);
        sum += near;
        n += select(0.0, 1.0, near > 0.0);
    }
    if n == 0.0 {
        return vec2f(0.0);
    }
    let depth = NEAR * n / sum;
    return vec2f((depth - frame.depths.x) / (frame.depths.y - frame.depths.x), n / f32(SAMPLES));
}
