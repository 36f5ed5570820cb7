//! The bust as a body: meshes with colored parts, skeleton and skin weights.

use super::{
    borders, nets,
    sdf::{self, smoothstep},
    shape,
};
use glam::{Affine3A, Vec3, vec3};
use hairspring::body::{Body, Joint, Mesh, Part, Skin, Trs};

/// Index of the chest joint.
pub const CHEST: usize = 0;
/// Index of the neck joint, a child of the chest.
pub const NECK: usize = 1;
/// Index of the head joint, a child of the neck.
pub const HEAD: usize = 2;

/// Rest positions of the joints [m]: between the shoulder blades, at the base of the neck (vertebra C7), and
/// at the top of the spine (atlas, between the ears).
const JOINTS: [(&str, Vec3); 3] = [
    ("chest", vec3(0.0, -0.27, -0.05)),
    ("neck", vec3(0.0, -0.155, -0.05)),
    ("head", vec3(0.0, -0.022, -0.02)),
];

/// Builds the bust that is drawn and that hair grows on.
pub fn drawn() -> Body {
    let axes = [
        nets::planes(-0.26, 0.26, |x| {
            0.0020 + 0.06 * (x.abs() - 0.045).clamp(0.0, 0.04) + 0.3 * (x.abs() - 0.092).clamp(0.0, 0.025)
        }),
        nets::planes(-0.31, 0.125, |y| {
            0.0019 + 0.2 * ((y + 0.03).abs() - 0.054).clamp(0.0, 0.030) + 0.1 * (-0.12 - y).clamp(0.0, 0.02)
        }),
        nets::planes(-0.16, 0.125, |z| {
            0.0020 + 0.06 * (0.050 - z).clamp(0.0, 0.04) + 0.2 * (-0.045 - z).clamp(0.0, 0.02)
        }),
    ];
    let mut mesh = nets::mesh(&axes, shape::distance, shape::normal);
    borders::cut_along(&mut mesh, shape::clothes);
    borders::cut_along(&mut mesh, shape::lips);
    borders::cut_along(&mut mesh, shape::scalp);
    nets::settle(&mut mesh, shape::distance, shape::normal);
    color(&mut mesh);
    for side in [1.0, -1.0] {
        add_eye(&mut mesh, side);
    }
    rigged(mesh)
}

/// Depth of the collision mesh below the skin [m], so that no hair starts in contact in the rest pose.
const INSET: f32 = 5e-4;

/// Builds a coarser closed mesh, [`INSET`] inside the drawn one, for collisions.
pub fn collision() -> Body {
    let axes = [
        nets::planes(-0.27, 0.27, |x| 0.0105 + 0.12 * (x.abs() - 0.09).clamp(0.0, 0.08)),
        nets::planes(-0.32, 0.14, |y| 0.012 + 0.12 * (-0.13 - y).clamp(0.0, 0.08)),
        nets::planes(-0.16, 0.14, |_| 0.0115),
    ];
    let distance = |p: Vec3| shape::plain_distance(p) + INSET;
    rigged(nets::mesh(&axes, distance, |p| sdf::normal(distance, p, 1e-3)))
}

/// Builds only the bust's head with its neck and closed eyes: a closed mesh of a few thousand vertices, small
/// enough for a file. Its parts are "skin", "lips" and "scalp".
pub fn head() -> Mesh {
    let axes = [
        nets::planes(-0.09, 0.09, |x| 0.0042 + 0.25 * (x.abs() - 0.036).clamp(0.0, 0.04)),
        nets::planes(-0.165, 0.125, |y| 0.0040 + 0.35 * ((y + 0.036).abs() - 0.046).clamp(0.0, 0.03)),
        nets::planes(-0.115, 0.11, |z| 0.0040 + 0.25 * (0.07 - z).clamp(0.0, 0.04)),
    ];
    let normal = |p: Vec3| sdf::normal(shape::head_distance, p, 5e-4);
    let mut mesh = nets::mesh(&axes, shape::head_distance, normal);
    borders::cut_along(&mut mesh, shape::lips);
    borders::cut_along(&mut mesh, shape::scalp);
    nets::settle(&mut mesh, shape::head_distance, normal);
    color(&mut mesh);
    mesh.parts.retain(|part| !part.triangles.is_empty());
    mesh
}

/// Adds the skeleton and weights to a mesh of the bust.
fn rigged(mesh: Mesh) -> Body {
    let mut joints = Vec::new();
    let mut above = Vec3::ZERO;
    for (i, (name, at)) in JOINTS.into_iter().enumerate() {
        let rest = Trs { translation: at - above, ..Trs::default() };
        joints.push(Joint { name: name.into(), parent: i.checked_sub(1).map(|p| p as u32), rest });
        above = at;
    }
    let skin = Skin {
        joints: vec![[CHEST as u16, NECK as u16, HEAD as u16, 0]; mesh.positions.len()],
        weights: mesh.positions.iter().map(|p| weights(*p)).collect(),
        inverse_bind: JOINTS.iter().map(|(_, at)| Affine3A::from_translation(-*at)).collect(),
    };
    Body { mesh, joints, skin: Some(skin) }
}

