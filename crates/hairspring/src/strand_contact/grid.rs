//! Broad phase: a hash grid of cells, each with the segments whose bounding boxes overlap it.
//!
//! Teschner et al. 2003, *Optimized Spatial Hashing for Collision Detection of Deformable Objects*, except
//! that entries keep the cell, so that the cells of a bucket are told apart.

use super::{contact::MAX_NEAR_GAP, hair::Hair};
use glam::{IVec3, Vec3};

/// Largest mean number of cells that a segment's box overlaps. Cells grow until it is met.
const CELLS_A_SEGMENT: usize = 8;

/// Buckets for each segment, before rounding up to a power of two.
const BUCKETS_A_SEGMENT: usize = 4;

/// Smallest cell [m].
const MIN_CELL: f64 = 1e-9;

/// Factor by which cells grow at a time while boxes overlap too many [1].
const CELL_GROWTH: f32 = 1.25;

/// Largest number of pairs for one segment. Collapsed hair has some tens of segments nearby. Hundreds
/// coincide in one place, where each segment is in contact with many anyway.
const MAX_FOUND: usize = 256;

/// Largest cell coordinate, 2³⁰ in each direction. Farther cells are merged.
const FARTHEST: f32 = (1 << 30) as f32;

/// A segment with its bounding boxes, enlarged by the distance that counts as near.
#[derive(Clone, Copy)]
struct Boxed {
    segment: u32,
    /// Current bounding box: lowest and highest corner [m].
    now: [Vec3; 2],
    /// Displacement of its center until the next call [m], and how much farther each end moves.
    way: Vec3,
    more: f32,
    /// Bounding box of its motion until then [m].
    swept: [Vec3; 2],
}

impl Boxed {
    fn new(segment: u32, [a, b]: [Vec3; 2], reach: f32, ways: [Vec3; 2]) -> Self {
        let now = [a.min(b) - reach, a.max(b) + reach];
        let (way, more) = (ways[0].midpoint(ways[1]), 0.5 * ways[0].distance(ways[1]));
        let swept = [now[0] + way.min(Vec3::ZERO) - more, now[1] + way.max(Vec3::ZERO) + more];
        Self { segment, now, way, more, swept }
    }

    /// Returns whether its box may overlap another's before the next call. Common motion of the two cancels.
    fn may_meet(&self, other: &Self) -> bool {
        let (way, more) = (self.way - other.way, self.more + other.more);
        let low = self.now[0] + way.min(Vec3::ZERO) - more;
        let high = self.now[1] + way.max(Vec3::ZERO) + more;
        low.cmple(other.now[1]).all() && other.now[0].cmple(high).all()
    }
}

/// The segments, sorted by cells. All memory is allocated at the start.
#[derive(Default)]
pub struct Grid {
    /// Edge length of a cell [m].
    cell: f32,
    segments: Vec<Boxed>,
    /// First entry of each bucket, and the end of the last.
    first: Vec<u32>,
    /// Cells and the segments in them, as indices in `segments`.
    entries: Vec<(IVec3, u32)>,
    /// Neighbors of one segment.
    found: Vec<u32>,
    /// Number of pairs that the last [`Grid::pairs`] tested.
    pub looked_at: usize,
    /// Number of segments with more than [`MAX_FOUND`] neighbors.
    pub crowded: usize,
}

impl Grid {
    /// Allocates memory for this number of segments.
    pub fn new(segments: usize) -> Self {
        let buckets = (BUCKETS_A_SEGMENT * segments).next_power_of_two();
        Self {
            cell: 0.0,
            segments: Vec::with_capacity(segments),
            first: vec![0; buckets + 1],
            entries: vec![(IVec3::ZERO, 0); CELLS_A_SEGMENT * segments],
            found: Vec::with_capacity(MAX_FOUND),
            looked_at: 0,
            crowded: 0,
        }
    }

