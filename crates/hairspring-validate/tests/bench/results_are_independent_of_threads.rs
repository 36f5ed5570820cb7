//! Promise: results have the same bits for any number of threads and for any other strands in a tile, and
//! agree on all instruction sets.
//!
//! Strands are independent within a step, and every sum has a fixed order. So neither threads nor the
//! strands that share a tile affect the result. Instruction sets differ only in fused multiplication. They
//! are compared after a tenth of a second, while hair falls from standing on end; later, rounding decides
//! which way each strand buckles. The median distance is a fraction of a hair's width.

use glam::Vec3;
use hairspring::{
    collide::{ColliderShape, MovingCollider},
    groom::Groom,
    material::{Material, Model},
    math::RigidTransform,
    settings::{Solver, Volume, VolumeMethod},
    simulation::Simulation,
};
use hairspring_scene::{
    Guides,
    builtin::{BuiltinOptions, Style, scene},
    stage::Stage,
};
use hairspring_test::{REST, on_threads, points, step, translation};
use hairspring_validate::bench::{self, Bench};
use std::sync::Arc;

fn shaken(threads: usize, method: VolumeMethod) -> Vec<Vec3> {
    on_threads(threads, || {
        let mut bench = Bench::new(333, 20, Solver::default());
        bench.simulation.set_volume(&Volume { method, ..Volume::default() }).unwrap();
        (0..60).for_each(|_| _ = bench.step());
        points(&bench.simulation)
    })
}

#[test]
fn the_simulation_is_independent_of_threads() {
    for method in VolumeMethod::ALL {
        let one = shaken(1, method);
        assert!(one == shaken(2, method), "{method:?}: two threads give other bits than one");
        assert!(one == shaken(7, method), "{method:?}: seven threads give other bits than one");
    }
}

#[test]
fn a_whole_scene_is_independent_of_threads() {
    let play = |threads| {
        on_threads(threads, || {
            let options = BuiltinOptions {
                strands: 600,
                guides: Guides::Count(60),
                ..BuiltinOptions::new(Style::Wavy)
            };
            let mut stage = Stage::new(scene(&options)).unwrap();
            (0..30).for_each(|_| _ = stage.step(1.0 / 30.0));
            stage.strands().next().unwrap().points.to_vec()
        })
    };
    let one = play(1);
    assert!(one == play(2), "two threads give other bits than one");
    assert!(one == play(7), "seven threads give other bits than one");
}

/// A limp strand falls onto a ball, alone and with seven strands that touch the ball elsewhere and at other
/// times.
#[test]
fn strands_in_contact_are_independent_of_their_tile() {
    let groom = Arc::new(bench::groom(8, 24));
    let ball = ColliderShape::Sphere { center: Vec3::ZERO, radius: bench::RADIUS };
    let collider = MovingCollider::at_rest(ball, REST);
    let fall = |strands: &[u32]| {
        let mut simulation = Simulation::builder(groom.clone())
            .strands(strands)
            .materials(&[Material { bend: 0.01, ..Material::default() }])
            .solver(Solver { sag_free: false, ..Solver::default() })
            .build()
            .unwrap();
        let roots: Vec<RigidTransform> =
            strands.iter().map(|s| translation(groom.strand(*s as usize)[0])).collect();
        for _ in 0..90 {
            step(&mut simulation, REST, &roots, std::slice::from_ref(&collider));
        }
        points(&simulation)
    };
    let all = fall(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let lying = all.iter().filter(|p| p.length() < bench::RADIUS + 1e-5).count();
    assert!(lying > 3 * 8, "only {lying} points lie on the ball, including the roots");
    for strand in 0..8 {
        let alone = fall(&[strand]);
        assert!(
            alone == all[groom.range(strand as usize)],
            "strand {strand} depends on the others in its tile"
        );
    }
}

/// Strands that share a tile do not affect each other, whichever branch one of them takes.
#[test]
fn strands_are_independent_of_their_tile() {
    neighbours_do_not_show_in(Arc::new(bench::groom(8, 20)));
}

/// The same for strands of different lengths, of which the longer ones run more iterations.
#[test]
fn strands_are_independent_of_longer_ones_in_their_tile() {
    let strand = |k: usize| {
        let points = 12 << (k / 2);
        let out = Vec3::new((k as f32).cos(), 0.2, (k as f32).sin());
        (0..points).map(|i| i as f32 / 100.0).map(|s| out * s - Vec3::Y * s * s).collect::<Vec<_>>()
    };
    neighbours_do_not_show_in(Arc::new(Groom::from_strands((0..8).map(strand), 40e-6)));
}

fn neighbours_do_not_show_in(groom: Arc<Groom>) {
    for model in Model::ALL {
        let run = |strands: &[u32]| {
            let material = Material { model, ..Material::default() };
            let solver = Solver { sag_free: false, ..Solver::default() };
            let mut simulation = Simulation::builder(groom.clone())
                .strands(strands)
                .materials(&[material])
                .solver(solver)
                .build()
                .unwrap();
            let roots: Vec<RigidTransform> =
                strands.iter().map(|s| translation(groom.strand(*s as usize)[0])).collect();
            for frame in 0..60 {
                let head = translation(Vec3::X * (0.05 * (frame as f32).sin()));
                step(&mut simulation, head, &roots, &[]);
            }
            points(&simulation)
        };
        let all = run(&[0, 1, 2, 3, 4, 5, 6, 7]);
        for s in 0..8 {
            assert!(
                run(&[s])[..] == all[groom.range(s as usize)],
                "{model:?}: strand {s} has other bits alone"
            );
        }
    }
}

#[test]
fn instruction_sets_agree() {
    Model::ALL.into_iter().for_each(instruction_sets_agree_for);
}

fn instruction_sets_agree_for(model: Model) {
    let material = || Material { model, ..Material::default() };
    let run = |set: &str| {
        let mut bench = Bench::with_material(64, 20, material(), Solver::default());
        if !bench.simulation.use_instruction_set(set) {
            println!("skipped: this processor does not support {set}");
            return None;
        }
        (0..6).for_each(|_| _ = bench.step());
        Some(points(&bench.simulation))
    };
    let best = Bench::new(8, 20, Solver::default()).simulation.instruction_set();
    let reference = run(&best).unwrap();
    for set in ["sse2", "avx2", "avx512"] {
        if let Some(points) = run(set) {
            let mut distances: Vec<f32> =
                points.iter().zip(&reference).map(|(a, b)| a.distance(*b)).collect();
            distances.sort_by(f32::total_cmp);
            let median = distances[distances.len() / 2];
            println!(
                "{model:?}, {set} and {best}: median distance {median} m, worst {}",
                distances[distances.len() - 1]
            );
            assert!(median < 2e-5, "{model:?}: {set} and {best} differ by {median} m in the median");
        }
    }
}
