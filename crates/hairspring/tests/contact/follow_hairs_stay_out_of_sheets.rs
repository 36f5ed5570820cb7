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
        .map(|(y, z)| pose.inverse_point(Vec3::new(x, y, z)));
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
