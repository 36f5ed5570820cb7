//! One frame of a full head: 100,000 strands of 32 points on a ball, 1280 × 720, light and shadow included, on one thread and on two.
//! `cargo bench -p hairspring-view`

#[path = "../tests/support/mod.rs"]
mod support;

use divan::Bencher;
use hairspring::scene::{HairColor, HairLook};
use hairspring_view::Renderer;

fn main() {
    divan::main();
}

fn frame(bencher: Bencher, style: support::Style, color: HairColor, threads: usize) {
    let groom = support::groom(style);
    let ball = support::ball();
    let look = HairLook::from(color);
    let (hair, bodies) = ([support::hair(&groom, &look)], [support::body(&ball)]);
    let frame = support::frame(&hair, &bodies);
    let mut renderer = Renderer::new(1280, 720);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| renderer.draw(&frame).rgb[0]);
    bencher.bench_local(|| pool.install(|| renderer.draw(&frame).rgb[0]));
    eprintln!("{} strands, {} points: {:?}", groom.strand_count(), groom.point_count(), renderer.timings());
}

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2])]
fn straight(bencher: Bencher, threads: usize) {
    frame(bencher, support::STRAIGHT, HairColor::Brown, threads);
}

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2])]
fn wavy(bencher: Bencher, threads: usize) {
    frame(bencher, support::WAVY, HairColor::Blonde, threads);
}
