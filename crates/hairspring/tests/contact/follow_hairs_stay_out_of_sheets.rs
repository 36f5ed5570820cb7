//! Promise: a follow hair stays on the side of a thin shell that its guide is on, as far from it as its guide must be.
//!
//! A shell pushes out only what is within its thickness. A follow hair keeps its distance from its guide, so beside a
//! shell it could be behind it. It is then laid against the shell on the guide's side. Hair that is on the other side
//! at rest stays there.

use glam::{Quat, Vec3};
use hairspring::{
    collide::{ColliderPose, ColliderShape, MovingCollider, ThinShell},
    follow::{Follow, assign_guides},
    groom::Groom,
    math::RigidTransform,
    settings::Effects,
};
use hairspring_test::line;
use proptest::prelude::*;
use std::sync::Arc;

const STRANDS: usize = 12;
const POINTS: usize = 10;
const SPACING: f32 = 0.004;
const THICKNESS: f32 = 0.001;

/// Strands that hang in a row along x, and the shell of a square at `x` that faces along x, at rest in the world.
fn scene(x: f32) -> (Arc<Groom>, MovingCollider) {
    let strand = |s: usize| {
        let root = Vec3::X * (SPACING * s as f32);
        line(root, root - Vec3::Y * 0.1, POINTS)
    };
    // In its own space, the square is turned and moved.
    let pose =
        RigidTransform { rotation: Quat::from_rotation_z(0.7), translation: Vec3::new(0.2, -0.3, 0.1) };
    let corners = [(0.02, -0.1), (-0.2, -0.1), (-0.2, 0.1), (0.02, 0.1)]
        .map(|(y, z)| pose.inverse_transform_point(Vec3::new(x, y, z)));
    let shell = ThinShell::new(&corners, &[[0, 1, 2], [0, 2, 3]], THICKNESS);
    (
        Arc::new(Groom::from_strands((0..STRANDS).map(strand), 35e-6)),
        MovingCollider::at_rest(ColliderShape::Sheet(Arc::new(shell)), pose),
    )
}

/// Places the hairs that follow strand `guide`, with a shell at `x`. `at_rest` are the colliders of the rest pose.
fn placed(guide: u32, x: f32, effects: Effects, at_rest: &[ColliderPose]) -> Vec<Vec3> {
    let (groom, shell) = scene(x);
    let weights = assign_guides(&groom, &[guide]);
    let mut follow = Follow::new(groom.clone(), &[guide], &weights, effects, at_rest);
    let points = groom.strand(guide as usize).to_vec();
    follow.update_guide_transforms(&points, &[Quat::IDENTITY]);
    let mut all = vec![Vec3::ZERO; groom.point_count()];
    follow.interpolation(&points, &[shell]).place(&mut all);
    all
}

#[test]
fn follow_hairs_are_on_the_side_of_their_guide() {
    let x = 0.018;
    let noise = Effects { noise: 0.004, ..Effects::default() };
    for (effects, wander) in [(Effects::default(), 0.0), (noise, 0.02)] {
        for guide in [0, 11] {
            let side = if guide == 0 { -1.0 } else { 1.0 };
            let all = placed(guide, x, effects, &[]);
            for (s, strand) in all.chunks(POINTS).enumerate() {
                // The root is fixed.
                for p in &strand[1..] {
                    let distance = side * (p.x - x);
                    assert!(
                        distance > THICKNESS - 1e-5,
                        "guide {guide}, strand {s}: {distance} m from the sheet"
                    );
                    let own = SPACING * s as f32;
                    let crosses = side * (own - x) < 0.0;
                    let moved = if crosses { (distance - THICKNESS).abs() } else { (p.x - own).abs() };
                    assert!(moved < 1e-5 + wander, "guide {guide}, strand {s}: {p}");
                }
            }
        }
    }
}

#[test]
fn hair_that_is_apart_from_its_guide_at_rest_stays_there() {
    let (groom, shell) = scene(0.018);
    let all = placed(0, 0.018, Effects::default(), &[shell.end_pose()]);
    for (p, rest) in all.iter().zip(&groom.points) {
        assert!(p.distance(*rest) < 1e-5, "{rest} moves to {p}");
    }
}

fn vector(size: f32) -> impl Strategy<Value = Vec3> {
    (-size..size, -size..size, -size..size).prop_map(Vec3::from)
}

/// Fraction of the line before it crosses a triangle, in double precision; `None` if it passes the triangle by. `rim` is
/// how far within the triangle and the line the crossing must be, as a fraction of them.
fn cross(from: Vec3, to: Vec3, corners: [Vec3; 3], rim: f64) -> Option<f64> {
    let [from, to, a, b, c] = [from, to, corners[0], corners[1], corners[2]].map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    let fraction = (a - from).dot(normal) / (to - from).dot(normal);
    let at = from + (to - from) * fraction;
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(p, q)| (*q - *p).cross(at - *p).dot(normal) >= rim * normal.length_squared());
    ((rim..1.0 - rim).contains(&fraction) && inside).then_some(fraction)
}

proptest! {
    /// The cells of a shell lose no crossing: the first is that of all triangles.
    #[test]
    fn a_line_crosses_the_first_of_all_triangles(
        points in prop::collection::vec(vector(0.2), 30), from in vector(0.3), to in vector(0.3),
        thickness in 0.001f32..0.02,
    ) {
        let corners = |t: usize| [points[3 * t], points[3 * t + 1], points[3 * t + 2]];
        let triangles: Vec<[u32; 3]> = (0..10).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let shell = ThinShell::new(&points, &triangles, thickness);
        // Rounding may decide about a line along the rim of a triangle.
        let rims = |rim: f64| (0..10).map(|t| cross(from, to, corners(t), rim).is_some()).collect::<Vec<_>>();
        prop_assume!(rims(1e-3) == rims(-1e-3));
        let all: Vec<(f64, Vec3)> = (0..10)
            .filter_map(|t| {
                let [a, b, c] = corners(t);
                Some((cross(from, to, corners(t), 0.0)?, (b - a).cross(c - a).normalize()))
            })
            .collect();
        let first = all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let found = shell.crossing(from, to);
        prop_assert_eq!(found.is_some(), first.is_some(), "{:?}, not {:?}", found, first);
        if let (Some(found), Some((fraction, normal))) = (found, first) {
            prop_assert!((f64::from(found.fraction) - fraction).abs() < 1e-4, "{:?}, not {}", found, fraction);
            prop_assert!(found.normal.dot(normal).abs() > 0.999, "{:?}, not {}", found, normal);
            prop_assert!(found.normal.dot(from - to) >= 0.0, "the normal is on the other side: {:?}", found);
        }
    }
}
