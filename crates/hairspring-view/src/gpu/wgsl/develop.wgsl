// Hair before the body, body, hair behind it, ground and backdrop; exposure, tone curve, 8 bits: `Brush::develop` and `tonemap.rs`.

@group(0) @binding(1) var before: texture_2d<f32>;
@group(0) @binding(2) var behind: texture_2d<f32>;
/// Light of the body times covering, covering.
@group(0) @binding(3) var body: texture_2d<f32>;

@vertex
fn everywhere(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(f32(vertex & 1u) * 4.0 - 1.0, f32(vertex >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

/// `tonemap::filmic`.
fn filmic(light: vec3f) -> vec3f {
    let v = FILM_IN * light;
    let curve = (v * (v + FILM_A) - FILM_B) / (v * (v * FILM_C + FILM_D) + FILM_E);
    return saturate(FILM_OUT * curve);
}

/// Linear to sRGB (IEC 61966-2-1), 0 to 1.
fn encode(c: vec3f) -> vec3f {
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

@fragment
fn develop(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(at.xy);
    let corner = floor(at.xy);
    let front = textureLoad(before, pixel, 0);
    let surface = textureLoad(body, pixel, 0);
    let back = textureLoad(behind, pixel, 0);
    let place = corner / frame.size - vec2f(0.5, 0.42);
    var wall = mix(frame.edge, frame.center, exp(-3.2 * place.x * place.x) * exp(-3.2 * place.y * place.y));
    if frame.is_plain > 0.0 {
        wall = vec3f(0.0);
    }
    var light = back.xyz + over_ground(wall, at.xy) * (1.0 - back.w);
    light = surface.xyz + light * (1.0 - surface.w);
    light = front.xyz + light * (1.0 - front.w);
    var shown = filmic(light * frame.gain);
    if frame.is_plain > 0.0 {
        // `tonemap::filmic_on`.
        let through = (1.0 - back.w) * (1.0 - surface.w) * (1.0 - front.w);
        let share = over_ground(vec3f(1.0), at.xy) - over_ground(vec3f(0.0), at.xy);
        let cover = saturate(1.0 - share * through);
        shown = filmic(light * frame.gain / max(cover, vec3f(1e-4))) * cover + frame.plain * (1.0 - cover);
    }
    // `Encoder::encode`.
    let noise = fract(52.98292 * fract(0.06711056 * corner.x + 0.00583715 * corner.y));
    return vec4f(floor(255.0 * encode(shown) + noise) / 255.0, 1.0);
}
