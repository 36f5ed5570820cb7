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

/// Hanging strands of 16 cm without damping, and whether each is in the middle. Each strand represents `hairs` hairs.
fn bundle(hairs: f32, drag: f32) -> (Arc<Groom>, Vec<bool>, Simulation) {
    let at = |k: usize| (k as f32 - 5.0) * SPACING;
    let root = |k: usize| Vec3::new(at(k % SIDE), 0.0, at(k / SIDE));
    let strands =
        (0..SIDE * SIDE).map(|k| (0..17).map(|i| root(k) - Vec3::Y * (0.01 * i as f32)).collect::<Vec<_>>());
    let groom = Arc::new(Groom::from_strands(strands, 35e-6));
    let material = Material { damping: 0.0, drag, ..Material::default() };
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

/// A material with the drag of hair, and one without drag.
const AIR: f32 = 1.0;
const NO_AIR: f32 = 0.0;

/// Gives every point a velocity in the direction x in proportion to its depth below the root, `speed` of its strand at the tip,
/// and steps for two seconds. Returns the mean of |v|² at the tips of the inner strands over the second one [m²/s²].
fn swing((hairs, drag): (f32, f32), rate: usize, speed: impl Fn(usize) -> f32) -> f64 {
    let seconds = 2;
    let (groom, inside, mut simulation) = bundle(hairs, drag);
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
fn a_hair_that_swings_by_itself_is_braked() {
    // Neighbors swing against each other, and the bundle as a whole hardly moves.
    let against = |s: usize| if s.is_multiple_of(2) { 0.2 } else { -0.2 };
    let alone = swing((DENSE, AIR), 60, against);
    let as_one = swing((DENSE, AIR), 60, |_| 0.2);
    println!(
        "{alone} m²/s² of strands that swing by themselves, {as_one} m²/s² of a bundle that swings as one"
    );
    assert!(alone < 1e-3 * as_one, "{alone} m²/s² and {as_one} m²/s²");
}

#[test]
fn a_bundle_that_swings_as_one_is_hardly_braked_at_any_frame_rate() {
    let free = swing((DENSE, NO_AIR), 60, |_| 0.2);
    let lone = swing((SPARSE, AIR), 60, |_| 0.2);
    assert!(lone < 1e-3 * free, "{lone} m²/s² of lone hairs, {free} m²/s² without air");
    let dense = [240, 60, 30, 24].map(|rate| swing((DENSE, AIR), rate, |_| 0.2));
    println!("{:?} of the energy without air", dense.map(|energy| energy / free));
    for (energy, rate) in dense.into_iter().zip([240, 60, 30, 24]) {
        assert!(energy > 0.3 * free, "{energy} m²/s² of {free} m²/s² at {rate} frames a second");
        assert!(
            (energy / dense[0] - 1.0).abs() < 0.25,
            "{energy} m²/s² instead of {} m²/s² at {rate}",
            dense[0]
        );
    }
}

#[test]
fn hair_that_turns_with_its_roots_keeps_its_shape() {
    let off = |hairs: f32, drag: f32| {
        let (groom, inside, mut simulation) = bundle(hairs, drag);
        // About the vertical axis, at 4 rad/s after a second.
        let mut farthest = 0.0f32;
        for frame in 1..=90 {
            let time = frame as f32 / 60.0;
            let angle = if time < 1.0 { 2.0 * time * time } else { 2.0 + 4.0 * (time - 1.0) };
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
    let [dense, free] = [AIR, NO_AIR].map(|drag| off(DENSE, drag));
    println!("{dense} m in dense hair, {free} m without air");
    assert!(dense < free + 0.002, "{dense} m instead of {free} m");
}
