//! Promise: a body that moves through hair by more than its thickness takes the hair along: a finger at 5
//! m/s, and a rod of 1 cm at 20 m/s.
//!
//! A curtain of strands hangs from a bar, and the body crosses it. As long as a strand is long enough to
//! reach around the body, it stays in front of it at the body's height. A collider that moves with the head
//! causes no additional substeps, and neither does one that is too far from the hair.

use glam::{Quat, Vec3};
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    simulation::Simulation,
};
use hairspring_test::{REST, points, roots, step, step_by, translation};

const STRANDS: u32 = 16;
const LENGTH: f32 = 0.3;

/// Strands that hang from y = 0 in the plane z = 0.
fn curtain(model: Model) -> (Simulation, Vec<RigidTransform>) {
    let strands = (0..STRANDS).map(|s| {
        let x = 0.005 * (s as f32 - 7.5);
        (0..31).map(move |i| Vec3::new(x, -LENGTH * i as f32 / 30.0, 0.0)).collect::<Vec<_>>()
    });
    let groom = Groom::from_strands(strands, 40e-6);
    let roots = roots(&groom, REST);
    let material = Material { model, ..Material::default() };
    (Simulation::builder(groom).materials(&[material]).build().unwrap(), roots)
}

/// A rod along X, at the origin.
fn rod(radius: f32) -> ColliderShape {
    ColliderShape::Capsule { a: Vec3::X * -0.2, b: Vec3::X * 0.2, radius }
}

/// Counts the strands that the rod, now at height `y` and position `z`, has passed through: at its height
/// they are behind it and nowhere in front. (A tail that is flung up behind the rod crosses its height
/// there too.)
fn passed(simulation: &Simulation, y: f32, z: f32) -> usize {
    let crossing = |pair: &[Vec3]| {
        let t = (y - pair[0].y) / (pair[1].y - pair[0].y);
        (0.0..1.0).contains(&t).then(|| pair[0].lerp(pair[1], t).z)
    };
    let behind = |strand: &&[Vec3]| {
        let mut places = strand.windows(2).filter_map(crossing).peekable();
        places.peek().is_some() && places.all(|place| place < z)
    };
    points(simulation).chunks(31).filter(behind).count()
}

#[test]
fn hair_stays_in_front_of_a_fast_collider() {
    for (what, radius, speed) in [("finger", 0.008, 5.0), ("rod", 0.005, 20.0)] {
        for model in Model::ALL {
            for dt in [1.0 / 60.0, 1.0 / 240.0] {
                let (mut simulation, roots) = curtain(model);
                let y = -0.1;
                let at = |z: f32| translation(Vec3::new(0.0, y, z));
                // From 6 cm behind to 14 cm in front: a strand of 30 cm reaches around that.
                let (mut z, end) = (-0.06f32, 0.14);
                while z < end {
                    let next = (z + speed * dt).min(end);
                    let colliders = [MovingCollider::new(rod(radius), at(z), at(next))];
                    step_by(&mut simulation, dt, REST, &roots, &colliders);
                    z = next;
                    let through = if z > radius { passed(&simulation, y, z) } else { 0 };
                    assert_eq!(through, 0, "{what}, {model:?}, {dt} s: strands are behind it at {z} m");
                }
                assert_eq!(simulation.measure(&[]).non_finite, 0);
            }
        }
    }
}

#[test]
fn only_fast_thin_colliders_near_hair_shorten_substeps() {
    let substeps = |anchor: RigidTransform, turned: Quat, shape: ColliderShape, start: Vec3, end: Vec3| {
        // Hair is at rest, because fast hair near a thin body also causes shorter substeps.
        let (mut simulation, mut roots) = curtain(Model::Auto);
        let place = |translation| RigidTransform { translation, rotation: turned };
        let colliders = [MovingCollider::new(shape, place(start), place(end))];
        for root in &mut roots {
            root.translation = anchor.transform_point(Vec3::new(root.translation.x, 0.0, 0.0));
        }
        step(&mut simulation, anchor, &roots, &colliders).substeps
    };
    let still = Quat::IDENTITY;
    let below = Vec3::NEG_Y * 0.1;
    // 333 mm in substeps of 2.5 mm.
    assert_eq!(substeps(REST, still, rod(0.005), below - Vec3::Z * 0.1, below + Vec3::Z * 0.2333), 134);
    assert_eq!(substeps(REST, still, rod(0.005), below + Vec3::Y * 2.0, below + Vec3::new(0.0, 2.0, 0.3)), 4);
    let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: 0.1 };
    assert_eq!(substeps(REST, still, ball, below - Vec3::Z * 0.2, below - Vec3::Z * 0.15), 4);
    let moved = translation(Vec3::Z * 0.2);
    assert_eq!(substeps(moved, still, rod(0.005), below, below + Vec3::Z * 0.2), 4);
}
