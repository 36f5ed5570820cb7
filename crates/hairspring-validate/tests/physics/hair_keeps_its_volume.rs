//! Promise: the volume methods do not disturb a start at rest. A squeezed bundle expands. A head of hair
//! that falls and is shaken keeps nine tenths of its rest volume, of which a quarter is left without a
//! volume method.
//!
//! Volume is the volume of the grid cells, weighted by how far hair fills each, up to 1
//! (`VolumeReport::share`). Where strands crowd into the same space, their own space is lost. A count of
//! occupied cells would treat frizz as volume, and in a convex hull one strand that stands off would count
//! for all. The case without a volume method is measured by a method with neither pressure nor friction.

use glam::Vec3;
use hairspring::{
    groom::Groom,
    math::RigidTransform,
    settings::{Solver, Volume, VolumeMethod},
    simulation::Simulation,
};
use hairspring_scene::{
    Guides, Scene,
    builtin::{BuiltinOptions, Style, scene},
    stage::Stage,
};
use hairspring_test::{REST, farthest, points, step, translation};
use hairspring_validate::bench::{self, Bench};

const METHODS: [VolumeMethod; 2] = [VolumeMethod::Density, VolumeMethod::Incompressible];

/// A grid that only measures.
fn only_measured() -> Volume {
    Volume { method: VolumeMethod::Density, friction: 0.0, pressure: 0.0, ..Volume::default() }
}

#[test]
fn a_start_at_rest_is_not_disturbed() {
    let options =
        BuiltinOptions { strands: 600, guides: Guides::Count(300), ..BuiltinOptions::new(Style::Wavy) };
    let rest = Scene { clip: None, ..scene(&options) };
    let points = |stage: &Stage| -> Vec<Vec3> { stage.strands().flat_map(|s| s.points.to_vec()).collect() };
    let mean_distance =
        |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f32>() / a.len() as f32;
    let played = |method: VolumeMethod| {
        let volume = Volume { method, ..Volume::default() };
        let mut stage = Stage::new(Scene { volume, ..rest.clone() }).unwrap();
        let start = points(&stage);
        stage.step(bench::FRAME);
        let first = points(&stage);
        (1..60).for_each(|_| _ = stage.step(bench::FRAME));
        (start, first, points(&stage))
    };
    let (start, first, last) = played(VolumeMethod::Off);
    println!("off: moved by {} m in the mean after a second", mean_distance(&last, &start));
    for method in METHODS {
        let (volume_start, volume_first, volume_last) = played(method);
        assert!(volume_start == start, "{method:?}: the start differs");
        // Within the frame, strands interact where residual rounding errors of their balance move them.
        let pushed = farthest(&volume_first, &first);
        println!("{method:?}: {pushed} m from the result without it after a frame");
        assert!(pushed < 1e-7, "{method:?}: hair at rest was pushed by {pushed} m");
        println!(
            "{method:?}: moved by {} m in the mean after a second, {} m from the result without it",
            mean_distance(&volume_last, &start),
            mean_distance(&volume_last, &last)
        );
        // Hair that creeps takes other hair along, and an incompressible volume makes way for it.
        let moved = mean_distance(&volume_last, &start);
        assert!(moved < 2e-3, "{method:?}: points moved by {moved} m in the mean in a second at rest");
    }
}

/// The mean distance of a bundle's tips from its axis one second after its roots were drawn together by
/// `pinch`, relative to that before.
fn opened(volume: Volume, pinch: f32) -> f32 {
    let (side, count) = (20, 16);
    let place = |k: usize| (k as f32 - 0.5 * (side - 1) as f32) * 0.003;
    let strand = |s: usize| {
        let root = Vec3::new(place(s % side), 0.0, place(s / side));
        (0..count).map(move |i| root + Vec3::NEG_Y * (0.01 * i as f32)).collect::<Vec<_>>()
    };
    let groom = Groom::from_strands((0..side * side).map(strand), 4e-5);
    let pinched = Vec3::new(pinch, 1.0, pinch);
    let roots: Vec<RigidTransform> =
        (0..side * side).map(|s| translation(groom.strand(s)[0] * pinched)).collect();
    let solver = Solver { collide_body: false, ..Solver::default() };
    let mut simulation = Simulation::builder(groom).solver(solver).build().unwrap();
    simulation.set_volume(&volume).unwrap();
    simulation.place(REST, &roots);
    let spread = |simulation: &Simulation| {
        let now = points(simulation);
        let tips = now.chunks(count).map(|strand| strand[count - 1].with_y(0.0).length());
        tips.sum::<f32>() / (side * side) as f32
    };
    let before = spread(&simulation);
    (0..60).for_each(|_| _ = step(&mut simulation, REST, &roots, &[]));
    spread(&simulation) / before
}

#[test]
fn a_squeezed_bundle_expands() {
    let without = opened(only_measured(), 0.5);
    assert!((without - 1.0).abs() < 1e-3, "without pressure the width changed by a factor of {without}");
    for (method, least) in [(VolumeMethod::Density, 1.2), (VolumeMethod::Incompressible, 1.5)] {
        let volume = Volume { method, ..Volume::default() };
        let at_rest = opened(volume, 1.0);
        let opened = opened(volume, 0.5);
        println!("{method:?}: {opened} times as wide, {at_rest} if not squeezed");
        assert!((at_rest - 1.0).abs() < 1e-3, "{method:?}: a bundle at rest is {at_rest} times as wide");
        assert!(
            (least..3.0).contains(&opened),
            "{method:?}: the tips are {opened} times as far from the axis"
        );
    }
}

/// The share of its rest volume that a head of hair occupies, as the mean over the last of three seconds.
/// The hair falls from standing out, and the head is shaken.
fn kept(volume: Volume) -> f64 {
    let mut bench = Bench::new(1_500, 24, Solver::default());
    bench.simulation.set_volume(&volume).unwrap();
    let mut sum = 0.0;
    for frame in 0..180 {
        assert_eq!(bench.step().reset_strands, 0);
        if frame >= 120 {
            sum += bench.simulation.volume().unwrap().volume_ratio / 60.0;
        }
    }
    let measure = bench.measure();
    assert!(
        measure.stretch_max < 0.011 && measure.max_depth < 1e-4 && measure.non_finite == 0,
        "{measure:?}"
    );
    sum
}

#[test]
fn a_shaken_head_keeps_its_volume() {
    let without = kept(only_measured());
    let density = kept(Volume { method: VolumeMethod::Density, ..Volume::default() });
    let firm = kept(Volume { method: VolumeMethod::Incompressible, ..Volume::default() });
    println!("without {without}, density {density}, incompressible {firm}");
    assert!(without < 0.4, "without a volume method {without} of the volume is left");
    assert!(density > without + 0.1, "density keeps {density}");
    assert!(firm >= 0.9, "incompressible keeps {firm}");
}
