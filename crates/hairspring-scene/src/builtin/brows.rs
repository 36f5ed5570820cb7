//! Eyebrows, eyelashes and the fine hair of the hairline: short hairs that make the face look natural.

use super::{random::Random, sdf::smoothstep, shape};
use glam::{Vec2, Vec3, vec2, vec3};
use hairspring::groom::Groom;

/// Number of hairs in one brow.
const BROW_HAIRS: u32 = 420;
/// Number of hairs on one upper lid; a real one has 90 to 150.
const LASHES: u32 = 110;
/// Number of fine hairs on each half of the hairline.
const FINE_HAIRS: u32 = 320;
/// Width of the band below the hairline in which they grow [m].
const FINE_BAND: f32 = 0.009;
/// Angle around the head at which they end, in front of the ear [rad].
const FINE_END: f32 = 1.2;
/// Thickness of fine hair, relative to that of brows [1].
const FINE: f32 = 0.5;
/// Points per hair.
const POINTS: usize = 6;
/// Radius at the root [m]: brow hairs and lashes are coarser than scalp hair.
const RADIUS: f32 = 45e-6;
/// Minimum distance of any point except the root from the skin [m].
const CLEARANCE: f32 = 4e-4;
/// Center line of the left brow from the nose outward: (x, y), and half its width [m].
const BROW: [(Vec2, f32); 5] = [
    (vec2(0.0125, 0.0165), 0.0034),
    (vec2(0.0210, 0.0195), 0.0036),
    (vec2(0.0320, 0.0230), 0.0030),
    (vec2(0.0400, 0.0230), 0.0020),
    (vec2(0.0485, 0.0185), 0.0007),
];

/// Creates both brows, the lashes of both upper lids, and the fine hair of the hairline.
pub fn groom(seed: u32) -> Groom {
    let mut strands = Vec::new();
    let mut groups = Vec::new();
    for side in [1.0, -1.0] {
        for i in 0..BROW_HAIRS {
            strands.push(brow_hair(side, Random::new(seed, 6, i * 2 + u32::from(side > 0.0))));
            groups.push(0);
        }
        for i in 0..LASHES {
            strands.push(lash(side, i, Random::new(seed, 7, i * 2 + u32::from(side > 0.0))));
            groups.push(1);
        }
        for i in 0..FINE_HAIRS {
            strands.push(fine_hair(side, Random::new(seed, 8, i * 2 + u32::from(side > 0.0))));
            groups.push(2);
        }
    }
    let mut groom = Groom::from_strands(&strands, RADIUS);
    for (strand, group) in groom.radii.chunks_exact_mut(POINTS).zip(&groups) {
        let thickness = if *group == 2 { FINE } else { 1.0 };
        // Pointed tips: these hairs are never cut.
        let taper = |k: usize| thickness * (1.0 - 0.8 * k as f32 / (POINTS - 1) as f32);
        strand.iter_mut().enumerate().for_each(|(k, r)| *r *= taper(k));
    }
    groom.groups = groups;
    groom.group_names = vec!["brows".into(), "lashes".into(), "hairline".into()];
    groom
}

/// Creates one hair of the brow on `side` (1: left). It leans up and outward, more outward farther from the
/// nose.
fn brow_hair(side: f32, mut random: Random) -> [Vec3; POINTS] {
    // Position along the brow and across it: densest at the center line.
    let along = random.unit() * (BROW.len() - 1) as f32;
    let (i, t) = (along as usize, along.fract());
    let (a, b) = (BROW[i], BROW[(i + 1).min(BROW.len() - 1)]);
    let across = (random.signed() + random.signed()) * 0.5;
    let at = a.0.lerp(b.0, t) + Vec2::Y * across * (a.1 + (b.1 - a.1) * t);
    let outer = along / (BROW.len() - 1) as f32;
    let up = 0.9 * (1.0 - smoothstep(0.0, 0.45, outer)) + 0.15 - 0.5 * outer - 0.35 * across;
    let heading = vec3(1.0, up + 0.15 * random.normal(), 0.0).normalize();
    let length = random.within(0.0055, 0.0085) * (1.0 - 0.3 * outer);
    let root = surface(at);
    let normal = shape::normal(root);
    let heading =
        (heading.reject_from(normal).normalize_or(Vec3::X) + normal * random.within(0.2, 0.4)).normalize();
    strand(root, heading, heading.reject_from(normal) * 0.4 - normal * 0.35, length, side)
}

/// Creates the `i`-th lash of the upper lid on `side` (1: left): out, then up, fanned toward the corners.
fn lash(side: f32, i: u32, mut random: Random) -> [Vec3; POINTS] {
    let u = (i as f32 + random.unit()) / LASHES as f32 * 1.86 - 0.93;
    let root = surface(shape::upper_lid(u) + Vec2::Y * random.within(0.0006, 0.0012));
    let heading = vec3(0.35 * u + 0.1 + 0.06 * random.normal(), -0.35, 1.0).normalize();
    let length = random.within(0.0055, 0.0075) * (0.75 + 0.25 * smoothstep(-1.0, 0.3, u));
    strand(root, heading, vec3(0.15 * u + 0.1, 0.85, 0.1), length, side)
}

/// Creates a fine hair below the hairline on `side` (1: left): short, and combed back with the hair above it.
fn fine_hair(side: f32, mut random: Random) -> [Vec3; POINTS] {
    // Densest at the hairline.
    let below = random.unit() * random.unit();
    let angle = random.unit() * FINE_END;
    let root = skin_at(angle, shape::hairline(angle) - 0.0005 - FINE_BAND * below);
    let normal = shape::normal(root);
    let away = vec3(0.5 + 0.25 * random.normal(), 1.0, -0.4 + 0.2 * random.normal());
    let heading =
        (away.reject_from(normal).normalize_or(Vec3::Y) + normal * random.within(0.15, 0.4)).normalize();
    let length = random.within(0.010, 0.022) * (1.0 - 0.6 * below);
    strand(root, heading, vec3(0.3 * random.normal(), 0.0, -0.3) - normal * 0.5, length, side)
}

/// Returns the point of the skin at an angle around the head [rad] and a height [m], found by marching in.
fn skin_at(angle: f32, height: f32) -> Vec3 {
    let out = vec3(angle.sin(), 0.0, angle.cos());
    let mut p = vec3(0.0, height, shape::HAIRLINE_CENTER) + out * 0.13;
    for _ in 0..80 {
        p -= out * shape::distance(p) * 0.8;
    }
    p
}

/// Creates a hair of the left side, or its mirror image, that leaves `root` along `heading` and bends by
/// `bend` over its length.
fn strand(root: Vec3, heading: Vec3, bend: Vec3, length: f32, side: f32) -> [Vec3; POINTS] {
    let step = length / (POINTS - 1) as f32;
    let mut points = [root; POINTS];
    for k in 1..POINTS {
        let t = (k as f32 - 0.5) / (POINTS - 1) as f32;
        let mut next = points[k - 1] + (heading + bend * t).normalize_or(heading) * step;
        for _ in 0..3 {
            let d = shape::distance(next);
            if d < CLEARANCE {
                next += shape::normal(next) * (CLEARANCE * 1.1 - d);
            }
        }
        points[k] = next;
    }
    points.map(|p| p * vec3(side, 1.0, 1.0))
}

/// Returns the foremost point of the skin at (x, y) [m], found by marching in from the front.
fn surface(at: Vec2) -> Vec3 {
    let mut p = at.extend(0.12);
    for _ in 0..60 {
        p.z -= shape::distance(p) * 0.8;
    }
    p
}
