//! The bust as a signed distance function: head, face, ears, neck and shoulders.
//!
//! The proportions are those of a woman's head in the drawing canon (Loomis 1943): eyes at half height; brow,
//! nose base and chin a third of the face apart; eyes one eye's width apart. Inside this file lengths are in
//! **millimeters**, the unit in which heads are measured; the public functions take and return meters. The
//! head is symmetric: everything is modeled for x ≥ 0.

use super::sdf::{
    self, almond, both, cut, ellipsoid, elliptic_ring, limb, smoothstep, sphere, turned_ellipsoid, union,
};
use glam::{Quat, Vec2, Vec3, vec2, vec3};

/// Millimeters per meter.
const MM: f32 = 1000.0;

/// Center of the (left) eyeball [m].
pub const EYE_CENTER: Vec3 = vec3(0.0315, 0.001, 0.0605);

/// Radius of the eyeball [m]: 2 mm larger than a real one, so that it fills a lid opening of 28 mm.
pub const EYE_RADIUS: f32 = 0.0142;

/// Height at which the bust is cut off flat [m].
pub const BASE: f32 = -0.30;
/// Rounding of the edge there [mm].
const EDGE: f32 = 34.0;

/// Height at which the head alone is cut off flat [m].
pub const NECK: f32 = -0.155;

/// Returns the signed distance to the skin and the clothes [m] at `p` [m]. Slightly below the true distance
/// where shapes blend.
pub fn distance(p: Vec3) -> f32 {
    bust(p, ear)
}

/// [`distance`] with closed eyes and ears without hollows, for coarse meshes.
pub fn plain_distance(p: Vec3) -> f32 {
    let eye = sphere(vec3(p.x.abs(), p.y, p.z), EYE_CENTER, EYE_RADIUS);
    let ear = |q, d| {
        union(d, turned_ellipsoid(q, EAR - vec3(2.0, 0.0, 0.0), vec3(15.0, 28.0, 7.0), ear_turn()), 8.0)
    };
    bust(p, ear).min(eye)
}

/// [`plain_distance`] of the head alone, with closed lids and the neck cut off flat.
pub fn head_distance(p: Vec3) -> f32 {
    let lid = sphere(vec3(p.x.abs(), p.y, p.z) * MM, EYE_CENTER * MM, EYE_RADIUS * MM + LID);
    both(union(plain_distance(p) * MM, lid, 3.0), NECK * MM - p.y * MM, 12.0) / MM
}

/// Returns the distance to the bust, with ears added to the head by `ear`.
fn bust(p: Vec3, ear: impl Fn(Vec3, f32) -> f32) -> f32 {
    let q = mirrored(p);
    let body = torso(q);
    // Far below the head, its details have no effect.
    if q.y < -265.0 {
        return both(body, BASE * MM - q.y, EDGE) / MM;
    }
    let head = ear(q, head(q));
    let d = union(union(body, neck(q), 36.0), head, 14.0);
    both(d, BASE * MM - q.y, EDGE) / MM
}

/// Mirrors `p` [m] to the left side and converts it to millimeters. Rounded over 4 mm, so that the halves
/// meet without a crease.
fn mirrored(p: Vec3) -> Vec3 {
    let x = p.x * MM;
    vec3((x * x + 9.0).sqrt() - 1.5, p.y * MM, p.z * MM)
}

/// Returns the unit outward normal of [`distance`] at `p` [m], by central differences.
pub fn normal(p: Vec3) -> Vec3 {
    // 0.2 mm is well below the smallest feature and well above the rounding of f32 at these sizes.
    sdf::normal(distance, p, 2e-4)
}

/// Cranium and face.
fn head(q: Vec3) -> f32 {
    let mut d = ellipsoid(q, vec3(0.0, 37.0, -24.0), vec3(75.0, 77.0, 82.0));
    d = union(d, ellipsoid(q, vec3(0.0, 33.0, 8.0), vec3(66.0, 71.0, 75.0)), 24.0);
    d = union(d, ellipsoid(q, vec3(0.0, -4.0, -42.0), vec3(59.0, 46.0, 52.0)), 30.0);
    face(q, d)
}

