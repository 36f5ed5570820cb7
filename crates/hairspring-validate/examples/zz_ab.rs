use hairspring::settings::Solver;
use hairspring_validate::bench::Bench;
fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    let mut b = Bench::new(2000, 32, Solver::default());
    for _ in 0..30 {
        b.step();
    }
    let mut t: Vec<f64> = (0..400)
        .map(|_| {
            let n = std::time::Instant::now();
            b.step();
            n.elapsed().as_secs_f64()
        })
        .collect();
    t.sort_by(f64::total_cmp);
    println!(
        "median {:.3} ns/pt/substep, 5% {:.3}",
        t[200] * 1e9 / (2000.0 * 32.0 * 4.0),
        t[20] * 1e9 / (2000.0 * 32.0 * 4.0)
    );
}
