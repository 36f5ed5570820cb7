//! Counts the work of a frame while it is drawn, as the basis of estimates of operations and bytes.

use std::ops::Add;

/// The work of the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Number of segments of strands. Each is projected and splatted into voxels.
    pub segments: u64,
    /// Number of segments in tiles, counted once for each tile that they touch.
    pub filed: u64,
    /// Number of these that were drawn: not hidden, and not left out because others represent them.
    pub drawn: u64,
    /// Number of columns (or rows) of pixels that were traversed while drawing. Each blends two pixels, or as
    /// many as the strand is wide.
    pub columns: u64,
    /// Number of lit points, in blocks of eight. If two tiles light a block at once, both are counted.
    pub lit: u64,
    /// Number of pixels of the picture.
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