/// Adds the face to the cranium `d`.
fn face(q: Vec3, d: f32) -> f32 {
    // The face from brow to jaw, the jawline and the chin.
    let mut f = ellipsoid(q, vec3(0.0, -22.0, 17.0), vec3(60.0, 86.0, 64.5));
    f = union(f, limb(q, vec3(43.0, -51.0, 0.0), 14.0, vec3(9.0, -96.0, 59.0), 12.5), 30.0);
    f = union(f, ellipsoid(q, vec3(0.0, -101.0, 64.0), vec3(14.5, 13.5, 16.0)), 26.0);
    let mut d = union(d, f, 22.0);
    // Cheekbones, the rounding under the lips, a soft brow.
    d = union(d, ellipsoid(q, vec3(38.0, -21.0, 47.0), vec3(21.0, 16.0, 21.0)), 30.0);
    d = union(d, ellipsoid(q, vec3(0.0, -68.0, 58.0), vec3(30.0, 25.0, 28.0)), 18.0);
    // The cheek between cheekbone and jaw.
    d = union(d, ellipsoid(q, vec3(33.0, -57.0, 40.0), vec3(22.0, 27.0, 21.0)), 26.0);
    d = union(d, limb(q, vec3(4.0, 20.0, 73.0), 8.5, vec3(46.0, 20.0, 53.0), 8.0), 26.0);
    d = eyes(q, d);
    d = nose(q, d);
    mouth(q, d)
}

/// Hollows the eye sockets and places the lids over the eyeball, which is a separate mesh.
fn eyes(q: Vec3, d: f32) -> f32 {
    let c = EYE_CENTER * MM;
    let d = cut(d, ellipsoid(q, c + vec3(0.0, 1.5, 27.0), vec3(19.0, 11.0, 15.0)), 16.0);
    let lids = sphere(q, c, EYE_RADIUS * MM + LID);
    let d = union(d, lids, 7.0);
    // The fold above the upper lid.
    let across = vec2(q.x - c.x, q.y - c.y);
    let fold = vec2(across.y - 8.6 + across.x * across.x * 0.024, q.z - c.z - 14.5);
    let d = if q.z > c.z { cut(d, (fold.length() - 0.7).max(across.x.abs() - 15.0), 2.4) } else { d };
    // The opening: an almond with a slightly higher outer corner, cut as deep as the center of the ball.
    let tilted = Vec2::from_angle(-LID_TILT).rotate(across);
    let opening = almond(tilted - LID_MIDDLE, LID_SIZE.x, LID_SIZE.y).max(c.z - q.z);
    cut(d, opening, 1.6)
}

/// Thickness of the lids [mm].
const LID: f32 = 1.7;
/// Angle by which the outer corner of the lids is higher than the inner [rad].
const LID_TILT: f32 = 0.09;
/// Half the width and half the height of the opening between the lids [mm].
const LID_SIZE: Vec2 = vec2(13.4, 4.7);
/// Offset of its center from that of the eyeball, before the tilt [mm].
const LID_MIDDLE: Vec2 = vec2(0.0, -1.0);

/// Returns the edge of the upper lid, from the inner corner (`u` = −1) to the outer (1): (x, y) [m].
pub fn upper_lid(u: f32) -> Vec2 {
    let (w, h) = (LID_SIZE.x, LID_SIZE.y);
    let drop = (w * w - h * h) / (2.0 * h);
    let edge = vec2(u * w, ((drop + h) * (drop + h) - u * u * w * w).sqrt() - drop);
    Vec2::from_angle(LID_TILT).rotate(edge + LID_MIDDLE) / MM + vec2(EYE_CENTER.x, EYE_CENTER.y)
}

