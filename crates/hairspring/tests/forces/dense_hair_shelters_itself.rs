//! Promise: dense hair shelters itself from the wind depending on its density. A single hair is not
//! sheltered. The inside of a bundle is sheltered more than its outside. Hairs that follow a guide shelter
//! like the same number of simulated hairs, within a factor of 2.

use glam::Vec3;
use hairspring::{
    air::Air,
    groom::Groom,
    settings::Wind,
    simulation::{Simulation, StepInput},
};
use hairspring_test::{FRAME, REST, points, roots};
use std::sync::Arc;

/// The mean motion of the strands' middles in a square bundle of `side`² strands in a second of wind from
/// the side [m]: of the outermost strands, and of those more than a centimeter inside. Each strand
/// represents `hairs` hairs.
fn blown(side: usize, spacing: f32, hairs: f32, sheltered: bool) -> [f32; 2] {
    let at = |k: usize| k as f32 * spacing;
    let strands = (0..side * side).map(|k| {
        let root = Vec3::new(at(k % side), 0.0, at(k / side));
        (0..17).map(|i| root - Vec3::Y * (0.01 * i as f32)).collect::<Vec<_>>()
    });
    let groom = Arc::new(Groom::from_strands(strands, 35e-6));
    let roots = roots(&groom, REST);
    let mut simulation = Simulation::builder(groom.clone()).build().unwrap();
    simulation.set_hair_multiplicity(vec![hairs; groom.strand_count()]);
    if sheltered {
        simulation.set_self_occlusion(&[]);
    }
    let wind = Wind { velocity: Vec3::X, ..Wind::default() };
    for _ in 0..60 {
        let air = Air { wind, ..Air::default() };
        simulation.step(&StepInput { dt: FRAME, anchor: REST, roots: &roots, colliders: &[], air });
    }
    let points = points(&simulation);
    let mut sums = [(0.0, 0.0f32); 2];
    for s in 0..groom.strand_count() {
        let root = groom.strand(s)[0];
        let edge =
            [root.x, root.z].map(|x| x.min(at(side - 1) - x)).into_iter().fold(f32::INFINITY, f32::min);
        let moved = points[groom.range(s).start + 8].distance(groom.strand(s)[8]);
        if edge == 0.0 || edge > 0.01 {
            let sum = &mut sums[usize::from(edge > 0.0)];
            *sum = (sum.0 + moved, sum.1 + 1.0);
        }
    }
    sums.map(|(sum, count)| sum / f32::max(count, 1.0))
}

#[test]
fn a_single_hair_is_not_sheltered() {
    let [sheltered, alone] = [true, false].map(|on| blown(1, 1.0, 1.0, on)[0]);
    assert!(alone > 0.05, "the wind moved the hair by only {alone} m");
    assert!((sheltered / alone - 1.0).abs() < 0.01, "{sheltered} m instead of {alone} m");
}

#[test]
fn the_inside_of_a_bundle_is_sheltered_more_than_its_outside() {
    // The strands represent 1,000 hairs per square centimeter; 25 of them are more than a centimeter
    // inside.
    let [outside, inside] = blown(11, 0.004, 160.0, true);
    let [_, open] = blown(11, 0.004, 160.0, false);
    println!("{outside} m outside, {inside} m inside, {open} m without shelter");
    assert!(outside > 1.5 * inside, "the outermost layer is not blown farther than the inside");
    assert!(inside < 0.3 * open, "the inside is not sheltered");
    // Sparse hair shelters little.
    let [_, sparse] = blown(11, 0.004, 0.1, true);
    assert!(sparse > 0.99 * open, "{sparse} m of {open} m");
}

#[test]
fn follow_hairs_shelter_like_simulated_hairs() {
    let [_, few] = blown(9, 0.0045, 25.0, true);
    let [_, many] = blown(41, 0.001, 1.0, true);
    println!("{few} m with guides, {many} m with all hairs");
    assert!((0.5..2.0).contains(&(few / many)), "{few} m with guides, {many} m with all hairs");
}
