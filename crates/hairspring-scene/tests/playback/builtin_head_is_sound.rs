//! Promise: the data of the built-in scene is sound. New users see this scene first, and measurements use
//! it. Its meshes are closed, so that contact has an inside and an outside. Roots are on the skin and
//! evenly spread. In the rest pose hair is outside the body, with nearly even spacing along each hair. The
//! motion starts and ends at rest and stays within the range of a human neck. Every run gives the same bits
//! on any number of threads.
//!
//! Hair is tested against the *drawn mesh* and not against the distance function that it was combed with.
//! The test uses no code of the scene for this.

use glam::{IVec3, Vec3};
use hairspring::{body::Mesh, groom::Groom};
use hairspring_scene::{
    Scene,
    builtin::{BuiltinOptions, Style, scene},
};
use hairspring_test::on_threads;
use std::collections::HashMap;

/// A scene that is small enough for a test.
fn small(style: Style) -> Scene {
    scene(&BuiltinOptions { strands: 2_500, ..BuiltinOptions::new(style) })
}

#[test]
fn every_edge_has_two_triangles() {
    let scene = small(Style::Wavy);
    for (name, body) in [("drawn", scene.body.unwrap()), ("collision", scene.collision.unwrap())] {
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for t in &body.mesh.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                assert_ne!(a, b, "{name}: a triangle uses vertex {a} twice");
                // Each edge is used once in each direction, so neighboring triangles agree about the
                // outside.
                assert!(
                    edges.insert((a, b), 1).is_none(),
                    "{name}: edge {a} to {b} is used twice the same way"
                );
            }
        }
        let open = edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).count();
        assert_eq!(open, 0, "{name}: there are {open} open edges");
        assert!(volume(&body.mesh) > 0.008, "{name}: the mesh is inside out or hollow");
    }
}

#[test]
fn meshes_have_moderate_triangle_counts() {
    let scene = small(Style::ShortFur);
    let drawn = scene.body.unwrap().mesh;
    assert!((15_000..75_000).contains(&drawn.triangles.len()), "{} triangles drawn", drawn.triangles.len());
    let collision = scene.collision.unwrap().mesh.triangles.len();
    assert!((2_000..6_000).contains(&collision), "{collision} triangles to collide with");
    let (lo, hi) = drawn.bounds().unwrap();
    assert!((hi.y - 0.115).abs() < 0.005 && hi.x - lo.x < 0.5, "not the size of a bust: {lo} to {hi}");
    assert_eq!(drawn.parts.iter().map(|p| p.triangles.len()).sum::<usize>(), drawn.triangles.len());
    for (p, n) in drawn.positions.iter().zip(&drawn.normals) {
        assert!(p.is_finite() && (n.length() - 1.0).abs() < 1e-3, "normal {n} at {p}");
    }
}

#[test]
fn skin_weights_sum_to_one_and_shoulders_stay_fixed() {
    let body = small(Style::ShortFur).body.unwrap();
    let skin = body.skin.as_ref().unwrap();
    let (chest, head) = (body.joint("chest").unwrap(), body.joint("head").unwrap());
    for (p, w) in body.mesh.positions.iter().zip(&skin.weights) {
        assert!((w.iter().sum::<f32>() - 1.0).abs() < 1e-5 && w.iter().all(|w| *w >= 0.0), "{w:?} at {p}");
        if p.x.abs() > 0.13 {
            assert!(w[chest] > 0.99, "the shoulder at {p} moves with {w:?}");
        }
        if p.y > 0.0 {
            assert!(w[head] > 0.99, "the head at {p} moves with {w:?}");
        }
    }
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    body.skinned(&body.world(&body.rest_pose()), &mut positions, &mut normals);
    for (a, b) in positions.iter().zip(&body.mesh.positions) {
        assert!(a.distance(*b) < 1e-6, "rest pose moves {b} to {a}");
    }
}

#[test]
fn roots_are_on_the_skin_and_other_points_outside() {
    for style in Style::ALL {
        let scene = scene(&BuiltinOptions { strands: 1_000, ..BuiltinOptions::new(style) });
        let surface = Surface::new(&scene.body.as_ref().unwrap().mesh);
        // Roots on the scalp are taken from the mesh; those of brows and lashes from the smooth shape that
        // it approximates.
        for (groom, tolerance) in scene.grooms.iter().map(|g| &g.groom).zip([1e-5, 6e-4]) {
            for s in 0..groom.strand_count() {
                let strand = groom.strand(s);
                let root = surface.signed_distance(strand[0]);
                assert!(
                    root.abs() < tolerance,
                    "{} strand {s}: the root is {root} m from the skin",
                    style.name()
                );
                for (k, p) in strand.iter().enumerate().skip(1) {
                    let d = surface.signed_distance(*p);
                    assert!(d > 1e-4, "{} strand {s} point {k} at {p}: {d} m outside", style.name());
                }
            }
        }
    }
}

