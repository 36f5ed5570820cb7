//! Two pictures side by side, each with a caption below it.

use crate::letters::Letters;
use hairspring_view::Image;

/// Gap between the pictures [pixels].
const GAP: u32 = 4;
/// Height of the captions below them [pixels].
const CAPTION: u32 = 28;
/// Inset of the text [pixels].
const INSET: u32 = 10;
/// Gray of the gap and of the captions.
const DARK: u8 = 24;

/// Puts pictures side by side.
#[derive(Default)]
pub struct SideBySide(Letters);

impl SideBySide {
    /// Smallest width and height of the whole picture [pixels].
    pub const SMALLEST: [u32; 2] = [64, 64];

    /// Size of each picture in a whole of `size` [pixels], which is at least [`SideBySide::SMALLEST`].
    pub fn half(size: [u32; 2]) -> [u32; 2] {
        [(size[0] - GAP) / 2, size[1] - CAPTION]
    }

    /// Draws two pictures of the size [`SideBySide::half`] into rows `top` and below of `all`, which is
    /// `size[0]` pixels wide.
    pub fn draw(
        &mut self,
        all: &mut Image,
        top: u32,
        size: [u32; 2],
        halves: [&Image; 2],
        captions: &[String; 2],
    ) {
        let [width, height] = Self::half(size);
        let rows = 3 * (top * all.width) as usize..3 * ((top + size[1]) * all.width) as usize;
        all.rgb[rows].fill(DARK);
        for (k, half) in halves.into_iter().enumerate() {
            let left = k as u32 * (width + GAP);
            let bytes = 3 * width as usize;
            for (row, from) in half.rgb.chunks_exact(bytes).enumerate() {
                let at = 3 * ((top as usize + row) * all.width as usize + left as usize);
                all.rgb[at..at + bytes].copy_from_slice(from);
            }
            let place = [left + INSET, top + height + (CAPTION - INSET) / 3];
            self.0.write(all, place, width.saturating_sub(2 * INSET), &captions[k]);
        }
    }
}
