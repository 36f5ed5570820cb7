//! Promise: the air inside dense hair moves with the hair. A hair that swings by itself through its neighbors loses its motion
//! as a lone hair does; a bundle that swings as one is hardly braked, at any frame rate; and hair that turns with its
//! roots is not blown about by its own air.

use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    groom::Groom,
    material::Material,
    math::RigidTransform,
    simulation::{Simulation, StepInput},
};
use hairspring_test::{REST, points, roots};
use std::sync::Arc;

/// Strands on a side of a bundle, and their distance [m].
const SIDE: usize = 11;
const SPACING: f32 = 0.003;

/// Hanging strands of 16 cm without damping, and whether each is more than a centimeter inside.
fn bundle(hairs: f32) -> (Arc<Groom>, Vec<bool>, Simulation) {
    let at = |k: usize| (k as f32 - 5.0) * SPACING;
    let root = |k: usize| Vec3::new(at(k % SIDE), 0.0, at(k / SIDE));
    let strands =
        (0..SIDE * SIDE).map(|k| (0..17).map(|i| root(k) - Vec3::Y * (0.01 * i as f32)).collect::<Vec<_>>());
    let groom = Arc::new(Groom::from_strands(strands, 35e-6));
    let material = Material { damping: 0.0, ..Material::default() };
    let mut simulation = Simulation::builder(groom.clone()).materials(&[material]).build().unwrap();
    simulation.set_hair_multiplicity(vec![hairs; groom.strand_count()]);
    simulation.set_self_occlusion(&[]);
    let inside =
        (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE].iter().all(|k| at(*k).abs() < 0.006)).collect();
    (groom, inside, simulation)
}

/// Hairs that each strand represents: in a dense bundle, and where hair carries no air.
const DENSE: f32 = 150.0;
const SPARSE: f32 = 0.01;

/// Gives every point a velocity in the direction x in proportion to its depth below the root, `speed` of its strand at the tip,
/// and steps for `seconds`. Returns the mean of |v|² at the tips of the inner strands over the last second [m²/s²].
fn swing(hairs: f32, rate: usize, seconds: usize, speed: impl Fn(usize) -> f32) -> f64 {
    let (groom, inside, mut simulation) = bundle(hairs);
    let at = points(&simulation);
    let velocities: Vec<Vec3> = (0..groom.strand_count())
        .flat_map(|s| groom.strand(s).iter().map(move |p| (s, -p.y / 0.16)))
        .map(|(s, depth)| Vec3::X * speed(s) * depth)
        .collect();
    simulation.set_points(&at, &velocities).unwrap();
    let roots = roots(&groom, REST);
    let mut now = vec![Vec3::ZERO; simulation.point_count()];
    let (mut sum, mut count) = (0.0, 0.0);
    for frame in 0..rate * seconds {
        let dt = 1.0 / rate as f32;
        simulation.step(&StepInput { dt, anchor: REST, roots: &roots, colliders: &[], air: Air::default() });
        if frame >= rate * (seconds - 1) {
            simulation.write_velocities(&mut now);
            for s in (0..groom.strand_count()).filter(|s| inside[*s]) {
                sum += f64::from(now[groom.range(s).end - 1].length_squared());
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn a_hair_that_swings_by_itself_is_braked_as_a_lone_hair() {
    // Neighbors swing against each other.
    let speed = |s: usize| if s.is_multiple_of(2) { 0.2 } else { -0.2 };
    let [dense, lone] = [DENSE, SPARSE].map(|hairs| swing(hairs, 60, 2, speed));
    println!("{dense} m²/s² in dense hair, {lone} m²/s² of lone hairs, in the second second");
    assert!(dense < 2.0 * lone, "{dense} m²/s² instead of {lone} m²/s²");
}

#[test]
fn a_bundle_that_swings_as_one_is_hardly_braked() {
    let [dense, lone] = [DENSE, SPARSE].map(|hairs| swing(hairs, 60, 2, |_| 0.2));
    println!("{dense} m²/s² in dense hair, {lone} m²/s² of lone hairs, in the second second");
    assert!(dense > 20.0 * lone, "{dense} m²/s² with {lone} m²/s² of lone hairs");
    for rate in [30, 240] {
        let other = swing(DENSE, rate, 2, |_| 0.2);
        println!("{other} m²/s² at {rate} frames a second");
    }
}

#[test]
fn hair_that_turns_with_its_roots_keeps_its_shape() {
    let off = |hairs: f32| {
        let (groom, inside, mut simulation) = bundle(hairs);
        // About the vertical axis, at 8 rad/s after a second.
        let mut farthest = 0.0f32;
        for frame in 1..=90 {
            let time = frame as f32 / 60.0;
            let angle = if time < 1.0 { 4.0 * time * time } else { 4.0 + 8.0 * (time - 1.0) };
            let head = RigidTransform::from_rotation(Quat::from_rotation_y(angle));
            let roots = roots(&groom, head);
            simulation.step(&StepInput {
                dt: 1.0 / 60.0,
                anchor: head,
                roots: &roots,
                colliders: &[],
                air: Air::default(),
            });
            let now = points(&simulation);
            for s in (0..groom.strand_count()).filter(|s| inside[*s]) {
                for i in groom.range(s) {
                    farthest = farthest.max(now[i].distance(head.transform_point(groom.points[i])));
                }
            }
        }
        farthest
    };
    let [dense, lone] = [DENSE, SPARSE].map(off);
    println!("{dense} m in dense hair, {lone} m of lone hairs");
    assert!(dense < 1.2 * lone + 1e-4, "{dense} m instead of {lone} m");
}
