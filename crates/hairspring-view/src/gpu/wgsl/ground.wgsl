// The ground behind everything: the counterpart of `ground.rs`, and of the lookups of `shadow/contact.rs`.

/// Share of the sky that is seen from the middle of each texel; X runs fastest.
@group(0) @binding(4) var<storage, read> contact: array<f32>;

/// `Contact::open`.
fn contact_open(p: vec3f) -> f32 {
    let at = (p.xz - frame.contact_low) / frame.contact_texel - 0.5;
    if !(all(at >= vec2f(0.0)) && all(at < frame.contact_size - 1.0)) {
        return 1.0;
    }
    let share = fract(at);
    let width = u32(frame.contact_size.x);
    let first = u32(at.y) * width + u32(at.x);
    let above = mix(contact[first], contact[first + 1u], share.x);
    let below = mix(contact[first + width], contact[first + width + 1u], share.x);
    return mix(above, below, share.y);
}

/// `ground::fade`.
fn fade(far: f32, near: f32, end: f32) -> f32 {
    let share = saturate((far - near) / (end - near));
    return 1.0 - share * share * (3.0 - 2.0 * share);
}

/// `View::ray`.
fn ray_of(at: vec2f) -> vec3f {
    let offset = (at - 0.5 * frame.size) / frame.focal;
    return frame.forward + frame.right * offset.x - frame.up * offset.y;
}

/// Where a ray meets the ground.
fn met(ray: vec3f) -> vec3f {
    return frame.eye + ray * ((frame.floor_height - frame.eye.y) / min(ray.y, -1e-6));
}

fn key_light(p: vec3f) -> f32 {
    return soft_body_light(p) * exp(-HAIR_SHADE * key_around(p));
}

/// `Floor::over`.
fn over_ground(wall: vec3f, at: vec2f) -> vec3f {
    let ray = ray_of(at);
    if frame.floor_extent <= 0.0 || ray.y >= 0.0 {
        return wall;
    }
    let p = met(ray);
    let far = distance(frame.floor_middle, p.xz) / frame.floor_extent;
    if !(far < FADE_TO) {
        return wall;
    }
    var key = 1.0;
    let long = distance(p, frame.eye) / frame.focal * length(ray) / -ray.y;
    let shaded = all(p.xz >= frame.shade_low - long) && all(p.xz <= frame.shade_high + long);
    if shaded && long < frame.softness {
        key = key_light(p);
    } else if shaded {
        key = 0.0;
        for (var k = 0; k < 8; k++) {
            key += key_light(met(ray_of(at + OUTLINE[k] - 0.5))) * 0.125;
        }
    }
    let open = contact_open(p);
    let whole = frame.floor_key + frame.floor_sky;
    let own = mix(wall, frame.floor_color * whole, frame.floor_colored * fade(far, POOL_FROM, POOL_TO));
    let taken = (frame.floor_key * (1.0 - key) + frame.floor_sky * (1.0 - open)) / max(whole, vec3f(1e-6));
    return own * (1.0 - taken * fade(far, FADE_FROM, FADE_TO));
}
