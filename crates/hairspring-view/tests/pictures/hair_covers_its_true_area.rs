//! Promise: a strand covers the area given by its width and length, wherever it lies relative to the
//! pixels.
//!
//! This keeps hair from shimmering: 100,000 strands, each a tenth of a pixel wide, are right on average
//! only if every single strand is. Black strands are drawn in front of a uniform gray wall. The light that
//! they block is the area that they cover. Codes are converted back to linear light through the picture's
//! own tone curve, which is measured here.

use glam::Vec3;
use hairspring_scene::{Camera, HairLook};
use hairspring_view::{Background, Frame, HairDraw, Image, Light, Lighting, Quality, Renderer};

const SIDE: u32 = 96;
const WALL: f32 = 0.2;

/// A camera that sees one pixel per millimeter at the depth of the origin.
fn camera() -> Camera {
    let distance: f32 = 3.0;
    Camera {
        position: Vec3::Z * distance,
        target: Vec3::ZERO,
        fov: 2.0 * (0.5 * SIDE as f32 * 1e-3 / distance).atan().to_degrees(),
        ..Camera::default()
    }
}

fn draw(points: &[Vec3], width: f32, wall: f32) -> Image {
    draw_as(1, points, width, wall)
}

/// Draws a strand with wisps of `wisp` hairs.
fn draw_as(wisp: u32, points: &[Vec3], width: f32, wall: f32) -> Image {
    let dark = Light { direction: Vec3::Y, color: Vec3::ZERO };
    let radii = vec![0.5e-3 * width; points.len()];
    let look = HairLook::default();
    let offsets = [0, points.len() as u32];
    let hair = [HairDraw {
        points,
        offsets: &offsets,
        radii: &radii,
        colors: &[],
        look: &look,
        width_scale: 1.0,
        follow: None,
    }];
    let frame = Frame {
        hair: &hair,
        bodies: &[],
        camera: camera(),
        lighting: Lighting {
            key: dark,
            fill: dark,
            rim: dark,
            sky: Vec3::ZERO,
            ground: Vec3::ZERO,
            exposure: 0.0,
        },
        background: Background { center: Vec3::splat(wall), edge: Vec3::splat(wall) },
        ground: None,
        quality: Quality { wisp, ..Quality::default() },
    };
    let mut renderer = Renderer::new(SIDE, SIDE);
    renderer.draw(&frame);
    renderer.image().clone()
}

/// The linear gray of each 8-bit code. The wall is drawn in many grays, and the resulting codes are
/// averaged over the dither.
struct Curve(Vec<(f32, f32)>);

impl Curve {
    fn measure() -> Self {
        Self(
            (0..=60)
                .map(|i| WALL * i as f32 / 60.0)
                .map(|gray| (mean(&draw(&[], 1.0, gray)), gray))
                .collect(),
        )
    }

    fn linear(&self, code: f32) -> f32 {
        let i = self.0.partition_point(|(c, _)| *c < code).clamp(1, self.0.len() - 1);
        let ((c0, g0), (c1, g1)) = (self.0[i - 1], self.0[i]);
        g0 + (g1 - g0) * (code - c0) / (c1 - c0)
    }

    /// The covered area [pixels].
    fn area(&self, image: &Image) -> f32 {
        image.rgb.iter().skip(1).step_by(3).map(|c| 1.0 - self.linear(*c as f32) / WALL).sum()
    }
}

fn mean(image: &Image) -> f32 {
    image.rgb.iter().skip(1).step_by(3).map(|c| *c as f32).sum::<f32>() / (SIDE * SIDE) as f32
}

/// A straight strand of 60 pixels at an angle, with `points` points, and with its middle shifted up by
/// `shift` pixels.
fn strand(degrees: f32, shift: f32, points: usize) -> Vec<Vec3> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let at = |k: usize| 60.0 * (k as f32 / (points - 1) as f32 - 0.5);
    (0..points).map(|k| Vec3::new(at(k) * cos + 0.3, at(k) * sin + shift, 0.0) * 1e-3).collect()
}

