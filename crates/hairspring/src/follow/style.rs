//! Styling of follow hairs: clumps, curls and flyaways.

use crate::settings::Effects;
use glam::Vec3;

/// Smallest length of hair in one turn of a curl [m].
const MIN_CURL_LENGTH: f32 = 1e-4;

/// Applies clumping toward the first guide, then curls, then noise. Each grows from zero at the root.
pub(super) fn apply_styling(
    effects: &Effects,
    strand: u32,
    lead: &[Vec3],
    ride: &[[u16; 3]],
    points: &mut [Vec3],
) {
    let last = (points.len() - 1) as f32;
    if effects.clump > 0.0 {
        for (i, (p, ride)) in points.iter_mut().zip(ride).enumerate().skip(1) {
            *p = p.lerp(point_on_guide(lead, ride[0]), effects.clump * (i as f32 / last).powf(1.5));
        }
    }
    if effects.curl_radius > 0.0 || effects.noise > 0.0 {
        displace(effects, strand, points);
    }
}

/// Returns the point of a guide at a coordinate, given the guide's points `lead`.
pub(super) fn point_on_guide(lead: &[Vec3], coordinate: u16) -> Vec3 {
    let at = coordinate as f32 / u16::MAX as f32 * (lead.len() - 1) as f32;
    let k = (at as usize).min(lead.len() - 2);
    lead[k].lerp(lead[k + 1], at - k as f32)
}

/// Adds a helix and low-frequency noise. Both are given in a frame transported along the strand, so they
/// swing with it.
fn displace(effects: &Effects, strand: u32, points: &mut [Vec3]) {
    let last = (points.len() - 1) as f32;
    let [phase, wander @ ..] = phases(strand);
    let mut tangent = (points[1] - points[0]).normalize_or(Vec3::Y);
    let mut normal = tangent.any_orthonormal_vector();
    let mut arc = 0.0;
    let mut before = points[0];
    for (i, p) in points.iter_mut().enumerate().skip(1) {
        let here = *p;
        let step = here - before;
        arc += step.length();
        let t = step.normalize_or(tangent);
        normal = (normal - t * normal.dot(t)).normalize_or(t.any_orthonormal_vector());
        let side = t.cross(normal);
        let s = i as f32 / last;
        let turn = phase + arc / effects.curl_length.max(MIN_CURL_LENGTH) * std::f32::consts::TAU;
        let curl = (normal * (turn.cos() - phase.cos()) + side * (turn.sin() - phase.sin()))
            * (effects.curl_radius * s.min(0.25) * 4.0);
        let wave = |a: f32, b: f32| 0.7 * (a + s * 4.0).sin() + 0.3 * (b + s * 11.0).sin();
        let noise = (normal * wave(wander[0], wander[1]) + side * wave(wander[2], wander[3]))
            * (effects.noise * s * s);
        *p = here + curl + noise;
        (before, tangent) = (here, t);
    }
}

/// See [`FollowLayout::phases`](super::FollowLayout::phases).
pub(super) fn phases(strand: u32) -> [f32; 5] {
    [0, 1, 2, 3, 4].map(|k| hash(strand, k) * std::f32::consts::TAU)
}

/// Returns a number from 0 to 1 that depends only on the strand and `k` (an integer mix by Steele et al.
/// 2014, SplitMix).
fn hash(strand: u32, k: u32) -> f32 {
    let mut z = (strand as u64) << 32 | k as u64;
    z = z.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
}
