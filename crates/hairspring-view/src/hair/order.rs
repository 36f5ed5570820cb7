//! The order in which strands are processed: neighbors together.
//!
//! Files store strands in any order. Strands next to each other read the same voxels and touch the same
//! tiles. Processing them along a space-filling curve turns most reads from memory into reads from cache. The
//! only effect on the result is which of two pieces at exactly the same depth comes first.
//!
//! The per-point results of each strand are stored in slots, in this order. A strand takes a whole number of
//! blocks of [`LANES`], so that lanes never mix strands.

use super::shade::LANES;
use crate::frame::Frame;
use glam::Vec3;
use hairspring::groom::MortonCurve;
use rayon::prelude::*;
use std::ops::Range;

/// Approximate number of points of a run. Its pieces stay in the second-level cache while they are sorted
/// into tiles.
const RUN_POINTS: usize = 8192;

/// A run of neighboring strands of one style.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// Index of the style.
    pub hair: usize,
    /// Range in the ordered list of strands.
    range: Range<usize>,
    /// The slots of their points.
    pub slots: Range<usize>,
}

/// The strand whose points a block of slots holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owner {
    /// Index of the style.
    pub hair: u32,
    /// Index of the strand in the style.
    pub strand: u32,
    /// Index of the first point, counted from the strand's root.
    pub first: u32,
}

/// All strands of a frame, cut into runs.
#[derive(Debug, Default)]
pub(crate) struct Order {
    /// Position on the curve and strand index, style after style.
    strands: Vec<(u32, u32)>,
    pub runs: Vec<Run>,
    /// Shape `[slots / LANES]`.
    pub owners: Vec<Owner>,
}

impl Order {
    /// Orders the frame's strands, whose hair is inside `bounds`. The result depends only on the strands.
    pub fn fill(&mut self, frame: &Frame, bounds: (Vec3, Vec3)) {
        self.strands.clear();
        self.runs.clear();
        self.owners.clear();
        let curve = MortonCurve::covering(bounds.0, bounds.1);
        for (hair, h) in frame.hair.iter().enumerate() {
            let first = self.strands.len();
            // Strands are sorted by their middle points, because their roots are close together.
            self.strands.par_extend((0..h.strand_count()).into_par_iter().map(|s| {
                let range = h.range(s);
                let middle = h.points.get(range.start + range.len() / 2).copied().unwrap_or_default();
                (curve.index(middle), s as u32)
            }));
            self.strands[first..].par_sort_unstable();
            let (mut start, mut slot) = (first, self.owners.len() * LANES);
            for i in first..self.strands.len() {
                let strand = self.strands[i].1;
                let points = (0..h.range(strand as usize).len() as u32).step_by(LANES);
                self.owners.extend(points.map(|first| Owner { hair: hair as u32, strand, first }));
                let end = self.owners.len() * LANES;
                if end - slot >= RUN_POINTS || i + 1 == self.strands.len() {
                    self.runs.push(Run { hair, range: start..i + 1, slots: slot..end });
                    (start, slot) = (i + 1, end);
                }
            }
        }
    }

    /// Number of slots.
    pub fn slots(&self) -> usize {
        self.owners.len() * LANES
    }

    /// Splits an array over all slots into the parts of the runs.
    pub fn split<'a, T>(&self, mut slots: &'a mut [T]) -> Vec<&'a mut [T]> {
        let part = |run: &Run| slots.split_off_mut(..run.slots.len()).unwrap_or_default();
        self.runs.iter().map(part).collect()
    }

    /// Strand indices of a run.
    pub fn strands(&self, run: &Run) -> impl Iterator<Item = usize> {
        self.strands[run.range.clone()].iter().map(|s| s.1 as usize)
    }
}
