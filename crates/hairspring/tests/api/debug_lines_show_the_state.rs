//! Promise: debug lines have the counts that follow from the scene, are finite, and lie on what they show.

use crate::support::{groom, simulation};
use glam::{Mat3, Quat, Vec3};
use hairspring::{
    air::Air,
    collide::{ColliderShape, Hull, MovingCollider, ThinShell, voxelize},
    material::Material,
    math::RigidTransform,
    settings::{Solver, Volume, VolumeMethod, Wind},
    simulation::{DebugLine, DebugLineKind, DebugRenderMode, Simulation, StepInput},
};
use hairspring_test::{FRAME, points};
use std::sync::Arc;

/// A tetrahedron.
const CORNERS: [Vec3; 4] =
    [Vec3::ZERO, Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.0, 0.1, 0.0), Vec3::new(0.0, 0.0, 0.1)];
const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// Hair of four strands, and its roots.
fn hair(solver: Solver) -> (Simulation, Vec<RigidTransform>) {
    let groom = groom(4);
    let root = |s| RigidTransform { translation: groom.strand(s)[0], rotation: Quat::IDENTITY };
    (simulation(4, Material::default(), solver), (0..4).map(root).collect())
}

fn count(lines: &[DebugLine], kind: DebugLineKind) -> usize {
    lines.iter().filter(|line| line.kind == kind).count()
}

/// The outline of one shape, turned and moved.
fn outline(shape: ColliderShape, pose: RigidTransform) -> Vec<DebugLine> {
    let (simulation, roots) = hair(Solver::default());
    let colliders = [MovingCollider::new(shape, RigidTransform::default(), pose)];
    let (anchor, air) = (RigidTransform::default(), Air::default());
    let input = StepInput { dt: FRAME, anchor, roots: &roots, colliders: &colliders, air };
    simulation.debug_lines(&input, DebugRenderMode::COLLIDERS)
}

#[test]
fn outlines_lie_on_their_shapes() {
    let pose = RigidTransform {
        translation: Vec3::new(0.3, -0.2, 0.1),
        rotation: Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.7),
    };
    let (center, radius) = (Vec3::new(0.02, 0.05, -0.01), 0.07);
    let half = Vec3::new(0.1, 0.05, 0.02);
    let axes = Mat3::from_quat(Quat::from_rotation_x(0.4));
    let (a, b) = (center, center + Vec3::new(0.1, 0.03, 0.0));
    for (shape, lines) in [
        (ColliderShape::Sphere { center, radius }, 72),
        (ColliderShape::Capsule { a, b, radius }, 100),
        (ColliderShape::Cuboid { center, half, axes }, 12),
        (ColliderShape::Plane { point: center, normal: Vec3::Y }, 22),
        (ColliderShape::Hull(Arc::new(Hull::new(&CORNERS).unwrap())), 12),
    ] {
        let found = outline(shape.clone(), pose);
        assert_eq!(found.len(), lines, "{shape:?}");
        for end in found.iter().flat_map(|line| [line.a, line.b]) {
            let off = shape.distance(pose.inverse_transform_point(end)).abs();
            assert!(off < 1e-6, "{shape:?}: {end} is {off} m from the surface");
        }
    }
    let field = Arc::new(voxelize(&CORNERS, &TRIANGLES, 0.01));
    assert_eq!(outline(ColliderShape::Field(field), pose).len(), 12);
    let sheet = Arc::new(ThinShell::new(&CORNERS, &TRIANGLES, 0.002));
    assert_eq!(outline(ColliderShape::Sheet(sheet), pose).len(), 12);
}

#[test]
fn lines_follow_from_the_state() {
    let (mut simulation, roots) = hair(Solver { sag_free: false, ..Solver::default() });
    simulation.set_volume(&Volume { method: VolumeMethod::Density, ..Volume::default() }).unwrap();
    let ball = ColliderShape::Sphere { center: Vec3::new(0.0, -0.1, 0.0), radius: 0.05 };
    let colliders = [MovingCollider::at_rest(ball, RigidTransform::default()).with_user_data(9)];
    let wind = Wind { velocity: Vec3::NEG_Z, ..Wind::default() };
    let air = Air { wind, ..Air::default() };
    let input =
        StepInput { dt: FRAME, anchor: RigidTransform::default(), roots: &roots, colliders: &colliders, air };
    for _ in 0..60 {
        simulation.step(&input);
    }
    let lines = simulation.debug_lines(&input, DebugRenderMode::ALL);
    assert!(lines.iter().all(|line| line.a.is_finite() && line.b.is_finite()));

    let contacts = simulation.contact_points(&colliders);
    let counts = simulation.contacts(&colliders);
    assert_eq!(contacts.len(), counts.points + counts.segments);
    assert!(!contacts.is_empty());
    for contact in &contacts {
        assert_eq!((contact.collider, contact.user_data), (0, 9));
        assert!(contact.distance.abs() < 1e-3 && contact.force > 0.0, "{contact:?}");
    }
    let force: f64 = contacts.iter().map(|contact| f64::from(contact.force)).sum();
    assert!((force - counts.force).abs() < 1e-6 * counts.force);

    for (kind, expected) in [
        (DebugLineKind::Segment, 4 * 15),
        (DebugLineKind::ContactPoint, 3 * contacts.len()),
        (DebugLineKind::ContactNormal, contacts.len()),
        (DebugLineKind::RootX, 4),
        (DebugLineKind::RootY, 4),
        (DebugLineKind::RootZ, 4),
        (DebugLineKind::Collider, 72),
        (DebugLineKind::Wind, 4 * 4),
        (DebugLineKind::Volume, 12),
    ] {
        assert_eq!(count(&lines, kind), expected, "{kind:?}");
    }
    // Segments join the points, and all points are in the bounds of the grid.
    let all = points(&simulation);
    for (line, s) in lines[..60].iter().zip((0..60).map(|k| k / 15 * 16 + k % 15)) {
        assert_eq!((line.a, line.b), (all[s], all[s + 1]));
    }
    let corners: Vec<_> = lines.iter().filter(|l| l.kind == DebugLineKind::Volume).map(|l| l.a).collect();
    let low = corners.iter().fold(Vec3::INFINITY, |low, p| low.min(*p));
    assert!(all.iter().all(|p| p.cmpgt(low).all()));
    let blown = lines.iter().filter(|l| l.kind == DebugLineKind::Wind);
    assert!(blown.clone().all(|l| (l.b - l.a).distance(Vec3::NEG_Z * 0.01) < 1e-6));
}

#[test]
fn each_mode_gives_its_own_lines() {
    let (mut simulation, roots) = hair(Solver::default());
    let anchor = RigidTransform::default();
    let input = StepInput { dt: FRAME, anchor, roots: &roots, colliders: &[], air: Air::default() };
    simulation.step(&input);
    assert!(simulation.debug_lines(&input, DebugRenderMode::default()).is_empty());
    let segments = simulation.debug_lines(&input, DebugRenderMode::SEGMENTS);
    let both = simulation.debug_lines(&input, DebugRenderMode::SEGMENTS | DebugRenderMode::ROOTS);
    assert_eq!((segments.len(), both.len()), (60, 72));
    let all = simulation.debug_lines(&input, DebugRenderMode::ALL);
    assert_eq!(all.len(), 72, "no colliders, wind or volume");
}