#[test]
fn points_are_nearly_evenly_spaced() {
    for style in Style::ALL {
        let groom = &small(style).grooms[0].groom;
        for s in 0..groom.strand_count() {
            let strand = groom.strand(s);
            let mean = groom.strand_length(s) / (strand.len() - 1) as f32;
            for w in strand.windows(2) {
                let l = w[0].distance(w[1]) / mean;
                assert!(
                    (0.35..2.0).contains(&l),
                    "{} strand {s}: a segment {l} times the mean",
                    style.name()
                );
            }
        }
    }
}

#[test]
fn roots_are_evenly_spread() {
    let scene = scene(&BuiltinOptions { strands: 20_000, ..BuiltinOptions::new(Style::ShortFur) });
    let groom = &scene.grooms[0].groom;
    assert_eq!(groom.strand_count(), 20_000);
    // The distance of each root to its nearest neighbor. For random roots it would vary by 52 % about the
    // mean.
    let roots: Vec<Vec3> = (0..groom.strand_count()).map(|s| groom.strand(s)[0]).collect();
    const CELL: f32 = 0.004;
    let key = |p: Vec3| (p / CELL).floor().as_ivec3();
    let mut cells: HashMap<IVec3, Vec<Vec3>> = HashMap::new();
    roots.iter().for_each(|p| cells.entry(key(*p)).or_default().push(*p));
    let nearest = |p: Vec3| -> f32 {
        (0..27)
            .flat_map(|i| {
                cells.get(&(key(p) + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1))).into_iter().flatten()
            })
            .map(|q| p.distance(*q))
            .filter(|d| *d > 0.0)
            .fold(CELL, f32::min)
    };
    let distances: Vec<f32> = roots.iter().map(|p| nearest(*p)).collect();
    let mean = distances.iter().sum::<f32>() / distances.len() as f32;
    let variance = distances.iter().map(|d| (d - mean).powi(2)).sum::<f32>() / distances.len() as f32;
    let variation = variance.sqrt() / mean;
    assert!(variation < 0.45, "distances to the nearest neighbor vary by {variation}");
    // Root counts in patches of 2 cm on the crown, where a patch is nearly flat, vary by less than 15 %.
    let mut patches: HashMap<(i32, i32), u32> = HashMap::new();
    for p in roots.iter().filter(|p| p.x.abs() < 0.04 && p.y > 0.0 && (-0.06..0.02).contains(&p.z)) {
        *patches.entry(((p.x / 0.02).floor() as i32, (p.z / 0.02).floor() as i32)).or_default() += 1;
    }
    let counts: Vec<f32> = patches.values().map(|c| *c as f32).collect();
    let mean = counts.iter().sum::<f32>() / counts.len() as f32;
    let deviation = (counts.iter().map(|c| (c - mean).powi(2)).sum::<f32>() / counts.len() as f32).sqrt();
    assert_eq!(counts.len(), 16);
    assert!(deviation / mean < 0.15, "patches vary by {} about {mean}", deviation / mean);
}

#[test]
fn the_same_options_give_the_same_bits_on_any_number_of_threads() {
    let options = BuiltinOptions { strands: 3_000, ..BuiltinOptions::default() };
    let made = |threads| on_threads(threads, || scene(&options));
    let one = made(1);
    assert!(one == made(3), "one and three threads differ");
    let other = scene(&BuiltinOptions { seed: 2, ..options });
    assert!(one.grooms[0].groom != other.grooms[0].groom, "the seed has no effect");
}

#[test]
fn the_motion_starts_and_ends_at_rest_within_human_range() {
    let scene = small(Style::ShortFur);
    let (body, clip) = (scene.body.unwrap(), scene.clip.unwrap());
    let rest = body.rest_pose();
    let frames: Vec<_> = clip.samples.chunks(clip.joint_count).collect();
    assert_eq!(clip.joint_count, body.joints.len());
    assert!((clip.duration() - 5.0).abs() < 1e-4);
    for still in [0, 1, 2, frames.len() - 2, frames.len() - 1] {
        assert_eq!(frames[still], rest, "frame {still} is not at rest");
    }
    let head = body.joint("head").unwrap();
    let facing: Vec<Vec3> =
        frames.iter().map(|pose| body.world(pose)[head].transform_vector3(Vec3::Z)).collect();
    let turn = |f: &Vec3| f.x.atan2(f.z).to_degrees();
    let (left, right) =
        (facing.iter().map(turn).fold(0.0, f32::max), facing.iter().map(turn).fold(0.0, f32::min));
    assert!((40.0..60.0).contains(&left) && (-60.0..-40.0).contains(&right), "turns {left} and {right}");
    let fastest = facing
        .windows(2)
        .map(|w| w[0].angle_between(w[1]).to_degrees() * clip.rate as f32)
        .fold(0.0, f32::max);
    assert!((200.0..500.0).contains(&fastest), "turns at {fastest} degrees a second");
}

