//! Which segments may be near each other: a hashed grid of cells, in each the segments whose boxes reach into it.
//!
//! Teschner et al. 2003, *Optimized Spatial Hashing for Collision Detection of Deformable Objects*, with the cells of a bucket kept apart.

use super::{contact::NEAR, hair::Hair};
use glam::{IVec3, Vec3};

/// Cells that a segment's box reaches into, in the mean, at most; cells grow until it is so.
const CELLS_A_SEGMENT: usize = 8;

/// Buckets a segment, before the next power of two.
const BUCKETS_A_SEGMENT: usize = 4;

/// Edge of a cell, over the mean of the boxes' longest edges [1].
const CELL: f32 = 1.5;

/// Farthest cell that is told from others: 2³⁰ in each direction.
const FARTHEST: f32 = (1 << 30) as f32;

/// The segments, sorted by cells. Memory is as large as it will ever be.
#[derive(Default)]
pub struct Grid {
    /// Edge of a cell [m].
    cell: f32,
    /// The segments, and the box that each keeps in until the next time [m].
    segments: Vec<(u32, [Vec3; 2])>,
    /// First entry of each bucket, and of the first after the last.
    first: Vec<u32>,
    /// Cells and who is in them: places in `segments`.
    entries: Vec<(IVec3, u32)>,
    /// Neighbours of one segment.
    found: Vec<u32>,
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
            found: Vec::with_capacity(segments),
        }
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.first[..])
            + size_of_val(&self.entries[..])
            + self.segments.capacity() * size_of::<(u32, [Vec3; 2])>()
            + self.found.capacity() * size_of::<u32>()
    }

    /// Sorts segments in, each with its radius and what it may come nearer by in a substep of `h` [s].
    pub fn sort(&mut self, hair: &Hair, h: f32) {
        // What all do alike brings none nearer.
        let count = hair.v.len().max(1) as f64;
        let common = (hair.v.iter().map(|v| v.as_dvec3()).sum::<glam::DVec3>() / count).as_vec3();
        self.sort_by(hair, |segment, ends| {
            let i = segment as usize;
            let speed = [hair.v[i], hair.v[i + 1]].map(|v| v.distance(common));
            reach(hair.radius[i], ends[0].distance(ends[1]), h * speed[0].max(speed[1]))
        });
    }

    /// Sorts segments in, each with `around` it [m].
    pub fn sort_by(&mut self, hair: &Hair, around: impl Fn(u32, [Vec3; 2]) -> f32) {
        self.segments.clear();
        let mut size = 0.0;
        for segment in hair.segments() {
            let ends = hair.ends(segment);
            let margin = around(segment, ends);
            let (low, high) = (ends[0].min(ends[1]) - margin, ends[0].max(ends[1]) + margin);
            if low.is_finite() && high.is_finite() {
                size += f64::from((high - low).max_element());
                self.segments.push((segment, [low, high]));
            }
        }
        self.cell = (CELL * (size / self.segments.len().max(1) as f64) as f32).max(1e-9);
        let most = self.entries.len() as f64;
        while self.segments.iter().map(|(_, bounds)| count(self.cell, bounds)).sum::<f64>() > most {
            self.cell *= CELL;
        }
        self.fill();
    }

    /// Counts who is in each bucket, and puts them there.
    fn fill(&mut self) {
        let Self { cell, segments, first, entries, .. } = self;
        let buckets = first.len() - 1;
        first.fill(0);
        for (_, bounds) in segments.iter() {
            cells(*cell, bounds).for_each(|c| first[bucket(c, buckets) + 1] += 1);
        }
        for b in 0..buckets {
            first[b + 1] += first[b];
        }
        // From the last to the first, so that each bucket is in order; `first` ends where it began.
        for b in (1..=buckets).rev() {
            first[b] = first[b - 1];
        }
        for (k, (_, bounds)) in segments.iter().enumerate() {
            for c in cells(*cell, bounds) {
                let at = &mut first[bucket(c, buckets) + 1];
                entries[*at as usize] = (c, k as u32);
                *at += 1;
            }
        }
    }

    /// Shows `see` all pairs of segments of different strands whose boxes meet, the lesser first, in order.
    pub fn pairs(&mut self, hair: &Hair, mut see: impl FnMut([u32; 2])) {
        let Self { cell, segments, first, entries, found } = self;
        let buckets = first.len() - 1;
        for (k, (segment, bounds)) in segments.iter().enumerate() {
            found.clear();
            for c in cells(*cell, bounds) {
                let b = bucket(c, buckets);
                let inside = &entries[first[b] as usize..first[b + 1] as usize];
                // Those after it in order come last in each bucket.
                for (_, other) in inside.iter().rev().take_while(|(_, o)| *o > k as u32).filter(|e| e.0 == c)
                {
                    let (other, with) = segments[*other as usize];
                    // In the one cell in which the boxes' common part begins.
                    let low = bounds[0].max(with[0]);
                    if low.cmple(bounds[1].min(with[1])).all()
                        && cell_of(*cell, low) == c
                        && hair.of[other as usize] != hair.of[*segment as usize]
                    {
                        found.push(other);
                    }
                }
            }
            found.sort_unstable();
            found.iter().for_each(|other| see([*segment, *other]));
        }
    }
}

/// How far around itself a segment looks for others [m]: what counts as near, and what it may come nearer by, of which no more counts than its
/// length: what is faster is not seen to come.
fn reach(radius: f32, length: f32, way: f32) -> f32 {
    (1.0 + NEAR) * radius + way.min(length)
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
