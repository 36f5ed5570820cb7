//! Which segments may be near each other: a hashed grid of cells, in each the segments whose boxes reach into it.
//!
//! Teschner et al. 2003, *Optimized Spatial Hashing for Collision Detection of Deformable Objects*, with the cells of a bucket kept apart.

use super::{contact::NEAR, hair::Hair};
use glam::{IVec3, Vec3};

/// Cells that a segment's box reaches into, in the mean, at most; cells grow until it is so.
const CELLS_A_SEGMENT: usize = 8;

/// Buckets a segment, before the next power of two.
const BUCKETS_A_SEGMENT: usize = 4;

/// How much cells grow at once, while segments reach into too many [1].
const GROWTH: f32 = 1.25;

/// Most others that a segment is shown. Hair that falls in on itself has some tens that come near; hundreds are in one place, where each is pressed by many as
/// it is.
const MOST_FOUND: usize = 256;

/// Farthest cell that is told from others: 2³⁰ in each direction.
const FARTHEST: f32 = (1 << 30) as f32;

/// A segment with what is around it that counts as near.
#[derive(Clone, Copy)]
struct Boxed {
    segment: u32,
    /// Its box now: lowest and highest corner [m].
    now: [Vec3; 2],
    /// Where its middle goes until the next time [m], and how much more each end does.
    way: Vec3,
    more: f32,
    /// The box that it keeps in until then [m].
    swept: [Vec3; 2],
}

impl Boxed {
    fn new(segment: u32, [a, b]: [Vec3; 2], reach: f32, ways: [Vec3; 2]) -> Self {
        let now = [a.min(b) - reach, a.max(b) + reach];
        let (way, more) = (ways[0].midpoint(ways[1]), 0.5 * ways[0].distance(ways[1]));
        let swept = [now[0] + way.min(Vec3::ZERO) - more, now[1] + way.max(Vec3::ZERO) + more];
        Self { segment, now, way, more, swept }
    }

    /// Whether its box may meet another's until the next time. What goes along with the other comes no nearer to it.
    fn may_meet(&self, other: &Self) -> bool {
        let (way, more) = (self.way - other.way, self.more + other.more);
        let low = self.now[0] + way.min(Vec3::ZERO) - more;
        let high = self.now[1] + way.max(Vec3::ZERO) + more;
        low.cmple(other.now[1]).all() && other.now[0].cmple(high).all()
    }
}

/// The segments, sorted by cells. Memory is as large as it will ever be.
#[derive(Default)]
pub struct Grid {
    /// Edge of a cell [m].
    cell: f32,
    segments: Vec<Boxed>,
    /// First entry of each bucket, and of the first after the last.
    first: Vec<u32>,
    /// Cells and who is in them: places in `segments`.
    entries: Vec<(IVec3, u32)>,
    /// Neighbours of one segment.
    found: Vec<u32>,
    /// Pairs that the last [`Grid::pairs`] looked at.
    pub looked_at: usize,
    /// Segments that had more others near them than are shown.
    pub crowded: usize,
}

impl Grid {
    /// Memory for so many segments.
    pub fn new(segments: usize) -> Self {
        let buckets = (BUCKETS_A_SEGMENT * segments).next_power_of_two();
        Self {
            cell: 0.0,
            segments: Vec::with_capacity(segments),
            first: vec![0; buckets + 1],
            entries: vec![(IVec3::ZERO, 0); CELLS_A_SEGMENT * segments],
            found: Vec::with_capacity(MOST_FOUND),
            looked_at: 0,
            crowded: 0,
        }
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.entries[..])
            + self.segments.capacity() * size_of::<Boxed>()
            + self.found.capacity() * size_of::<u32>()
    }

    /// Sorts segments in, each with its radius and what it may come nearer by in a substep of `h` [s].
    pub fn sort(&mut self, hair: &Hair, h: f32) {
        // What all do alike brings none nearer.
        let count = hair.v.len().max(1) as f64;
        let common = (hair.v.iter().map(|v| v.as_dvec3()).sum::<glam::DVec3>() / count).as_vec3();
        self.sort_by(hair, |segment, ends| {
            let i = segment as usize;
            // Of what it may come nearer by, no more counts than its length: what is faster is not seen to come.
            let length = ends[0].distance(ends[1]);
            let ways = [i, i + 1].map(|i| ((hair.v[i] - common) * h).clamp_length_max(length));
            Boxed::new(segment, ends, (1.0 + NEAR) * hair.radius[i], ways)
        });
    }

    /// Sorts segments in that stay where they are, each with what is nearer than `reach` [m].
    pub fn sort_still(&mut self, hair: &Hair, reach: f32) {
        self.sort_by(hair, |segment, ends| Boxed::new(segment, ends, reach, [Vec3::ZERO; 2]));
    }

    /// Sorts segments in, each with its box.
    fn sort_by(&mut self, hair: &Hair, boxed: impl Fn(u32, [Vec3; 2]) -> Boxed) {
        self.segments.clear();
        // Means of the shortest and the longest edges of boxes.
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
        // As small as boxes are thick, so that what is in one cell is near; but no box is in more than some cells.
        let [shortest, longest] = size.map(|sum| sum / self.segments.len().max(1) as f64);
        self.cell = shortest.max(longest / CELLS_A_SEGMENT as f64).max(1e-9) as f32;
        let most = self.entries.len() as f64;
        while self.segments.iter().map(|of| count(self.cell, &of.swept)).sum::<f64>() > most {
            self.cell *= GROWTH;
        }
        self.fill();
    }

    /// Counts who is in each bucket, and puts them there.
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
        // From the last to the first, so that each bucket is in order; `first` ends where it began.
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

    /// Shows `see` all pairs of segments of different strands whose boxes meet until the next time, the lesser first, in order; of a segment with more than [`MOST_FOUND`] others after
    /// it in order, only so many: they are next to it in the order of strands, or in the same cell.
    pub fn pairs(&mut self, hair: &Hair, mut see: impl FnMut([u32; 2])) {
        let Self { cell, segments, first, entries, found, looked_at, crowded } = self;
        (*looked_at, *crowded) = (0, 0);
        let buckets = first.len() - 1;
        for (k, of) in segments.iter().enumerate() {
            found.clear();
            'cells: for c in cells(*cell, &of.swept) {
                let b = bucket(c, buckets);
                let inside = &entries[first[b] as usize..first[b + 1] as usize];
                // Those after it in order come after it in each bucket.
                let after = inside.partition_point(|(_, other)| *other <= k as u32);
                for (_, other) in inside[after..].iter().filter(|e| e.0 == c) {
                    *looked_at += 1;
                    let other = &segments[*other as usize];
                    // In the one cell in which the boxes' common part begins.
                    let low = of.swept[0].max(other.swept[0]);
                    if low.cmple(of.swept[1].min(other.swept[1])).all()
                        && of.may_meet(other)
                        && cell_of(*cell, low) == c
                        && hair.of[other.segment as usize] != hair.of[of.segment as usize]
                    {
                        if found.len() == MOST_FOUND {
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

/// Cells that a box reaches into.
fn cells(cell: f32, bounds: &[Vec3; 2]) -> impl Iterator<Item = IVec3> + use<> {
    let [low, high] = bounds.map(|b| cell_of(cell, b));
    (low.x..=high.x).flat_map(move |x| {
        (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
    })
}

/// How many they are.
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
    // The low bits of the products are those of the cells; the high ones are mixed.
    ((hash as u32).wrapping_mul(0x9e37_79b1) >> 7) as usize & (buckets - 1)
}
