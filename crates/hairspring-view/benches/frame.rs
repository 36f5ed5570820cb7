//! One frame of a full head: 100,000 strands of 32 points on a ball, 1280 × 720, light and shadow included.
//! `cargo bench -p hairspring-view`

#[path = "../tests/support/mod.rs"]
mod support;

use divan::Bencher;
use hairspring::scene::{HairColor, HairLook};
use hairspring_view::Renderer;

fn main() {
    divan::main();
}

fn frame(bencher: Bencher, style: support::Style, color: HairColor) {
    let groom = support::groom(style);
    let ball = support::ball();
    let look = HairLook::from(color);
    let (hair, bodies) = ([support::hair(&groom, &look)], [support::body(&ball)]);
    let frame = support::frame(&hair, &bodies);
    let mut renderer = Renderer::new(1280, 720);
    renderer.draw(&frame);
    bencher.bench_local(|| renderer.draw(&frame).rgb[0]);
    eprintln!("{} strands, {} points: {:?}", groom.strand_count(), groom.point_count(), renderer.timings());
}

#[divan::bench(sample_count = 20, sample_size = 1)]
fn straight(bencher: Bencher) {
    frame(bencher, support::STRAIGHT, HairColor::Brown);
}

#[divan::bench(sample_count = 20, sample_size = 1)]
fn wavy(bencher: Bencher) {
    frame(bencher, support::WAVY, HairColor::Blonde);
}
