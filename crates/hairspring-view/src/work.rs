//! How much a frame took, counted while it is drawn: what a floor of operations and bytes is worked out from.

use std::ops::Add;

/// What was done for the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Segments of strands: each is projected and counted into voxels.
    pub segments: u64,
    /// Segments filed under tiles, once for each tile that they touch.
    pub filed: u64,
    /// Of those, the segments that were drawn: not hidden, and not left out where others stand for them.
    pub drawn: u64,
    /// Columns (or rows) of pixels that were walked while drawing them; each blends two pixels, or as many as the strand is wide.
    pub columns: u64,
    /// Points of strands that were lit, in blocks of eight: two tiles that light a block at once are both counted.
    pub lit: u64,
    /// Pixels of the picture.
    pub pixels: u64,
}

impl Add for Work {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self {
            segments: self.segments + o.segments,
            filed: self.filed + o.filed,
            drawn: self.drawn + o.drawn,
            columns: self.columns + o.columns,
            lit: self.lit + o.lit,
            pixels: self.pixels + o.pixels,
        }
    }
}
