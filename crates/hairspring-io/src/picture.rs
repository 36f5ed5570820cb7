//! Pictures whose pixels are data: maps over the scalp.

use crate::Problem;
use glam::{UVec2, Vec2, Vec3};
use image::{ImageBuffer, ImageReader, Limits, Rgb};
use std::io::Cursor;

/// Largest width and height of a picture [pixels].
const MAX_SIDE: u32 = 16_384;

/// Memory for decoding that a file of any size may use [bytes], and that for each of its bytes.
const MEMORY: (u64, u64) = (64 << 20, 256);

/// A picture in memory.
#[derive(Debug)]
pub(crate) struct Picture {
    pixels: ImageBuffer<Rgb<u16>, Vec<u16>>,
}

impl Picture {
    /// Decodes a `.png` or `.jpg`. Values are as stored: a color profile is ignored.
    pub(crate) fn parse(data: &[u8]) -> Result<Self, Problem> {
        let wrong = |error: image::ImageError| {
            Problem::whole(format!("the picture cannot be read ({error}); export it as PNG or JPEG"))
        };
        let mut reader = ImageReader::new(Cursor::new(data))
            .with_guessed_format()
            .map_err(|error| wrong(image::ImageError::IoError(error)))?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIDE), Some(MAX_SIDE));
        limits.max_alloc = Some(MEMORY.0 + MEMORY.1 * data.len() as u64);
        reader.limits(limits);
        Ok(Self { pixels: reader.decode().map_err(wrong)?.into_rgb16() })
    }

    /// Color at texture coordinates, 0 to 1, v upward from the lower edge: linear between the centers of pixels, and
    /// repeated outside of 0 to 1.
    pub(crate) fn at(&self, uv: Vec2) -> Vec3 {
        let size = UVec2::new(self.pixels.width(), self.pixels.height());
        let uv = if uv.is_finite() { uv - uv.floor() } else { Vec2::ZERO };
        let at = Vec2::new(uv.x, 1.0 - uv.y) * size.as_vec2() - 0.5;
        let (corner, part) = (at.floor(), at - at.floor());
        let pixel = |x: i32, y: i32| {
            let wrapped =
                |k: f32, step: i32, n: u32| (k as i64 + i64::from(step)).rem_euclid(i64::from(n)) as u32;
            let Rgb(color) =
                self.pixels.get_pixel(wrapped(corner.x, x, size.x), wrapped(corner.y, y, size.y));
            Vec3::from(color.map(f32::from)) / f32::from(u16::MAX)
        };
        let row = |y: i32| pixel(0, y).lerp(pixel(1, y), part.x);
        row(0).lerp(row(1), part.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(pixels: [[u8; 3]; 4]) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        let bytes = pixels.concat();
        image::write_buffer_with_format(
            &mut file,
            &bytes,
            2,
            2,
            image::ColorType::Rgb8,
            image::ImageFormat::Png,
        )
        .unwrap();
        file.into_inner()
    }

    #[test]
    fn the_lower_left_pixel_is_at_the_origin_and_values_blend_between_centers() {
        // Upper row red, green; lower row blue, black.
        let picture = Picture::parse(&png([[255, 0, 0], [0, 255, 0], [0, 0, 255], [0, 0, 0]])).unwrap();
        let near = |uv: [f32; 2], color: [f32; 3]| {
            let found = picture.at(Vec2::from(uv));
            assert!(found.distance(Vec3::from(color)) < 1e-4, "{uv:?}: {found}");
        };
        near([0.25, 0.25], [0.0, 0.0, 1.0]);
        near([0.25, 0.75], [1.0, 0.0, 0.0]);
        near([0.75, 0.75], [0.0, 1.0, 0.0]);
        near([1.25, -0.75], [0.0, 0.0, 1.0]);
        near([0.5, 0.75], [0.5, 0.5, 0.0]);
        near([0.25, 0.5], [0.5, 0.0, 0.5]);
        near([f32::NAN, 0.0], [0.25, 0.25, 0.25]);
    }

    #[test]
    fn invalid_and_oversized_pictures_are_refused() {
        for data in [&b""[..], b"no picture", &png([[9; 3]; 4])[..40]] {
            let text = Picture::parse(data).unwrap_err().to_string();
            assert!(text.contains("export it as PNG or JPEG"), "{text}");
        }
        // A header that claims 16,000 by 16,000 pixels.
        let mut bomb = png([[9; 3]; 4]);
        bomb[16..24].copy_from_slice(&[0, 0, 0x3e, 0x80, 0, 0, 0x3e, 0x80]);
        assert!(Picture::parse(&bomb).is_err());
    }
}