/// Returns the weights of chest, neck and head for a point of the rest pose [m]; the fourth is unused.
fn weights(p: Vec3) -> [f32; 4] {
    // Heights along the tilted neck, so that chin and skull base both belong to the head and the shoulders to
    // the chest.
    let head_height = p.y + 0.35 * p.z;
    let chest_height = p.y + 0.25 * p.z - 0.8 * (p.x.abs() - 0.055).max(0.0);
    let head = smoothstep(-0.160, -0.098, head_height);
    let chest = smoothstep(-0.155, -0.235, chest_height).min(1.0 - head);
    [chest, 1.0 - head - chest, head, 0.0]
}

/// Sorts the triangles into parts and sets the colors of these.
fn color(mesh: &mut Mesh) {
    let part = |t: &[u32; 3]| {
        let middle = t.iter().map(|i| mesh.positions[*i as usize]).sum::<Vec3>() / 3.0;
        match () {
            () if shape::clothes(middle) > 0.0 => 3,
            () if shape::scalp(middle) > 0.0 => 2,
            () if shape::lips(middle) > 0.0 => 1,
            () => 0,
        }
    };
    let mut sorted: Vec<(usize, [u32; 3])> = mesh.triangles.iter().map(|t| (part(t), *t)).collect();
    sorted.sort_by_key(|(part, _)| *part);
    mesh.triangles = sorted.iter().map(|(_, t)| *t).collect();
    // Linear RGB.
    let looks = [
        ("skin", vec3(0.44, 0.262, 0.186), 0.58),
        ("lips", vec3(0.33, 0.115, 0.100), 0.42),
        // Darkened by stubble between the roots, which also hides its highlight.
        ("scalp", vec3(0.29, 0.17, 0.125), 1.0),
        ("clothes", vec3(0.030, 0.033, 0.040), 0.85),
    ];
    for (i, (name, color, roughness)) in looks.into_iter().enumerate() {
        let run = |limit: usize| sorted.partition_point(|(part, _)| *part < limit) as u32;
        mesh.parts.push(Part { name: name.into(), triangles: run(i)..run(i + 1), color, roughness });
    }
}

/// Darkens the scalp: between dense hair it is seen through the shafts near the roots. `hair`: their color,
/// linear RGB.
pub fn shade_scalp(mesh: &mut Mesh, hair: Vec3) {
    /// Fraction of the scalp that the shafts hide.
    const HIDDEN: f32 = 0.85;
    for part in mesh.parts.iter_mut().filter(|part| part.name == "scalp") {
        part.color = part.color.lerp(hair, HIDDEN);
    }
}

/// Adds an eyeball: a closed ball with its pole at the front, so that iris and pupil are round. `side`: 1 is
/// left, −1 right.
fn add_eye(mesh: &mut Mesh, side: f32) {
    /// Number of points around the axis.
    const ROUND: usize = 40;
    /// Angles of the rings between the poles from the axis of gaze [rad]. The second is the edge of the
    /// pupil, the sixth that of the iris.
    const RINGS: [f32; 13] = [0.07, 0.155, 0.22, 0.28, 0.35, 0.42, 0.48, 0.62, 0.85, 1.15, 1.57, 2.1, 2.65];
    let center = shape::EYE_CENTER * vec3(side, 1.0, 1.0);
    // The lines of sight meet about 2 m ahead: nearly parallel, 1° outward from the axes of the sockets,
    // slightly upward.
    let gaze = glam::Quat::from_rotation_x(-0.01);
    let first = mesh.positions.len() as u32;
    let mut point = |angle: f32, turn: f32| {
        let (s, c) = angle.sin_cos();
        let n = gaze * vec3(s * turn.cos(), s * turn.sin(), c);
        // The cornea: the iris bulges outward slightly.
        let bulge = 0.0006 * (1.0 - smoothstep(0.2, 0.52, angle));
        mesh.positions.push(center + n * (shape::EYE_RADIUS + bulge));
        mesh.normals.push(n);
    };
    point(0.0, 0.0);
    for angle in RINGS {
        for i in 0..ROUND {
            point(angle, i as f32 / ROUND as f32 * std::f32::consts::TAU);
        }
    }
    point(std::f32::consts::PI, 0.0);
    let vertex = |ring: usize, i: usize| first + 1 + (ring * ROUND + i % ROUND) as u32;
    let last = first + 1 + (RINGS.len() * ROUND) as u32;
    let name = if side > 0.0 { "left" } else { "right" };
    let part = |mesh: &mut Mesh, what: &str, rings: std::ops::Range<usize>, color: Vec3, roughness: f32| {
        let from = mesh.triangles.len() as u32;
        for ring in rings {
            for i in 0..ROUND {
                if ring == 0 {
                    mesh.triangles.push([first, vertex(0, i), vertex(0, i + 1)]);
                } else if ring == RINGS.len() {
                    mesh.triangles.push([vertex(ring - 1, i), last, vertex(ring - 1, i + 1)]);
                } else {
                    let (a, b, c, d) =
                        (vertex(ring - 1, i), vertex(ring, i), vertex(ring, i + 1), vertex(ring - 1, i + 1));
                    mesh.triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        let triangles = from..mesh.triangles.len() as u32;
        mesh.parts.push(Part { name: format!("{name} {what}"), triangles, color, roughness });
    };
    part(mesh, "pupil", 0..2, vec3(0.006, 0.005, 0.005), 0.12);
    part(mesh, "iris", 2..6, vec3(0.13, 0.075, 0.035), 0.15);
    part(mesh, "iris rim", 6..7, vec3(0.035, 0.02, 0.012), 0.15);
    part(mesh, "eye white", 7..RINGS.len() + 1, vec3(0.70, 0.66, 0.63), 0.2);
}
