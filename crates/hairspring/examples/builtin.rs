use hairspring::{
    scene::builtin::{BuiltinOptions, scene},
    stage::Stage,
};
use std::time::Instant;
fn main() {
    let n: u32 = std::env::args().nth(1).map_or(100_000, |a| a.parse().unwrap());
    let t = Instant::now();
    let s = scene(&BuiltinOptions { strands: n, ..Default::default() });
    println!("scene {:?}", t.elapsed());
    let t = Instant::now();
    let mut st = Stage::new(s).unwrap();
    println!("stage {:?} {:?} stiffened {}", t.elapsed(), st.simulated_strands(), st.stiffened_joints());
    let rest: Vec<glam::Vec3> = st.strands().next().unwrap().points.to_vec();
    let g = st.strands().next().unwrap().groom.points.clone();
    let d = |a: &[glam::Vec3], b: &[glam::Vec3]| {
        a.iter().zip(b).map(|(a, b)| a.distance(*b) as f64).sum::<f64>() / a.len() as f64
    };
    println!("first frame vs file {}", d(&rest, &g));
    for f in 0..150 {
        let r = st.step(1.0 / 30.0);
        if f % 10 == 0 {
            println!("{f} {r:?} {:?}", st.measure());
            println!("   moved {}", d(st.strands().next().unwrap().points, &rest));
        }
    }
}
