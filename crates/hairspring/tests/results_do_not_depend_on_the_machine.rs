//! Promise: the same bits for any number of threads, and the same hair on any instruction set.
//!
//! Strands are independent within a step and every sum has one order, so threads cannot show. Instruction sets differ in fused
//! multiplication only: after a tenth of a second of hair falling from standing on end (later, rounding decides which way each
//! strand has buckled) they agree to a fraction of a hair's width in the median.

use glam::Vec3;
use hairspring::scene::{
    Guides, Solver,
    bench::Bench,
    builtin::{BuiltinOptions, Style, scene},
};
use hairspring::stage::Stage;

fn bench(threads: usize) -> Vec<Vec3> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut bench = Bench::new(333, 20, Solver::default());
        (0..60).for_each(|_| _ = bench.step());
        let mut points = vec![Vec3::ZERO; bench.simulation.point_count()];
        bench.simulation.write_points(&mut points);
        points
    })
}

#[test]
fn threads_do_not_show_in_the_simulation() {
    let one = bench(1);
    assert!(one == bench(2), "two threads give other bits than one");
    assert!(one == bench(7), "seven threads give other bits than one");
}

#[test]
fn threads_do_not_show_in_a_whole_scene() {
    let play = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
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

#[test]
fn instruction_sets_agree() {
    let run = |set: &str| {
        let mut bench = Bench::new(64, 20, Solver::default());
        if !bench.simulation.use_instruction_set(set) {
            println!("skipped {set}: this processor has none");
            return None;
        }
        (0..6).for_each(|_| _ = bench.step());
        let mut points = vec![Vec3::ZERO; bench.simulation.point_count()];
        bench.simulation.write_points(&mut points);
        Some(points)
    };
    let best = Bench::new(8, 20, Solver::default()).simulation.instruction_set();
    let reference = run(&best).unwrap();
    for set in ["sse2", "sse4_2", "avx2", "avx512"] {
        if let Some(points) = run(set) {
            let mut apart: Vec<f32> = points.iter().zip(&reference).map(|(a, b)| a.distance(*b)).collect();
            apart.sort_by(f32::total_cmp);
            let median = apart[apart.len() / 2];
            println!("{set} and {best}: median distance {median} m, worst {}", apart[apart.len() - 1]);
            assert!(median < 2e-5, "{set} and {best} differ by {median} m in the median");
        }
    }
}
