//! One frame of a full head: 100,000 strands of 32 points, 1280 × 720, light and shadow included, on one thread and on two. The built-in
//! head at rest, brows and body included, and straight and wavy hair on a ball. Prints where the time went and how much was done. Beside
//! it, the same frames on the graphics card, from arrays to the finished texture, where there is one; its name is printed. `moving` is what the
//! window draws of moving hair where there is no card: half as large, 3,000 strands, coarser shadows.
//!
//! The argument is the number of threads; 0 stands for the card.
//!
//! `cargo bench -p hairspring-view --bench frame`

#[path = "../tests/support/mod.rs"]
mod support;

use divan::Bencher;
use hairspring_scene::{
    HairColor, HairLook,
    builtin::{BuiltinOptions, scene},
    stage::Stage,
};
use hairspring_view::{
    Frame, HairDraw, Lighting, MeshDraw, Quality, Renderer,
    gpu::{Gpu, GpuRenderer},
};
use std::sync::LazyLock;

fn main() {
    divan::main();
}

/// Threads that stand for the graphics card.
const CARD: usize = 0;

fn bench(bencher: Bencher, frame: &Frame, threads: usize) {
    if threads == CARD {
        return on_card(bencher, frame);
    }
    on_threads(bencher, frame, threads, [1280, 720]);
}

fn on_threads(bencher: Bencher, frame: &Frame, threads: usize, [width, height]: [u32; 2]) {
    let mut renderer = Renderer::new(width, height);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| renderer.draw(frame).rgb[0]);
    bencher.bench_local(|| pool.install(|| renderer.draw(frame).rgb[0]));
    eprintln!("{:?}\n{:?}", renderer.timings(), renderer.work());
}

/// Draws and waits for the card.
fn on_card(bencher: Bencher, frame: &Frame) {
    let gpu = match Gpu::open() {
        Ok(gpu) => gpu,
        Err(error) => return eprintln!("skipped: {error}"),
    };
    let mut renderer = GpuRenderer::new(&gpu);
    let mut draw = || {
        renderer.draw(frame, 1280, 720);
        gpu.wait().unwrap();
    };
    draw();
    bencher.bench_local(draw);
    eprintln!("{}: {:?}", gpu.name(), renderer.timings());
}

/// Takes seconds to grow.
static HEAD: LazyLock<Stage> = LazyLock::new(|| Stage::new(scene(&BuiltinOptions::default())).unwrap());

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2, CARD])]
fn head(bencher: Bencher, threads: usize) {
    seen(&HEAD, |frame| bench(bencher, frame, threads));
}

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2])]
fn moving(bencher: Bencher, threads: usize) {
    let stage = Stage::new(scene(&BuiltinOptions { strands: 3_000, ..Default::default() })).unwrap();
    let quality = Quality { shadow_voxels: 48, shadow_texels: 384, ..Quality::default() };
    seen(&stage, |frame| on_threads(bencher, &Frame { quality, ..*frame }, threads, [500, 390]));
}

/// The stage as it is, by its own camera.
fn seen(stage: &Stage, draw: impl FnOnce(&Frame)) {
    let hair: Vec<HairDraw> = stage.strands().map(HairDraw::of).collect();
    let body = stage.body().map(MeshDraw::of);
    let camera = stage.scene().camera.unwrap();
    let lighting = Lighting::facing(&camera);
    let frame = Frame { camera, lighting, ..support::frame(&hair, body.as_slice()) };
    draw(&frame);
}

fn ball(bencher: Bencher, style: support::Style, color: HairColor, threads: usize) {
    let groom = support::groom(style);
    let ball = support::ball();
    let look = HairLook::from(color);
    let (hair, bodies) = ([support::hair(&groom, &look)], [support::body(&ball)]);
    bench(bencher, &support::frame(&hair, &bodies), threads);
}

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2, CARD])]
fn straight(bencher: Bencher, threads: usize) {
    ball(bencher, support::STRAIGHT, HairColor::Brown, threads);
}

#[divan::bench(sample_count = 20, sample_size = 1, args = [1, 2, CARD])]
fn wavy(bencher: Bencher, threads: usize) {
    ball(bencher, support::WAVY, HairColor::Blonde, threads);
}
