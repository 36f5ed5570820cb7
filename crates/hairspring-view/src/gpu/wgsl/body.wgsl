// Bodies: the counterpart of `body/mod.rs` and `body/skin.rs`. Four samples a pixel tell what is covered; each surface is lit once a pixel.

/// Three numbers a vertex [m].
@group(0) @binding(1) var<storage, read> positions: array<f32>;
/// Three numbers a vertex.
@group(0) @binding(2) var<storage, read> normals: array<f32>;
/// Three vertices, and in the last number the cloth, and above it a bit: has smooth normals.
@group(0) @binding(3) var<storage, read> triangles: array<vec4u>;
/// Linear RGB and roughness of each cloth.
@group(0) @binding(4) var<storage, read> cloths: array<vec4f>;

const SMOOTH: u32 = 0x80000000u;

struct Vertex {
    @builtin(position) at: vec4f,
    @location(0) @interpolate(flat) triangle: u32,
}

fn position(i: u32) -> vec3f {
    return vec3f(positions[3u * i], positions[3u * i + 1u], positions[3u * i + 2u]);
}

fn normal(i: u32) -> vec3f {
    return vec3f(normals[3u * i], normals[3u * i + 1u], normals[3u * i + 2u]);
}

/// A direction's unit vector, or another where it has no length.
fn unit(v: vec3f, otherwise: vec3f) -> vec3f {
    let length2 = dot(v, v);
    return select(otherwise, v * inverseSqrt(length2), length2 > 1e-30);
}

fn known(p: vec3f) -> bool {
    return finite(p.x) && finite(p.y) && finite(p.z);
}

/// Of what a triangle is above the ground, up to four corners, corner number `k`; the last again where it has fewer. `body::clip`.
fn above_ground(corners: mat3x3f, k: u32) -> vec3f {
    var n = 0u;
    var found: vec3f;
    for (var i = 0u; i < 3u && n <= k; i++) {
        let a = corners[i];
        let b = corners[(i + 1u) % 3u];
        let over_a = a.y - frame.floor_height;
        let over_b = b.y - frame.floor_height;
        if over_a > 0.0 {
            found = a;
            n++;
        }
        if (over_a > 0.0) != (over_b > 0.0) && n <= k {
            found = mix(a, b, over_a / (over_a - over_b));
            n++;
        }
    }
    return found;
}

/// Three vertices a triangle; where there is ground, six, of the two that may be left of it.
@vertex
fn surface(@builtin(vertex_index) vertex: u32) -> Vertex {
    var out: Vertex;
    out.at = vec4f(-2.0, -2.0, 0.0, 1.0);
    let cut = frame.floor_extent > 0.0;
    let number = vertex / select(3u, 6u, cut);
    let triangle = triangles[number];
    let a = position(triangle.x);
    let b = position(triangle.y);
    let c = position(triangle.z);
    if !(known(a) && known(b) && known(c)) {
        return out;
    }
    var p = position(triangle[vertex % 3u]);
    let lowest = min(a.y, min(b.y, c.y));
    if cut && (lowest < frame.floor_height || vertex % 6u > 2u) {
        if max(a.y, max(b.y, c.y)) <= frame.floor_height || lowest >= frame.floor_height {
            return out;
        }
        // Corners 0, 1, 2, and 0, 2, 3.
        let k = array(0u, 1u, 2u, 0u, 2u, 3u)[vertex % 6u];
        p = above_ground(mat3x3f(a, b, c), k);
    }
    let d = p - frame.eye;
    let slope = vec2f(dot(d, frame.right), dot(d, frame.up)) * frame.focal;
    // Depth is nearness: NEAR / distance.
    out.at = vec4f(slope / (0.5 * frame.size), NEAR, dot(d, frame.forward));
    out.triangle = number;
    return out;
}

/// `skin::meet`: the weights of a triangle's corners where the ray through the middle of a pixel meets its plane, kept inside the triangle. A place that the
/// card interpolates is not to be trusted at edges: Mesa's software driver weighs it at the centroid and divides by the w of the pixel's middle, so that a
/// place a meter and a half from the origin is off by millimeters, and in the shadow of the surface that it lies on.
fn meet(ray: vec3f, a: vec3f, b: vec3f, c: vec3f) -> vec3f {
    let to_b = b - a;
    let to_c = c - a;
    let q = cross(ray, to_c);
    let det = dot(to_b, q);
    let s = frame.eye - a;
    let u = dot(s, q) / det;
    let v = dot(ray, cross(s, to_b)) / det;
    let weight = vec3f(1.0 - u - v, u, v);
    let inside = clamp(select(vec3f(1.0 / 3.0), weight, known(weight)), vec3f(0.0), vec3f(1.0));
    return inside / (inside.x + inside.y + inside.z);
}