/// Adds the nose: bridge, tip, wings, nostrils.
fn nose(q: Vec3, d: f32) -> f32 {
    let mut n = limb(q, vec3(0.0, 12.0, 74.0), 6.5, vec3(0.0, -33.0, 93.5), 6.5);
    n = union(n, sphere(q, vec3(0.0, -36.5, 95.5), 7.6), 8.0);
    n = union(n, ellipsoid(q, vec3(9.5, -40.5, 85.5), vec3(6.0, 5.6, 8.5)), 7.0);
    let d = union(d, n, 12.0);
    cut(d, ellipsoid(q, vec3(5.2, -47.8, 91.5), vec3(2.3, 3.2, 3.8)), 3.0)
}

/// Adds the lips and separates them.
fn mouth(q: Vec3, d: f32) -> f32 {
    // The groove under the nose.
    let d = cut(d, limb(q, vec3(0.0, -50.0, 95.0), 3.0, vec3(0.0, -59.0, 93.5), 4.0), 6.0);
    // The mouth curves back around the teeth: its depth depends on x.
    let bend = vec3(0.0, 0.0, q.x * q.x * 0.016);
    let p = q + bend;
    let upper = union(
        turned_ellipsoid(p, vec3(8.5, -63.6, 83.0), vec3(14.0, 4.6, 7.6), Quat::from_rotation_z(-0.2)),
        sphere(p, vec3(0.0, -65.5, 85.0), 4.2),
        4.0,
    );
    let lower = ellipsoid(p, vec3(0.0, -72.6, 82.0), vec3(17.5, 5.6, 8.4));
    let lips = union(upper, lower, 1.5);
    let d = union(d, lips, 4.0);
    // The line between them, and the dimple at the corner.
    let line = vec2(p.y + 68.0 - 1.4 * (q.x / 9.0).min(2.0 - q.x / 9.0).max(-1.0) * 0.6, p.z - 91.5);
    let d = cut(d, (vec2(line.x, line.y * 0.3).length() - 0.5).max(q.x - 22.0), 2.6);
    cut(d, sphere(q, vec3(25.5, -68.5, 80.0), 3.0), 9.0)
}

/// Center of the ear [mm].
const EAR: Vec3 = vec3(73.5, -7.0, -14.0);

/// Rotation from the ear's own space: z outward, x to the back of the head, y up along its length.
fn ear_turn() -> Quat {
    Quat::from_rotation_y(1.15) * Quat::from_rotation_z(0.20)
}

/// Adds the ear: a shell that stands off the head, with rim, bowl, lobe and tragus.
fn ear(q: Vec3, d: f32) -> f32 {
    // Beyond the extent of the ear and its blend.
    if q.distance(EAR) > 60.0 {
        return d;
    }
    let mut e = ear_turn().inverse() * (q - EAR);
    // Narrower toward the lobe.
    e.x *= 1.0 - (e.y / 31.0).clamp(-1.0, 1.0) * 0.22;
    let mut shell = ellipsoid(e, Vec3::ZERO, vec3(16.5, 29.0, 5.0));
    shell = union(shell, elliptic_ring(e - vec3(0.0, 2.0, 2.5), vec2(14.6, 26.0), 2.6), 3.0);
    shell = cut(shell, ellipsoid(e, vec3(1.0, -2.0, 8.5), vec3(8.0, 13.0, 6.0)), 4.0);
    shell = union(shell, ellipsoid(e, vec3(-1.0, -25.0, 1.0), vec3(8.0, 8.0, 4.5)), 8.0);
    let root = ellipsoid(q, vec3(64.0, -8.0, -10.0), vec3(10.0, 22.0, 13.0));
    let d = union(d, union(root, shell, 6.0), 7.0);
    union(d, ellipsoid(q, vec3(70.0, -11.0, 4.0), vec3(4.0, 7.0, 4.5)), 4.0)
}

