//! A picture in linear light, for compositing and for the mean of several moments.

use crate::{
    image::Image,
    tonemap::{Encoder, filmic, filmic_on},
};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// A picture in linear light with coverage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearImage {
    /// Number of pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Linear Rec. 709 light times coverage, and coverage (0 to 1), row by row from the top left corner; shape
    /// `[height × width]`. The tone curve is not applied.
    pub rgba: Vec<Vec4>,
}

/// Depth and motion of what is visible in each pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GeometryImage {
    /// Distance along the camera's axis [m], averaged over what is visible; [`GeometryImage::EMPTY`] where
    /// nothing is. Shape `[height × width]`.
    pub depth: Vec<f32>,
    /// Displacement since the earlier frame [pixels]: to the right, and upward. 0 where nothing is visible.
    /// Shape `[height × width]`.
    pub motion: Vec<[f32; 2]>,
}

impl GeometryImage {
    /// Depth of pixels in which nothing is visible [m], as in Blender.
    pub const EMPTY: f32 = 1e10;

    /// From (depth, right, down) times coverage, and coverage.
    pub(crate) fn new(pixels: &[Vec4]) -> Self {
        let mean = |p: &Vec4| (p.w > 1e-4).then(|| p.truncate() / p.w);
        Self {
            depth: pixels.par_iter().map(|p| mean(p).map_or(Self::EMPTY, |p| p.x)).collect(),
            motion: pixels.par_iter().map(|p| mean(p).map_or([0.0; 2], |p| [p.y, -p.z])).collect(),
        }
    }
}

impl LinearImage {
    /// Adds `weight` times `other`, which has the same size. The first picture sets the size.
    pub fn add(&mut self, other: &Self, weight: f32) {
        if self.rgba.is_empty() {
            (self.width, self.height) = (other.width, other.height);
            self.rgba.resize(other.rgba.len(), Vec4::ZERO);
        }
        self.rgba.par_iter_mut().zip(&other.rgba).for_each(|(sum, pixel)| *sum += *pixel * weight);
    }

    /// The picture as it is shown: tone curve, sRGB, 8 bits. It has an alpha channel if a pixel is
    /// transparent; colors are then those of the visible part of each pixel.
    pub fn develop(&self) -> Image {
        let shown = |pixel: &Vec4| {
            let light = pixel.truncate() / pixel.w.max(1e-6);
            filmic(if pixel.w > 0.0 { light } else { Vec3::ZERO })
        };
        let mut image = self.encoded(shown);
        // A mean of opaque pixels may miss 1 by rounding.
        if self.rgba.iter().any(|p| p.w < 1.0 - 1e-4) {
            image.alpha = self.rgba.par_iter().map(|p| (p.w * 255.0 + 0.5) as u8).collect();
        }
        image
    }

    /// The same for a transparent picture on a plain backdrop (see [`Background::plain`](crate::Background::plain)): no pixel is transparent.
    pub fn develop_on(&self, plain: Vec3) -> Image {
        self.encoded(|pixel| filmic_on(plain, pixel.truncate(), Vec3::splat(pixel.w)))
    }

    /// The picture with `shown` colors, in 8 bits.
    fn encoded(&self, shown: impl Fn(&Vec4) -> Vec3 + Sync) -> Image {
        let encoder = Encoder::default();
        let width = self.width.max(1) as usize;
        let mut image = Image::new(self.width, self.height);
        image.rgb.par_chunks_mut(3).zip(&self.rgba).enumerate().for_each(|(i, (out, pixel))| {
            out.copy_from_slice(&encoder.encode(shown(pixel), i % width, i / width));
        });
        image
    }
}
