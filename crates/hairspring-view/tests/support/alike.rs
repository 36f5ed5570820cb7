//! Compares two pictures: structure by similarity of luminance (Wang et al. 2004), brightness by means,
//! bodies pixel by pixel.
#![allow(dead_code)] // Each test file uses a part of this module.

use hairspring_view::{Frame, Image, Renderer, gpu::GpuRenderer, write_png};
use image_compare::{Algorithm, gray_similarity_structure};

/// The smallest allowed similarity of structure; 1 is equal.
pub const ALIKE: f64 = 0.99;
/// The largest allowed difference of a channel's mean [codes of 255].
const BRIGHTNESS: f64 = 0.5;
/// The largest allowed difference of a channel in a pixel from the range of codes around it [codes of 255].
const BRIGHTNESS_HERE: i32 = 4;

/// Luminance (Rec. 709).
fn luma(image: &Image) -> image_compare::prelude::GrayImage {
    let gray = |p: &[u8]| (0.2126 * p[0] as f32 + 0.7152 * p[1] as f32 + 0.0722 * p[2] as f32).round() as u8;
    let gray = image.rgb.chunks(3).map(gray).collect();
    image_compare::prelude::GrayImage::from_raw(image.width, image.height, gray).unwrap()
}

/// Similarity of structure; 1 is equal.
pub fn similarity(a: &Image, b: &Image) -> f64 {
    gray_similarity_structure(&Algorithm::MSSIMSimple, &luma(a), &luma(b)).unwrap().score
}

/// Means of red, green and blue.
pub fn mean(image: &Image) -> [f64; 3] {
    let n = (image.rgb.len() / 3) as f64;
    [0, 1, 2].map(|c| image.rgb.iter().skip(c).step_by(3).map(|v| *v as f64).sum::<f64>() / n)
}

/// Renders with both renderers and compares the pictures.
pub fn compare(gpu: &mut GpuRenderer, name: &str, frame: &Frame, width: u32, height: u32) {
    let cpu = Renderer::new(width, height).draw(frame).clone();
    gpu.draw(frame, width, height);
    let card = gpu.read().unwrap();
    assert_eq!((card.width, card.height), (width, height));
    let score = similarity(&cpu, &card);
    let difference = mean(&cpu).into_iter().zip(mean(&card)).map(|(a, b)| b - a);
    let difference: Vec<f64> = difference.collect();
    println!("{name}: similarity {score:.4}, means differ by {difference:.2?}");
    if std::env::var_os("HAIRSPRING_KEEP").is_some()
        || score < ALIKE
        || difference.iter().any(|a| a.abs() > BRIGHTNESS)
    {
        let mut both = Image::new(2 * width, height);
        let rows = cpu.rgb.chunks(3 * width as usize).zip(card.rgb.chunks(3 * width as usize));
        for (to, (a, b)) in both.rgb.chunks_mut(6 * width as usize).zip(rows) {
            to[..a.len()].copy_from_slice(a);
            to[a.len()..].copy_from_slice(b);
        }
        let seen = std::env::temp_dir().join(format!("hairspring-gpu-{name}.png"));
        write_png(&seen, &both).unwrap();
        println!("{name}: both pictures, CPU and card, are in {}", seen.display());
    }
    assert!(score >= ALIKE, "{name}: the similarity is {score:.4}, but {ALIKE} is needed");
    assert!(difference.iter().all(|a| a.abs() <= BRIGHTNESS), "{name}: the means differ by {difference:?}");
}

/// Renders bodies with both renderers and compares pixel by pixel. No channel of the card's picture may
/// differ by more than `BRIGHTNESS_HERE` from the CPU's range in the pixel and its eight neighbors. Means
/// and structure tolerate a row of dark dots; this comparison does not. Outlines, where samples differ,
/// have both sides among the neighbors.
pub fn compare_everywhere(gpu: &mut GpuRenderer, name: &str, frame: &Frame, width: usize, height: usize) {
    compare(gpu, name, frame, width as u32, height as u32);
    let (cpu, card) = (Renderer::new(width as u32, height as u32).draw(frame).clone(), gpu.read().unwrap());
    let (mut worst, mut place) = (0, [0; 2]);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        for c in 0..3 {
            let neighborhood =
                rows.clone().flat_map(|y| columns.clone().map(move |x| 3 * (y * width + x) + c));
            let codes = neighborhood.map(|i| cpu.rgb[i] as i32);
            let (low, high) = codes.fold((255, 0), |b, v| (b.0.min(v), b.1.max(v)));
            let here = card.rgb[3 * (y * width + x) + c] as i32;
            let excess = (low - here).max(here - high);
            if excess > worst {
                (worst, place) = (excess, [x, y]);
            }
        }
    }
    println!("{name}: the largest difference is {worst} codes, at {place:?}");
    assert!(worst <= BRIGHTNESS_HERE, "{name}: the difference is {worst} codes at {place:?}");
}