#[test]
fn any_strand_and_point_count_is_built() {
    for (strands, points) in [(0, 32), (1, 3), (7, 0), (50, 200)] {
        let groom: Groom =
            scene(&BuiltinOptions { strands, points, ..BuiltinOptions::default() }).grooms.remove(0).groom;
        assert_eq!(groom.strand_count(), strands as usize);
        assert!(groom.points.iter().all(|p| p.is_finite()));
        assert_eq!(groom.radii.len(), groom.point_count());
        assert_eq!(groom.groups.len(), strands as usize);
    }
}

/// The volume inside a closed mesh [m³] (divergence theorem).
fn volume(mesh: &Mesh) -> f32 {
    (0..mesh.triangles.len()).map(|t| mesh.corners(t)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// The signed distance to a closed mesh near its surface, by a search over the triangles in nearby cells.
struct Surface<'a> {
    mesh: &'a Mesh,
    cells: HashMap<IVec3, Vec<u32>>,
}

impl<'a> Surface<'a> {
    /// Edge of a cell [m]. Points farther than this from every triangle count as this far outside.
    const CELL: f32 = 0.008;

    fn new(mesh: &'a Mesh) -> Self {
        let mut cells: HashMap<IVec3, Vec<u32>> = HashMap::new();
        for t in 0..mesh.triangles.len() {
            let c = mesh.corners(t);
            let lo = (c.into_iter().reduce(Vec3::min).unwrap() / Self::CELL).floor().as_ivec3();
            let hi = (c.into_iter().reduce(Vec3::max).unwrap() / Self::CELL).floor().as_ivec3();
            for z in lo.z..=hi.z {
                for y in lo.y..=hi.y {
                    for x in lo.x..=hi.x {
                        cells.entry(IVec3::new(x, y, z)).or_default().push(t as u32);
                    }
                }
            }
        }
        Self { mesh, cells }
    }

    fn signed_distance(&self, p: Vec3) -> f32 {
        let home = (p / Self::CELL).floor().as_ivec3();
        let mut best = (Self::CELL, 1.0);
        for i in 0..27 {
            let cell = home + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            for t in self.cells.get(&cell).into_iter().flatten() {
                let corners = self.mesh.corners(*t as usize);
                let (q, weights) = nearest(p, corners);
                let d = p.distance(q);
                if d < best.0 {
                    // The interpolated normal gives the correct side also where the nearest point is on an
                    // edge or a corner.
                    let n = self.mesh.triangles[*t as usize].map(|i| self.mesh.normals[i as usize]);
                    let normal = n[0] * weights.x + n[1] * weights.y + n[2] * weights.z;
                    best = (d, (p - q).dot(normal).signum());
                }
            }
        }
        best.0 * best.1
    }
}

/// The nearest point to `p` on a triangle, and its barycentric coordinates (Ericson 2005, §5.1.5).
fn nearest(p: Vec3, [a, b, c]: [Vec3; 3]) -> (Vec3, Vec3) {
    let (ab, ac) = (b - a, c - a);
    let at = |v: f32, w: f32| (a + ab * v + ac * w, Vec3::new(1.0 - v - w, v, w));
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return at(0.0, 0.0);
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return at(1.0, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return at(d1 / (d1 - d3), 0.0);
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return at(0.0, 1.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return at(0.0, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(1.0 - w, w);
    }
    let denominator = 1.0 / (va + vb + vc);
    at(vb * denominator, vc * denominator)
}

#[test]
fn no_hair_is_folded() {
    for style in Style::ALL {
        let groom = small(style).grooms.remove(0).groom;
        let turn = |w: &[Vec3]| (w[1] - w[0]).angle_between(w[2] - w[1]).to_degrees();
        let sharpest = (0..groom.strand_count())
            .flat_map(|s| groom.strand(s).windows(3).map(turn).collect::<Vec<_>>())
            .fold(0.0, f32::max);
        assert!(sharpest < 120.0, "{style:?}: a joint turns by {sharpest}°");
    }
}
