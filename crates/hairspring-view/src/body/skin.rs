//! The color of a body's surface under the three lamps and the sky.

use super::Lit;
use crate::{camera::View, frame::MeshDraw};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Sky light that reaches skin under hair by reflection between hair, neck and shoulders [1]. Without it the
/// throat would be black.
pub(crate) const BOUNCE: f32 = 0.3;
/// The corresponding fraction of the key lamp's light, reflected from lit skin and cloth nearby [1].
pub(crate) const KEY_BOUNCE: f32 = 0.03;

/// Base color and roughness of triangles that belong to no part: light skin.
pub(crate) const SKIN: (Vec3, f32) = (Vec3::new(0.62, 0.38, 0.28), 0.5);
/// Subsurface scattering into the shadow side of skin, strongest for red: how far the lit half is wrapped
/// past the terminator (d'Eon & Luebke 2007 give the scattering distances 3.7, 1.4, 0.7 mm for red, green,
/// blue; the ratio is kept).
pub(crate) const WRAP: Vec3 = Vec3::new(0.32, 0.16, 0.10);
/// How strongly hair attenuates the key lamp's light on skin, per optical depth. It is below 1, because
/// strands transmit part of the light.
pub(crate) const HAIR_SHADE: f32 = 0.75;

/// Reflectance of skin at normal incidence (d'Eon & Luebke 2007).
pub(crate) const REFLECTANCE: f32 = 0.028;
/// The two specular lobes: the weight of the wide one, and the roughness of the narrow one relative to it.
pub(crate) const LOBES: (f32, f32) = (0.75, 0.6);
/// Strength of the sheen at grazing angles.
pub(crate) const SHEEN: f32 = 0.25;
/// Roughness above which the specular reflection decreases linearly, to 0 at roughness 1 [1]. Wool and the scalp between
/// hairs are matte: their own fibers shadow the highlight.
pub(crate) const MATTE: f32 = 0.85;

/// Light leaving triangle `t` of `body` toward the camera, at the pixel position `at`.
pub(crate) fn light(lit: &Lit, body: &MeshDraw, t: usize, at: Vec2) -> Vec3 {
    let Lit { frame, view, shadow, level } = *lit;
    let [ia, ib, ic] = body.triangles[t].map(|i| i as usize);
    let [a, b, c] = [ia, ib, ic].map(|i| body.positions[i]);
    let ray = view.ray(at.x, at.y);
    let (p, weight) = meet(view, [a, b, c], at);
    let flat = (b - a).cross(c - a).normalize_or(Vec3::Y);
    let smooth = match body.smooth() {
        true => body.normals[ia] * weight.x + body.normals[ib] * weight.y + body.normals[ic] * weight.z,
        false => flat,
    };
    let eye = -ray.normalize();
    // Open meshes are visible from both sides.
    let facing = if flat.dot(eye) < 0.0 && smooth.dot(eye) < 0.0 { -1.0 } else { 1.0 };
    let n = smooth.try_normalize().unwrap_or(flat) * facing;
    let part = part(body, t).map(|part| &body.parts[part]);
    let (base, roughness) = part.map_or(SKIN, |p| (p.color, p.roughness.clamp(0.15, 1.0)));
    let lamps = &frame.lighting;

    // The hair shadow is sampled slightly off the surface, so that the voxels of the surface itself do not
    // count.
    let depth = shadow.around(p + n * (2.5 * shadow.voxel()));
    let key_open = shadow.on_skin(level, p + n * 5e-4, n) * (-HAIR_SHADE * depth.x).exp();
    let open = [key_open, (-HAIR_SHADE * depth.y).exp(), (-HAIR_SHADE * depth.z).exp()];
    let nv = n.dot(eye).max(1e-3);
    let mut diffuse = Vec3::ZERO;
    let mut gloss = Vec3::ZERO;
    for (light, open) in [&lamps.key, &lamps.fill, &lamps.rim].into_iter().zip([open[0], open[2], open[1]]) {
        let l = light.direction.normalize_or(Vec3::Y);
        let nl = n.dot(l);
        // Wrapped Lambert, normalized so that the total stays the same.
        let wrapped = ((Vec3::splat(nl) + WRAP) / (Vec3::ONE + WRAP)).max(Vec3::ZERO) / (Vec3::ONE + WRAP);
        // Red light leaks past the edge of a shadow, as it does past the terminator.
        let root = open.sqrt();
        let tinted = Vec3::new(root * root.sqrt(), open, open.powf(1.1));
        diffuse += light.color * wrapped * tinted;
        gloss += light.color * (specular(n, eye, l, roughness, nv) * nl.max(0.0) * open);
    }
    let open_sky = BOUNCE + (1.0 - BOUNCE) * depth.w;
    let sky = lamps.ground.lerp(lamps.sky, 0.5 + 0.5 * n.y) * open_sky + lamps.key.color * KEY_BOUNCE;
    // Sheen at grazing angles, from vellus hair and the oil on skin.
    let sheen = SHEEN * (1.0 - nv).powi(4) * depth.w;
    let shiny = ((1.0 - roughness) / (1.0 - MATTE)).min(1.0);
    let lit = base * (diffuse + sky) + (gloss + lamps.sky * sheen) * shiny;
    if lit.is_finite() { lit } else { Vec3::ZERO }
}

/// Index of the part of `body` that triangle `t` belongs to; `None` if it belongs to no part.
pub(crate) fn part(body: &MeshDraw, t: usize) -> Option<usize> {
    body.parts.iter().position(|p| p.triangles.contains(&(t as u32)))
}

/// Two GGX lobes, as for skin (d'Eon & Luebke 2007), with Schlick's Fresnel term at the skin's reflectance of
/// 2.8 %.
fn specular(n: Vec3, v: Vec3, l: Vec3, roughness: f32, nv: f32) -> f32 {
    let h = (v + l).normalize_or(n);
    let (nh, nl) = (n.dot(h).max(0.0), n.dot(l).max(1e-3));
    let lobe = |roughness: f32| {
        let a2 = roughness.powi(4);
        let d = nh * nh * (a2 - 1.0) + 1.0;
        let k = 0.5 * roughness * roughness;
        let visible = (nl * (1.0 - k) + k) * (nv * (1.0 - k) + k);
        // Lamps are in units of a white card, so the factor π cancels the 1/π of the lobe.
        a2 / (d * d) / (4.0 * visible)
    };
    let fresnel = REFLECTANCE + (1.0 - REFLECTANCE) * (1.0 - v.dot(h).max(0.0)).powi(5);
    fresnel * (LOBES.0 * lobe(roughness) + (1.0 - LOBES.0) * lobe(LOBES.1 * roughness)).min(4.0 * PI)
}

/// Intersection of the ray through the pixel position `at` with the triangle's plane, and the corners' weights
/// there, clamped to the triangle.
pub(crate) fn meet(view: &View, [a, b, c]: [Vec3; 3], at: Vec2) -> (Vec3, Vec3) {
    let ray = view.ray(at.x, at.y);
    let (e1, e2) = (b - a, c - a);
    let q = ray.cross(e2);
    let det = e1.dot(q);
    let s = view.eye - a;
    let u = s.dot(q) / det;
    let v = ray.dot(s.cross(e1)) / det;
    let weight = Vec3::new(1.0 - u - v, u, v);
    let weight =
        if weight.is_finite() { weight.clamp(Vec3::ZERO, Vec3::ONE) } else { Vec3::splat(1.0 / 3.0) };
    let weight = weight / weight.element_sum();
    (a * weight.x + b * weight.y + c * weight.z, weight)
}