/// The neck: a leaning column with the muscles that turn the head.
fn neck(q: Vec3) -> f32 {
    let column = limb(q, vec3(0.0, -40.0, -22.0), 45.0, vec3(0.0, -195.0, -46.0), 47.0);
    let muscle = limb(q, vec3(50.0, -45.0, -26.0), 8.0, vec3(14.0, -202.0, 0.0), 6.5);
    union(column, muscle, 18.0)
}

/// Trapezius, shoulders, chest and back.
fn torso(q: Vec3) -> f32 {
    let mut d = ellipsoid(q, vec3(0.0, -300.0, -48.0), vec3(165.0, 105.0, 88.0));
    d = union(d, limb(q, vec3(20.0, -150.0, -66.0), 20.0, vec3(125.0, -222.0, -58.0), 20.0), 44.0);
    d = union(d, limb(q, vec3(60.0, -232.0, -52.0), 44.0, vec3(160.0, -240.0, -55.0), 42.0), 40.0);
    d = union(d, limb(q, vec3(168.0, -245.0, -55.0), 47.0, vec3(182.0, -330.0, -52.0), 40.0), 30.0);
    // Collarbones.
    d = union(d, limb(q, vec3(16.0, -209.0, 5.0), 5.5, vec3(130.0, -206.0, -32.0), 7.0), 20.0);
    d
}

/// Positive inside the red of the lips; not an exact distance [m].
pub fn lips(p: Vec3) -> f32 {
    let q = vec3(p.x.abs(), p.y, p.z) * MM;
    if q.z < 60.0 {
        return -1.0;
    }
    // Cupid's bow above, a full arc below, corners at x = 24 mm.
    let x = q.x / 24.0;
    let bow = -60.2 - 1.6 * (1.0 - (q.x / 5.0).min(1.0)) - 8.0 * x * x * (0.35 + 0.65 * x);
    let under = -78.6 + 10.4 * x * x;
    (bow - q.y).min(q.y - under) / MM
}

/// Positive where there are clothes [m]: below a scooped neckline.
pub fn clothes(p: Vec3) -> f32 {
    let q = vec3(p.x.abs(), p.y, p.z) * MM;
    let line = -238.0 + 46.0 * smoothstep(30.0, 130.0, q.x) + 30.0 * smoothstep(0.0, -90.0, q.z);
    (line - q.y) / MM
}

/// Positive where hair grows, and 0 on the hairline; not an exact distance [m].
pub fn scalp(p: Vec3) -> f32 {
    let q = vec3(p.x.abs(), p.y, p.z) * MM;
    let line = hairline(q.x.atan2(q.z - HAIRLINE_CENTER * MM)) * MM;
    // Excludes the ear.
    let ear =
        turned_ellipsoid(q, vec3(77.0, -8.0, -15.0), vec3(13.0, 36.0, 20.0), Quat::from_rotation_x(0.15));
    (q.y - line).min(ear) / MM
}

/// Place on the Z axis from which the angles of the hairline are measured [m].
pub const HAIRLINE_CENTER: f32 = -0.015;

/// Returns the height of the hairline [m] at an angle around the head [rad], 0 at the front and π at the nape.
pub fn hairline(angle: f32) -> f32 {
    let height = HAIRLINE.windows(2).find(|w| angle <= w[1].0).map_or(HAIRLINE[HAIRLINE.len() - 1].1, |w| {
        let t = ((angle - w[0].0) / (w[1].0 - w[0].0)).clamp(0.0, 1.0);
        w[0].1 + (w[1].1 - w[0].1) * smoothstep(0.0, 1.0, t)
    });
    height / MM
}

/// The hairline: (angle around the head [rad], height [mm]) from the middle of the forehead to the nape.
const HAIRLINE: [(f32, f32); 9] = [
    (0.0, 77.0),
    (0.32, 76.0),
    // The temple: recedes, then comes forward and down in front of the ear.
    (0.62, 66.0),
    (0.95, 44.0),
    (1.22, 8.0),
    (1.42, -12.0),
    (1.75, 0.0),
    (2.25, -48.0),
    (3.2, -72.0),
];
