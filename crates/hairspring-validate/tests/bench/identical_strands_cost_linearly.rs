//! Promise: coincident strands do not make the cost of strand contact quadratic in their number, and
//! omitted contacts are reported.
//!
//! Files may hold the same strand many times, by mistake or to represent a number of hairs. Coincident
//! strands cannot be separated, so they touch other strands as one strand with the mass of all. Of nearly
//! coincident strands, each touches a limited number of others. The test counts work, as the number of
//! tested segment pairs, and not time.

use glam::Vec3;
use hairspring::{
    groom::Groom,
    material::{Material, Model},
    settings::{Neighbours, Solver},
    simulation::{Hold, NeighboursReport, Simulation},
};
use hairspring_test::{REST, line, points, roots, step};
use std::sync::Arc;

/// Simulates falling strands and held bars for `frames` frames; returns the report and the positions of the
/// tips.
fn fallen(bars: usize, strands: &[Vec<Vec3>], frames: usize) -> (NeighboursReport, Vec<Vec3>) {
    let groom = Arc::new(Groom::from_strands(strands, 4e-5));
    let solver = Solver { sag_free: false, ..Solver::default() };
    let material = Material { bend: 0.01, drag: 1.0, model: Model::Curvature, ..Material::default() };
    let mut simulation =
        Simulation::builder(groom.clone()).materials(&[material]).solver(solver).build().unwrap();
    let radius = Some(0.001);
    simulation
        .set_neighbours(&Neighbours { on: true, radius, friction: 0.0, ..Neighbours::default() })
        .unwrap();
    let hold = |strand: usize, point: usize| Hold {
        strand: strand as u32,
        point: point as u32,
        target: Some(strands[strand][point]),
        ..Hold::default()
    };
    let holds: Vec<Hold> =
        (0..bars).flat_map(|bar| (2..strands[bar].len()).map(move |i| hold(bar, i))).collect();
    simulation.set_holds(&holds);
    let roots = roots(&groom, REST);
    (0..frames).for_each(|_| _ = step(&mut simulation, REST, &roots, &[]));
    let now = points(&simulation);
    let tips = (0..strands.len()).map(|s| now[groom.range(s).end - 1]).collect();
    (simulation.neighbours().unwrap(), tips)
}

#[test]
fn coincident_strands_touch_others_as_one() {
    let bar = line(Vec3::new(0.0, 0.0, -0.035), Vec3::new(0.0, 0.0, 0.035), 8);
    let rope = line(Vec3::new(-0.05, 0.01, 0.0), Vec3::new(0.20, 0.01, 0.0), 26);
    let over_bar = |count: usize| {
        let strands: Vec<_> = std::iter::once(bar.clone()).chain(vec![rope.clone(); count]).collect();
        fallen(1, &strands, 90)
    };
    let (one, lone) = over_bar(1);
    let (many, tips) = over_bar(1000);
    println!("one: {one:?}\n1000: {many:?}");
    assert!(lone[1].y > -0.3 && one.touching_pairs > 0, "the strand does not lie over the bar: {}", lone[1]);
    assert_eq!((one.merged_strands, many.merged_strands), (0, 999));
    assert_eq!(one.tested_pairs, many.tested_pairs, "the numbers of tested pairs differ");
    let difference = tips[1..].iter().map(|tip| tip.distance(lone[1])).fold(0.0, f32::max);
    assert!(difference < 1e-3, "the tips of a thousand strands are {difference} m from the tip of one");
}

#[test]
fn a_crowd_costs_linearly_and_is_reported() {
    // All strands are within less than a hair's width of each other.
    let crowd = |count: usize| -> Vec<Vec<Vec3>> {
        let at = |k: usize| Vec3::new((k as f32 * 0.618).fract(), 0.0, (k as f32 * 0.755).fract()) * 1e-5;
        (0..count).map(|k| line(at(k), at(k) + Vec3::new(0.1, 0.0, 0.0), 12)).collect()
    };
    let [half, all] = [600, 1200].map(|count| fallen(0, &crowd(count), 2).0);
    println!("600: {half:?}\n1200: {all:?}");
    assert!(
        all.tested_pairs < 3 * half.tested_pairs,
        "{} pairs, {} for half of the strands",
        all.tested_pairs,
        half.tested_pairs
    );
    // Two frames have eight substeps, and in each a segment is tested against at most 256 others.
    assert!(all.tested_pairs < 1200 * 11 * 256 * 8, "{} pairs", all.tested_pairs);
    assert!(all.crowded_segments > 0, "the crowd is not reported");
    let (few, _) = fallen(0, &crowd(10), 3);
    assert_eq!(few.crowded_segments, 0);
}