    /// Size in memory [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.entries[..])
            + self.segments.capacity() * size_of::<Boxed>()
            + self.found.capacity() * size_of::<u32>()
    }

    /// Sorts the segments into the grid, each enlarged by its radius and its motion in a substep of `h` [s].
    pub fn sort(&mut self, hair: &Hair, h: f32) {
        // Common motion of all points does not change distances.
        let count = hair.v.len().max(1) as f64;
        let common = (hair.v.iter().map(|v| v.as_dvec3()).sum::<glam::DVec3>() / count).as_vec3();
        self.sort_by(hair, |segment, ends| {
            let i = segment as usize;
            // The motion is clamped to the segment's length. Faster segments may be missed.
            let length = ends[0].distance(ends[1]);
            let ways = [i, i + 1].map(|i| ((hair.v[i] - common) * h).clamp_length_max(length));
            Boxed::new(segment, ends, (1.0 + MAX_NEAR_GAP) * hair.radius[i], ways)
        });
    }

    /// Sorts segments at rest into the grid, each enlarged by `reach` [m].
    pub fn sort_still(&mut self, hair: &Hair, reach: f32) {
        self.sort_by(hair, |segment, ends| Boxed::new(segment, ends, reach, [Vec3::ZERO; 2]));
    }

    /// Sorts the segments into the grid by their boxes.
    fn sort_by(&mut self, hair: &Hair, boxed: impl Fn(u32, [Vec3; 2]) -> Boxed) {
        self.segments.clear();
        // Sums of the shortest and the longest edges of the boxes, then their means.
        let mut size = [0.0; 2];
        for segment in hair.segments() {
            let boxed = boxed(segment, hair.ends(segment));
            let edges = boxed.swept[1] - boxed.swept[0];
            if edges.is_finite() {
                size[0] += f64::from(edges.min_element());
                size[1] += f64::from(edges.max_element());
                self.segments.push(boxed);
            }
        }
        // Cells are as small as boxes are thick, so that segments in the same cell are near each other. They
        // are larger where boxes would overlap too many.
        let [shortest, longest] = size.map(|sum| sum / self.segments.len().max(1) as f64);
        self.cell = shortest.max(longest / CELLS_A_SEGMENT as f64).max(MIN_CELL) as f32;
        let most = self.entries.len() as f64;
        while self.segments.iter().map(|of| count(self.cell, &of.swept)).sum::<f64>() > most {
            self.cell *= CELL_GROWTH;
        }
        self.fill();
    }

    /// Counts the entries of each bucket, and stores them.
    fn fill(&mut self) {
        let Self { cell, segments, first, entries, .. } = self;
        let buckets = first.len() - 1;
        first.fill(0);
        for of in segments.iter() {
            cells(*cell, &of.swept).for_each(|c| first[bucket(c, buckets) + 1] += 1);
        }
        for b in 0..buckets {
            first[b + 1] += first[b];
        }
        // Shifts the offsets by one, so that the next loop fills each bucket in order and leaves `first` as
        // it should be.
        for b in (1..=buckets).rev() {
            first[b] = first[b - 1];
        }
        for (k, of) in segments.iter().enumerate() {
            for c in cells(*cell, &of.swept) {
                let at = &mut first[bucket(c, buckets) + 1];
                entries[*at as usize] = (c, k as u32);
                *at += 1;
            }
        }
    }

    /// Calls `see` with each pair of segments of different strands whose boxes may overlap before the next
    /// call. Pairs are sorted, with the lower index first.
    ///
    /// For a segment with more than [`MAX_FOUND`] neighbors after it, only that number is passed: neighbors
    /// from the first cells that the segment overlaps.
    pub fn pairs(&mut self, hair: &Hair, mut see: impl FnMut([u32; 2])) {
        let Self { cell, segments, first, entries, found, looked_at, crowded } = self;
        (*looked_at, *crowded) = (0, 0);
        let buckets = first.len() - 1;
        for (k, of) in segments.iter().enumerate() {
            found.clear();
            'cells: for c in cells(*cell, &of.swept) {
                let b = bucket(c, buckets);
                let inside = &entries[first[b] as usize..first[b + 1] as usize];
                // Entries are sorted in each bucket, so segments with a higher index follow.
                let after = inside.partition_point(|(_, other)| *other <= k as u32);
                for (_, other) in inside[after..].iter().filter(|e| e.0 == c) {
                    *looked_at += 1;
                    let other = &segments[*other as usize];
                    // Only in the cell that contains the lowest corner of the boxes' intersection, so that
                    // each pair is found once.
                    let low = of.swept[0].max(other.swept[0]);
                    if low.cmple(of.swept[1].min(other.swept[1])).all()
                        && of.may_meet(other)
                        && cell_of(*cell, low) == c
                        && hair.of[other.segment as usize] != hair.of[of.segment as usize]
                    {
                        if found.len() == MAX_FOUND {
                            *crowded += 1;
                            break 'cells;
                        }
                        found.push(other.segment);
                    }
                }
            }
            found.sort_unstable();
            found.iter().for_each(|other| see([of.segment, *other]));
        }
    }
}

/// Cells that a box overlaps.
fn cells(cell: f32, bounds: &[Vec3; 2]) -> impl Iterator<Item = IVec3> + use<> {
    let [low, high] = bounds.map(|b| cell_of(cell, b));
    (low.x..=high.x).flat_map(move |x| {
        (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
    })
}

/// Number of cells that a box overlaps.
fn count(cell: f32, bounds: &[Vec3; 2]) -> f64 {
    let [low, high] = bounds.map(|b| cell_of(cell, b));
    (high.as_dvec3() - low.as_dvec3() + 1.0).element_product()
}

fn cell_of(cell: f32, x: Vec3) -> IVec3 {
    (x / cell).floor().clamp(Vec3::splat(-FARTHEST), Vec3::splat(FARTHEST)).as_ivec3()
}

fn bucket(c: IVec3, buckets: usize) -> usize {
    let hash =
        (c.x.wrapping_mul(73_856_093)) ^ (c.y.wrapping_mul(19_349_663)) ^ (c.z.wrapping_mul(83_492_791));
    // The low bits of the products depend on the low bits of the cells only; the high bits are mixed.
    ((hash as u32).wrapping_mul(0x9e37_79b1) >> 7) as usize & (buckets - 1)
}
