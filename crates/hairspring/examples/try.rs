use hairspring::scene::{Solver, bench::Bench};
use std::time::Instant;
fn main() {
    let a: Vec<u32> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let (strands, points, substeps, frames) = (a[0], a[1], a[2], a[3]);
    let t = Instant::now();
    let mut b = Bench::new(
        strands,
        points,
        Solver { substeps, projections: a.get(4).copied().unwrap_or(3), ..Solver::default() },
    );
    println!(
        "build {:?} {} bytes/pt {:.1}",
        t.elapsed(),
        b.simulation.instruction_set(),
        b.simulation.bytes() as f64 / b.simulation.point_count() as f64
    );
    if let Ok(l) = std::env::var("ISA") {
        assert!(b.simulation.use_instruction_set(&l));
        println!("{}", b.simulation.instruction_set());
    }
    let mut times = vec![];
    let mut worst = 0f64;
    let mut depth = 0f64;
    let mut mean = 0f64;
    for f in 0..frames {
        let t = Instant::now();
        let r = b.step();
        times.push(t.elapsed().as_secs_f64());
        let m = b.measure();
        worst = worst.max(m.stretch_max);
        depth = depth.max(m.max_depth);
        mean = mean.max(m.stretch_mean);
        if f % 30 == 29 || r.reset_strands > 0 {
            println!("{f} {m:?} {r:?}");
        }
    }
    times.sort_by(f64::total_cmp);
    let med = times[times.len() / 2];
    let n = (strands * points) as f64 * substeps as f64;
    println!(
        "median {:.2} ms, {:.2} ns/pt/substep wall, threads {} => {:.2} per core; worst {worst} depth {depth} mean {mean}",
        med * 1e3,
        med / n * 1e9,
        rayon::current_num_threads(),
        med / n * 1e9 * rayon::current_num_threads() as f64
    );
}