#[test]
fn area_is_exact_for_any_width_angle_and_place() {
    let curve = Curve::measure();
    for width in [0.05, 0.1, 0.3, 0.7, 1.0, 1.6, 3.0] {
        for degrees in [0.0, 12.0, 30.0, 45.0, 60.0, 77.0, 90.0] {
            for shift in [0.0, 0.21, 0.5, 0.83] {
                for points in [2, 9] {
                    let area = curve.area(&draw(&strand(degrees, shift, points), width, WALL));
                    let want = 60.0 * width;
                    let error = (area - want).abs() / want;
                    // 5 %, and an allowance for rounding by half a code in the pixels that a faint strand
                    // touches.
                    assert!(
                        error < 0.05 + 0.15 / want,
                        "width {width}, {degrees}°, shift {shift}, {points} points: {area} instead of {want}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_moving_hair_does_not_flicker() {
    let curve = Curve::measure();
    for (width, degrees) in [(0.12, 0.0), (0.12, 33.0), (0.5, 80.0), (1.4, 10.0)] {
        let frames: Vec<Image> =
            (0..32).map(|f| draw(&strand(degrees, f as f32 / 16.0, 9), width, WALL)).collect();
        let areas: Vec<f32> = frames.iter().map(|f| curve.area(f)).collect();
        let (low, high) = areas.iter().fold((f32::MAX, 0.0f32), |b, a| (b.0.min(*a), b.1.max(*a)));
        assert!(high - low < 0.04 * high + 0.2, "width {width}, {degrees}°: between {low} and {high}");
        // No pixel jumps. A motion of a sixteenth of a pixel changes a pixel by at most that share of the
        // strand's light, and slightly more at its ends.
        let most = curve.linear(mean(&draw(&[], 1.0, WALL))) * width.min(1.0) * 1.5;
        for pair in frames.windows(2) {
            for (a, b) in pair[0].rgb.iter().zip(&pair[1].rgb) {
                let jump = (curve.linear(*a as f32) - curve.linear(*b as f32)).abs();
                assert!(jump < most * 0.16 + 0.006, "width {width}, {degrees}°: a pixel jumps by {jump}");
            }
        }
    }
}

/// The hairs of a wisp cover the area of their strand, less where they cross. The area is the same at all
/// positions over 32 pixels, the side of a tile.
#[test]
fn a_wisp_covers_the_area_of_its_strand() {
    let curve = Curve::measure();
    for (wisp, width, degrees) in [(2, 1.6, 0.0), (4, 3.0, 90.0), (4, 2.0, 33.0), (3, 4.0, 12.0)] {
        let areas: Vec<f32> = (0..17)
            .map(|k| strand(degrees, 2.0 * k as f32 - 16.0, 9))
            .map(|strand| curve.area(&draw_as(wisp, &strand, width, WALL)))
            .collect();
        let (low, high) = areas.iter().fold((f32::MAX, 0.0f32), |b, a| (b.0.min(*a), b.1.max(*a)));
        let (least, most) = (0.75 * 60.0 * width, 1.05 * 60.0 * width);
        assert!(low > least && high < most, "{wisp} hairs, {degrees}°: {low} to {high} of {most}");
        assert!(high - low < 0.04 * high, "{wisp} hairs, {degrees}°: between {low} and {high}");
    }
}

#[test]
fn a_bent_strand_is_drawn_as_a_smooth_curve() {
    // A half circle of 9 points. Straight segments would be 2 % of the radius inside; the curve through the
    // points must not.
    let r = 30.0;
    let circle = |n: usize| -> Vec<Vec3> {
        (0..n)
            .map(|k| k as f32 / (n - 1) as f32 * std::f32::consts::PI)
            .map(|a| Vec3::new(r * a.cos(), r * a.sin() - 15.0, 0.0) * 1e-3)
            .collect()
    };
    let (coarse, fine) = (draw(&circle(9), 1.2, WALL), draw(&circle(400), 1.2, WALL));
    let curve = Curve::measure();
    let difference: f32 = coarse
        .rgb
        .iter()
        .zip(&fine.rgb)
        .map(|(a, b)| (curve.linear(*a as f32) - curve.linear(*b as f32)).abs() / WALL)
        .sum::<f32>()
        / 3.0;
    let area = curve.area(&fine);
    assert!(difference < 0.35 * area, "{difference} of {area} pixels differ");
    let polygon = draw(&circle(400).chunks(50).map(|c| c[0]).collect::<Vec<_>>(), 1.2, WALL);
    assert_ne!(polygon.rgb, fine.rgb);
}
