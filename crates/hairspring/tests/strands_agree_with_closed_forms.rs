//! Promise: strands agree with closed forms.
use hairspring::validate::CASES;
use rayon::prelude::*;
#[test]
fn all() {
    let jobs: Vec<_> = CASES
        .iter()
        .filter(|c| std::env::var("ONLY").is_err() || std::env::var("ONLY").unwrap() == c.name)
        .flat_map(|c| c.defaults.iter().map(move |d| (c, d)))
        .collect();
    let all: Vec<_> = jobs
        .par_iter()
        .map(|(c, d)| {
            let t = std::time::Instant::now();
            (c.run(d, c.method), t.elapsed())
        })
        .collect();
    for (run, t) in all {
        for o in run {
            println!(
                "{:18} {:?} {:28} {:?} {:?} {:?} {} {:?}",
                o.case,
                o.parameters,
                o.quantity,
                o.measured,
                o.reference,
                o.relative_error().map(|e| e * 100.0),
                o.pass(),
                t
            );
        }
    }
}
