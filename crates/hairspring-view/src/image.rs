//! A finished picture.

/// 8-bit sRGB pixels, row by row from the top left corner.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Number of pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Red, green, blue of each pixel; shape `[height × width × 3]`.
    pub rgb: Vec<u8>,
    /// Coverage of each pixel, 0 to 255, shape `[height × width]`; empty if the picture is opaque. Colors are
    /// not multiplied with it.
    pub alpha: Vec<u8>,
}

impl Image {
    /// Creates a black picture.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, rgb: vec![0; width as usize * height as usize * 3], alpha: Vec::new() }
    }

    /// Red, green and blue of the pixel at column `x`, row `y`, which must be inside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let i = (y as usize * self.width as usize + x as usize) * 3;
        [self.rgb[i], self.rgb[i + 1], self.rgb[i + 2]]
    }
}