/// One lobe of `skin::specular`.
fn lobe(roughness: f32, nh: f32, nl: f32, nv: f32) -> f32 {
    let a2 = roughness * roughness * roughness * roughness;
    let d = nh * nh * (a2 - 1.0) + 1.0;
    let k = 0.5 * roughness * roughness;
    let visible = (nl * (1.0 - k) + k) * (nv * (1.0 - k) + k);
    return a2 / (d * d) / (4.0 * visible);
}

/// `skin::specular`.
fn specular(n: vec3f, v: vec3f, l: vec3f, roughness: f32, nv: f32) -> f32 {
    let sum = v + l;
    let length2 = dot(sum, sum);
    let h = select(n, sum * inverseSqrt(length2), length2 > 1e-30);
    let nh = max(dot(n, h), 0.0);
    let nl = max(dot(n, l), 1e-3);
    let grazing = 1.0 - max(dot(v, h), 0.0);
    let grazing2 = grazing * grazing;
    let reflected = SKIN_REFLECTANCE + (1.0 - SKIN_REFLECTANCE) * grazing2 * grazing2 * grazing;
    return reflected * min(SKIN_LOBE * lobe(roughness, nh, nl, nv) + (1.0 - SKIN_LOBE) * lobe(SKIN_SHARP * roughness, nh, nl, nv), 12.5663706);
}

/// `skin::light`.
@fragment
fn light(in: Vertex) -> @location(0) vec4f {
    let triangle = triangles[in.triangle];
    let corners = mat3x3f(position(triangle.x), position(triangle.y), position(triangle.z));
    let offset = (in.at.xy - 0.5 * frame.size) / frame.focal;
    let ray = frame.forward + frame.right * offset.x - frame.up * offset.y;
    let weight = meet(ray, corners[0], corners[1], corners[2]);
    let p = corners * weight;
    let eye = -normalize(ray);
    let face = unit(cross(corners[1] - corners[0], corners[2] - corners[0]), vec3f(0.0, 1.0, 0.0));
    var smooth_ = face;
    if (triangle.w & SMOOTH) != 0u {
        smooth_ = mat3x3f(normal(triangle.x), normal(triangle.y), normal(triangle.z)) * weight;
    }
    // Open meshes are seen from both sides.
    let turned = dot(face, eye) < 0.0 && dot(smooth_, eye) < 0.0;
    let n = unit(smooth_, face) * select(1.0, -1.0, turned);
    let cloth = cloths[triangle.w & ~SMOOTH];
    let depth = shadow_around(p + n * (2.5 * frame.voxel));
    let thinned = exp(-HAIR_SHADE * depth.xyz);
    // Key, rim and fill.
    let open = vec3f(area_body_light(p + n * 5e-4, n) * thinned.x, thinned.yz);
    let nv = max(dot(n, eye), 1e-3);
    var diffuse = vec3f(0.0);
    var gloss = vec3f(0.0);
    for (var k = 0; k < 3; k++) {
        let l = frame.lamps[k].direction;
        let nl = dot(n, l);
        let wrapped = max((nl + WRAP) / (1.0 + WRAP), vec3f(0.0)) / (1.0 + WRAP);
        let tinted = vec3f(pow(open[k], 0.75), open[k], pow(open[k], 1.1));
        diffuse += frame.lamps[k].color * wrapped * tinted;
        gloss += frame.lamps[k].color * (specular(n, eye, l, cloth.w, nv) * max(nl, 0.0) * open[k]);
    }
    let open_sky = BOUNCE + (1.0 - BOUNCE) * depth.w;
    let sky = mix(frame.ground, frame.sky, 0.5 + 0.5 * n.y) * open_sky + frame.lamps[0].color * KEY_BOUNCE;
    let grazing = (1.0 - nv) * (1.0 - nv);
    let sheen = SHEEN * grazing * grazing * depth.w;
    let shiny = min((1.0 - cloth.w) / (1.0 - MATTE), 1.0);
    let lit = cloth.xyz * (diffuse + sky) + (gloss + frame.sky * sheen) * shiny;
    return vec4f(select(vec3f(0.0), lit, known(lit)), 1.0);
}

/// The bodies from the key lamp: `DepthMap::fill`.
@vertex
fn from_lamp(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let triangle = triangles[vertex / 3u];
    let p = position(triangle[vertex % 3u]);
    if !(known(position(triangle.x)) && known(position(triangle.y)) && known(position(triangle.z))) {
        return vec4f(-2.0, -2.0, 0.0, 1.0);
    }
    let right = dot(p, frame.map_right) * frame.map_scale + frame.map_left;
    let up = dot(p, frame.map_up) * frame.map_scale + frame.map_top;
    let at = vec2f(right, up) / frame.map_side * 2.0 - 1.0;
    return vec4f(at.x, -at.y, (dot(p, frame.map_toward) - frame.map_low) / frame.map_range, 1.0);
}
