//! An open right hand, generated in code. Its fingers are slightly spread and bent, as when stroking a head.
//!
//! ```text
//!      y  ╷ ╷ ╷          the fingers point along +y, the back of the hand faces +z, and the palm −z;
//!      │╷ │ │ │ ╷        the thumb is at −x. The origin is in the middle of the palm
//!      ││ │ │ │ │
//!      │ ╲│     │ ╱
//!      └──│  ·  │── x
//! ```

use super::{
    nets,
    sdf::{self, limb, union},
};
use glam::{Quat, Vec3, vec3};
use hairspring::body::{Mesh, Part};

/// Millimeters per meter. Lengths in this file are in millimeters, except for the results.
const MM: f32 = 1000.0;

/// Blending distance of the fingers with the palm [mm].
const BLEND: f32 = 7.0;
/// Blending distance between the rows of the palm [mm].
const FLAT: f32 = 4.0;

/// A distance farther than any piece [mm].
const FAR: f32 = 1e4;

/// Ratio of a finger's radius at one joint to that at the joint before [1].
const THINNER: f32 = 0.93;

/// A finger: position of its knuckle and the radius there; its rotation toward the little finger's side; the
/// bend at each of its three joints, first the knuckle [degrees]; and the lengths of its three bones.
struct Finger {
    knuckle: Vec3,
    radius: f32,
    turn: f32,
    bend: [f32; 3],
    bones: [f32; 3],
}

/// Bone lengths from Buryanov & Kotiuk 2010, *Proportions of Hand Segments*: means of adults. The last
/// includes the pulp of the tip, less its radius.
const FINGERS: [Finger; 4] = [
    Finger {
        knuckle: vec3(-27.0, 38.0, -1.0),
        radius: 9.2,
        turn: -9.0,
        bend: [8.0, 15.0, 9.0],
        bones: [40.0, 22.5, 15.0],
    },
    Finger {
        knuckle: vec3(-7.5, 42.0, 1.0),
        radius: 9.4,
        turn: -2.0,
        bend: [8.0, 16.0, 9.0],
        bones: [44.5, 26.5, 16.5],
    },
    Finger {
        knuckle: vec3(12.0, 38.5, 0.5),
        radius: 9.0,
        turn: 5.0,
        bend: [10.0, 18.0, 10.0],
        bones: [41.0, 25.5, 16.5],
    },
    Finger {
        knuckle: vec3(29.0, 29.0, -2.5),
        radius: 8.0,
        turn: 14.0,
        bend: [13.0, 18.0, 10.0],
        bones: [32.5, 18.0, 14.5],
    },
];

/// Joints of the thumb from the wrist to its tip, with the radius at each.
const THUMB: [(Vec3, f32); 4] = [
    (vec3(-16.0, -36.0, -9.0), 14.0),
    (vec3(-42.0, -8.0, -15.0), 12.0),
    (vec3(-60.0, 17.0, -19.0), 9.6),
    (vec3(-70.0, 41.0, -22.0), 8.2),
];

/// Height of the wrist, half of its width, and the height of the arm's end.
const WRIST: [f32; 3] = [-46.0, 15.0, -72.0];

/// Radius of the palm at the knuckles and at the wrist, and radius of the wrist.
const PALM: [f32; 3] = [10.8, 13.5, 16.0];

/// Rows of the palm: one for each finger, and one between each two.
const ROWS: usize = 7;

/// An open right hand with a piece of its arm. The fingers are slightly spread and bent. They point along +y,
/// the back of the hand faces +z, the thumb is at −x, and the origin is in the middle of the palm.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// Its skin, a closed mesh [m].
    pub mesh: Mesh,
    /// Collision shapes: both ends of each capsule's axis, and its radius [m]. Together they match the skin,
    /// except for 3 mm at the base of the fingers.
    pub capsules: Vec<(Vec3, Vec3, f32)>,
}

impl Hand {
    /// Length from the crease of the wrist to the tip of the middle finger [m]: between the means of women
    /// and of men.
    pub const LENGTH: f32 = 0.177;

    /// Edge of a meshing cell for the skin that is displayed [m].
    pub const CELL: f32 = 0.0022;
}

/// A piece: start point and radius there, end point and radius there [mm].
type Piece = (Vec3, f32, Vec3, f32);

