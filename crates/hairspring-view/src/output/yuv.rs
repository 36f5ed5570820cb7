//! Converts RGB to the color space of video: BT.709, limited range, one color sample per four pixels.

use crate::image::Image;
use openh264::formats::YUVSlices;
use rayon::prelude::*;

/// Three planes of even size.
#[derive(Debug, Default)]
pub(super) struct Planes {
    size: (usize, usize),
    y: Vec<u8>,
    u: Vec<u8>,
    v: Vec<u8>,
}

impl Planes {
    /// Converts a picture. An odd last column or row is duplicated.
    pub fn fill(&mut self, image: &Image) {
        let (w, h) = (image.width as usize, image.height as usize);
        let (ew, eh) = (w.next_multiple_of(2), h.next_multiple_of(2));
        self.size = (ew, eh);
        self.y.resize(ew * eh, 0);
        self.u.resize(ew * eh / 4, 0);
        self.v.resize(ew * eh / 4, 0);
        let pixel = |x: usize, y: usize| {
            let i = (y.min(h - 1) * w + x.min(w - 1)) * 3;
            [image.rgb[i] as i32, image.rgb[i + 1] as i32, image.rgb[i + 2] as i32]
        };
        let rows = self
            .y
            .par_chunks_mut(2 * ew)
            .zip(self.u.par_chunks_mut(ew / 2))
            .zip(self.v.par_chunks_mut(ew / 2));
        rows.enumerate().for_each(|(pair, ((luma, u), v))| {
            for x in 0..ew / 2 {
                let mut sum = [0; 3];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let [r, g, b] = pixel(2 * x + dx, 2 * pair + dy);
                    // ITU-R BT.709-6, section 3, in 16-bit fixed point: 219 steps from 16.
                    luma[dy * ew + 2 * x + dx] =
                        ((11966 * r + 40254 * g + 4064 * b + 32768) >> 16) as u8 + 16;
                    sum = [sum[0] + r, sum[1] + g, sum[2] + b];
                }
                // Color differences of the sum of four pixels, 224 steps around 128.
                let [r, g, b] = sum;
                u[x] = (128 + ((-6596 * r - 22189 * g + 28785 * b + 131072) >> 18)) as u8;
                v[x] = (128 + ((28785 * r - 26145 * g - 2640 * b + 131072) >> 18)) as u8;
            }
        });
    }

    pub fn slices(&self) -> YUVSlices<'_> {
        let (w, _) = self.size;
        YUVSlices::new((&self.y, &self.u, &self.v), self.size, (w, w / 2, w / 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colors() {
        // BT.709 limited range: black, white, red, green, blue.
        let cases = [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
        ];
        for (rgb, yuv) in cases {
            let mut image = Image::new(3, 3);
            image.rgb.chunks_mut(3).for_each(|p| p.copy_from_slice(&rgb));
            let mut planes = Planes::default();
            planes.fill(&image);
            assert_eq!(planes.size, (4, 4));
            for (plane, want) in [&planes.y, &planes.u, &planes.v].into_iter().zip(yuv) {
                assert!(
                    plane.iter().all(|c| c.abs_diff(want) <= 1),
                    "{rgb:?}: {} instead of {want}",
                    plane[0]
                );
            }
        }
    }
}
