//! Linear light to the 8 bits of a screen.

use glam::{Mat3, Vec3};

/// From linear sRGB to the color space of the filmic curve.
pub(crate) const FILM_IN: Mat3 =
    Mat3::from_cols_array(&[0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777]);
/// The inverse transform.
pub(crate) const FILM_OUT: Mat3 = Mat3::from_cols_array(&[
    1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602,
]);
/// The curve: (v (v + a) - b) / (v (c v + d) + e).
pub(crate) const FILM: [f32; 5] = [0.0245786, 0.000090537, 0.983729, 0.432_951, 0.238081];

/// The filmic curve of the Academy Color Encoding System (reference rendering and sRGB output transforms), as
/// fitted by Stephen Hill in "BakingLab" (2016). Highlights lose their color toward white, as on film.
#[inline(always)]
pub(crate) fn filmic(light: Vec3) -> Vec3 {
    let v = FILM_IN * light;
    let [a, b, c, d, e] = FILM;
    let curve = (v * (v + Vec3::splat(a)) - Vec3::splat(b)) / (v * (v * c + Vec3::splat(d)) + Vec3::splat(e));
    (FILM_OUT * curve).clamp(Vec3::ZERO, Vec3::ONE)
}

/// The color of a pixel that light, times the share `cover` of the pixel that it comes from, leaves open to a plain
/// backdrop.
#[inline(always)]
pub(crate) fn filmic_on(plain: Vec3, light: Vec3, cover: Vec3) -> Vec3 {
    let cover = cover.clamp(Vec3::ZERO, Vec3::ONE);
    filmic(light / cover.max(Vec3::splat(1e-4))) * cover + plain * (Vec3::ONE - cover)
}

/// Table from linear to sRGB (IEC 61966-2-1), in 255ths, over the square root of the linear value.
pub(crate) struct Encoder {
    table: Vec<f32>,
}

/// Number of entries of the table; the error is below a twentieth of a code.
const STEPS: usize = 1024;

impl Default for Encoder {
    fn default() -> Self {
        let encode = |c: f32| {
            if c <= 0.0031308 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
        };
        let table = (0..=STEPS + 1)
            .map(|i| (i as f32 / STEPS as f32).powi(2))
            .map(|c| 255.0 * encode(c.min(1.0)))
            .collect();
        Self { table }
    }
}

impl Encoder {
    /// sRGB codes of a linear color (0 to 1) at a pixel. An ordered dither of one code avoids banding in slow
    /// gradients.
    #[inline(always)]
    pub fn encode(&self, color: Vec3, x: usize, y: usize) -> [u8; 3] {
        // Interleaved gradient noise (Jimenez 2014), fixed to the picture, so that still parts of a clip do
        // not change.
        let noise = (52.982_92 * (0.067_110_56 * x as f32 + 0.005_837_15 * y as f32).fract()).fract();
        [self.code(color.x, noise), self.code(color.y, noise), self.code(color.z, noise)]
    }

    #[inline(always)]
    fn code(&self, c: f32, noise: f32) -> u8 {
        let at = c.sqrt() * STEPS as f32;
        let (i, f) = (at as usize, at.fract());
        (self.table[i] + (self.table[i + 1] - self.table[i]) * f + noise) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_rises_from_black_to_white() {
        let mut last = -1.0;
        for i in 0..=800 {
            let gray = filmic(Vec3::splat(i as f32 / 50.0));
            assert!(gray.x >= last && gray.max_element() - gray.min_element() < 0.01);
            last = gray.x;
        }
        assert_eq!(filmic(Vec3::ZERO), Vec3::ZERO);
        assert!(last > 0.97);
    }

    #[test]
    fn encoding_is_srgb_within_one_code() {
        let encoder = Encoder::default();
        for (linear, code) in [(0.0, 0), (0.002, 7), (0.0144, 32), (0.2159, 128), (0.5271, 192), (1.0, 255)] {
            for pixel in 0..50 {
                let got = encoder.encode(Vec3::splat(linear), pixel, 3 * pixel)[0] as i32;
                assert!((got - code).abs() <= 1, "{linear} {got} {code}");
            }
        }
    }
}