/// Returns the pieces of the palm and those of each finger. Within a finger, each piece starts where the
/// previous one ends, with the same radius.
fn parts() -> [Vec<Piece>; 6] {
    let [wrist, half, end] = WRIST;
    let row = |row: usize| {
        let along = 0.5 * row as f32;
        let (a, b) = (&FINGERS[row / 2], &FINGERS[(row / 2 + 1).min(3)]);
        let knuckle = a.knuckle.lerp(b.knuckle, along.fract());
        let foot = vec3(half * (2.0 * row as f32 / (ROWS - 1) as f32 - 1.0), wrist, 0.0);
        (foot, PALM[1], knuckle, PALM[0])
    };
    let arm = |x: f32| (vec3(x, wrist, 0.0), PALM[2] - 2.5, vec3(x, end, 0.0), PALM[2]);
    // The ball of the hand below the little finger.
    let ball = (vec3(15.0, -34.0, -5.0), 12.5, vec3(27.0, 8.0, -6.0), 10.0);
    let palm = (0..ROWS).map(row).chain([-9.0, 0.0, 9.0].map(arm)).chain([ball]).collect();
    let finger = |finger: &Finger| {
        let aside = Quat::from_rotation_z(-finger.turn.to_radians());
        let (mut at, mut bent, mut radius) = (finger.knuckle, 0.0, finger.radius);
        let bones = finger.bones.iter().zip(finger.bend).map(|(bone, bend)| {
            bent += f32::to_radians(bend);
            let next = at + aside * Quat::from_rotation_x(-bent) * Vec3::Y * *bone;
            let piece = (at, radius, next, THINNER * radius);
            (at, radius) = (next, THINNER * radius);
            piece
        });
        bones.collect()
    };
    let [a, b, c, d] = &FINGERS;
    let thumb = THUMB.windows(2).map(|joints| (joints[0].0, joints[0].1, joints[1].0, joints[1].1));
    [palm, thumb.collect(), finger(a), finger(b), finger(c), finger(d)]
}

/// Creates the hand. The result is bitwise identical for any number of threads. `cell` is the edge of a
/// meshing cell [m], up to 0.005, at which fingers are still round; [`Hand::CELL`] is fine enough for close
/// views.
pub fn hand(cell: f32) -> Hand {
    let parts = parts();
    let distance = |p: Vec3| {
        let piece = |(a, ra, b, rb): &Piece| limb(p * MM, *a, *ra, *b, *rb);
        let [palm, fingers @ ..] = &parts;
        let palm = palm.iter().map(piece).fold(FAR, |a, b| union(a, b, FLAT));
        let fingers = fingers.iter().map(|bones| bones.iter().map(piece).fold(FAR, f32::min));
        fingers.fold(palm, |a, b| union(a, b, BLEND)) / MM
    };
    let planes = |from: f32, to: f32| nets::planes(from, to, |_| cell);
    let axes = [planes(-0.090, 0.075), planes(-0.098, 0.150), planes(-0.070, 0.030)];
    let mut mesh = nets::mesh(&axes, distance, |p| sdf::normal(distance, p, 2e-4));
    // Linear RGB; matte, so that the hair has the only highlights.
    let (color, all) = (vec3(0.50, 0.36, 0.29), 0..mesh.triangles.len() as u32);
    mesh.parts.push(Part { name: "hand".into(), triangles: all, color, roughness: 0.7 });
    let capsule = |(a, ra, b, rb): Piece| (a / MM, b / MM, ra.max(rb) / MM);
    Hand { mesh, capsules: parts.into_iter().flatten().map(capsule).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hand_is_a_closed_mesh_of_natural_size_inside_its_capsules() {
        let Hand { mesh, capsules } = hand(Hand::CELL);
        let (low, high) = mesh.bounds().unwrap();
        assert!((high.y + 0.001 * -WRIST[0] - Hand::LENGTH).abs() < 0.002, "{} m above the palm", high.y);
        assert!(low.cmpgt(vec3(-0.088, -0.096, -0.068)).all(), "{low}");
        assert!(high.cmplt(vec3(0.073, 0.148, 0.028)).all(), "{high}");
        // Each edge belongs to two triangles, once in each direction.
        let mut edges = std::collections::HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|n| *n == 0), "it is closed");
        let volume: f32 =
            (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        // A hand with a piece of its arm displaces about a third of a liter.
        assert!((2.5e-4..4.5e-4).contains(&volume), "{} l", 1e3 * volume);
        let off = |p: &Vec3| {
            let capsule = |(a, b, radius): &(Vec3, Vec3, f32)| {
                0.001 * limb(*p * MM, *a * MM, radius * MM, *b * MM, radius * MM)
            };
            capsules.iter().map(capsule).fold(f32::MAX, f32::min)
        };
        let (least, most) =
            mesh.positions.iter().map(off).fold((0.0f32, 0.0f32), |(l, m), d| (l.min(d), m.max(d)));
        assert!(most < 3e-3 && least > -4e-3, "the skin is from {least} to {most} m off the capsules");
    }
}
