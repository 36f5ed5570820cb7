// Light from a strand towards the camera: the counterpart of `hair/shade.rs`, term by term.

struct Style {
    /// Pigment at the root: base-2 logarithm of the color.
    root: vec3f,
    /// How much pigment differs from strand to strand.
    variation: f32,
    /// Pigment at the tip.
    tip: vec3f,
    /// Pixels at a distance of 1 m that a radius of 1 m takes.
    width: f32,
    /// Spread of R, TT and TRT [rad].
    spread: vec3f,
    /// Tilt of the cuticle [rad].
    tilt: f32,
    specular: f32,
    backlight: f32,
    scatter: f32,
    /// What a segment's length [voxels] times the sum of its radii is multiplied by to count it into voxels.
    density: f32,
}

const LOG2_E: f32 = 1.442695041;
const PI: f32 = 3.14159265;

/// `shade::random`.
fn random(s: u32) -> f32 {
    var h = (s * 0x9e3779b9u) ^ 0x5bd1e995u;
    h = (h ^ (h >> 16u)) * 0x85ebca6bu;
    h = (h ^ (h >> 13u)) * 0xc2b2ae35u;
    h ^= h >> 16u;
    return f32(h >> 8u) / 8388608.0 - 1.0;
}

/// `shade::gauss`.
fn gauss(x: f32, b: f32) -> f32 {
    let u = x / b;
    return exp2(max(u * u * -0.7213475, -100.0)) * 0.3989423 / b;
}

/// `shade::fresnel`.
fn fresnel(cosine: f32) -> f32 {
    let m = max(1.0 - cosine, 0.0);
    let m2 = m * m;
    return m2 * m2 * m * (1.0 - REFLECTANCE) + REFLECTANCE;
}

/// `Shader::shade`, for one point at `p` of a strand that goes along `t`. `light`: optical depth towards key, rim and fill, and the
/// share of the sky seen; `body`: the share of the key lamp that bodies let through; `tilt`: of this strand's cuticle.
fn shade(p: vec3f, t: vec3f, pigment: vec3f, light: vec4f, body: f32, tilt: f32, style: Style) -> vec3f {
    let to_eye = frame.eye - p;
    let v = to_eye / sqrt(max(dot(to_eye, to_eye), 1e-12));
    let sin_v = clamp(dot(t, v), -1.0, 1.0);
    let cos_v = sqrt(max(1.0 - sin_v * sin_v, 1e-4));
    let across = (v - t * sin_v) / cos_v;
    let soft = exp2(pigment * 0.5);
    var sum = vec3f(0.0);
    for (var k = 0; k < 3; k++) {
        let l = frame.lamps[k].direction;
        let depth = light[k];
        let through = select(1.0, body, k == 0);
        let beam = exp2(depth * -BEAM * LOG2_E) * through;
        let sin_l = clamp(dot(t, l), -1.0, 1.0);
        let cos_l = sqrt(max(1.0 - sin_l * sin_l, 1e-4));
        let vl = dot(v, l);
        let cos_phi = clamp((vl - sin_l * sin_v) / (cos_l * cos_v), -1.0, 1.0);
        let cos_half = sqrt(cos_phi * 0.5 + 0.5);
        let cos_d = sqrt(max((cos_l * cos_v + sin_l * sin_v) * 0.5 + 0.5, 1e-3));
        let sines = sin_l + sin_v;

        // R.
        var m = gauss(sines + cos_half * cos_v * 2.0 * tilt, cos_half * 1.41421356 * style.spread.x + R_FLOOR);
        let r = m * cos_half * fresnel(sqrt(max(vl * 0.5 + 0.5, 0.0))) * R_STRENGTH * style.specular;

        // TT.
        m = gauss(sines - tilt, style.spread.y);
        let a = 1.0 / (BENT_OVER / cos_d + cos_d * BENT_TIMES);
        let h = saturate(cos_half * (a * (cos_phi * ENTER_SLOPE + ENTER) + 1.0));
        var pass_ = 1.0 - fresnel(cos_d * sqrt(max(1.0 - h * h, 0.0)));
        var n = exp2((cos_phi * TT_SLOPE + TT_OFFSET) * LOG2_E);
        let tt = m * n * pass_ * pass_ * style.backlight;
        let tt_path = sqrt(max(1.0 - h * a * h * a, 0.0)) * 0.5 / cos_d;

        // TRT.
        m = gauss(sines - 3.0 * tilt, style.spread.z);
        let f = fresnel(cos_d * 0.5);
        pass_ = 1.0 - f;
        n = exp2((cos_phi * TRT_SLOPE + TRT_OFFSET) * LOG2_E);
        let trt = m * n * pass_ * pass_ * f * TRT_STRENGTH * style.specular;
        let trt_path = TRT_PATH / cos_d;

        // From strand to strand.
        let facing = max((dot(across, l) + 1.0) * 0.25, 0.0) * style.scatter;
        let flat_ = cos_l * MULTIPLE_ROUND * style.scatter;
        let single = (vec3f(r) + tt * exp2(pigment * tt_path) + trt * exp2(pigment * trt_path)) * beam * PI;
        let lost = (pigment * SCATTERED_PIGMENT - SCATTERED_FLOOR) * (depth + (1.0 - through) * BEHIND_BODY) * LOG2_E;
        let multiple = soft * exp2(pigment * 0.5 + lost) * (facing * MULTIPLE_FACING + flat_);
        sum += (single * cos_l + multiple) * frame.lamps[k].color;
    }
    let open = light.w;
    let up = across.y * 0.5 + 0.5;
    let around = frame.ground + up * (frame.sky - frame.ground);
    let near = (around * BOUNCE + frame.lamps[0].color * HAIR_KEY_BOUNCE) * (1.0 - open);
    let far = around * open;
    // What came through hair is dyed on its way; what came between hair and body, once, as a lock is.
    let scattered = far * exp2(pigment * (1.5 - 0.5 * open)) + near * exp2(pigment);
    sum += scattered * style.scatter + (far + near) * HAIR_SHEEN * style.specular;
    return sum;
}

/// Light as it is kept of a point, packed as in `hair/color.rs`.
fn pack_light(light: vec3f) -> u32 {
    let known = select(vec3f(0.0), light, vec3<bool>(finite(light.x), finite(light.y), finite(light.z)));
    let root = sqrt(clamp(known, vec3f(0.0), vec3f(MAX_LIGHT)) / MAX_LIGHT) * CHANNEL_TOPS + 0.5;
    let bits = vec3u(root);
    return bits.x | (bits.y << CHANNEL_GREEN) | (bits.z << CHANNEL_BLUE);
}

/// `color::open`.
fn open_light(bits: u32) -> vec3f {
    let green = (bits >> CHANNEL_GREEN) & u32(CHANNEL_TOPS.y);
    let root = vec3f(f32(bits & u32(CHANNEL_TOPS.x)), f32(green), f32(bits >> CHANNEL_BLUE)) / CHANNEL_TOPS;
    return root * root * MAX_LIGHT;
}
