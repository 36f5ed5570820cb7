// Which parts of the picture are closed, so that what lies behind need not be drawn: `Canvas::survey` and `tile::walls`.

/// Hair before the body: its light, and the share of what lies behind that still shows through.
@group(0) @binding(1) var before: texture_2d<f32>;
/// Share of the depth range at which the body lies, and the share of the pixel that it covers.
@group(0) @binding(2) var body: texture_2d<f32>;
/// The most that shows through in a pixel of each patch, and the depth behind which its body hides all.
@group(0) @binding(3) var<storage, read_write> patches: array<vec2f>;

@compute @workgroup_size(8, 8)
fn survey(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2u(frame.size);
    let across = (size.x + PATCH - 1u) / PATCH;
    let down = (size.y + PATCH - 1u) / PATCH;
    if id.x >= across || id.y >= down {
        return;
    }
    var through = 0.0;
    var wall = 0.0;
    let end = min((id.xy + 1u) * PATCH, size);
    for (var y = id.y * PATCH; y < end.y; y++) {
        for (var x = id.x * PATCH; x < end.x; x++) {
            through = max(through, textureLoad(before, vec2u(x, y), 0).w);
            let place = textureLoad(body, vec2u(x, y), 0);
            wall = max(wall, select(2.0, place.x, place.y >= 1.0));
        }
    }
    patches[id.y * across + id.x] = vec2f(through, wall);
}
