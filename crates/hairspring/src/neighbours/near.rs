//! Which segments are near each other: segments lie in the cells of a hashed grid by their middles, sorted by counting, anew each frame.
//!
//! ```text
//! cell = longest segment + how near      two segments that are so near lie in cells that touch
//! ```
//!
//! After Teschner et al. 2003, *Optimized Spatial Hashing for Collision Detection of Deformable Objects*. Only the order of the segments counts,
//! so that pairs are found in the same order on any number of threads.

use glam::{IVec3, Vec3};

/// Segments in cells.
#[derive(Default)]
pub struct Near {
    /// Where each bucket's entries begin, and the end.
    begins: Vec<u32>,
    entries: Vec<Entry>,
    cell: f32,
}

/// A segment in the grid.
#[derive(Clone, Copy, Default)]
struct Entry {
    cell: IVec3,
    segment: u32,
    middle: Vec3,
}

impl Near {
    /// Memory for `segments`.
    pub fn reserve(&mut self, segments: usize) {
        self.begins.reserve((2 * segments).next_power_of_two() + 2);
        self.entries.reserve(segments);
    }

    /// Sorts segments in, by their middles [m], which are finite; `cell` [m] is above 0.
    pub fn sort(&mut self, cell: f32, middles: impl Iterator<Item = (u32, Vec3)> + Clone) {
        self.cell = cell;
        let count = middles.clone().count();
        let buckets = (2 * count).next_power_of_two();
        self.begins.clear();
        self.begins.resize(buckets + 1, 0);
        self.entries.clear();
        self.entries.resize(count, Entry::default());
        for (_, at) in middles.clone() {
            let at = bucket(self.cell_of(at), buckets);
            self.begins[at] += 1;
        }
        let mut sum = 0;
        for begin in &mut self.begins {
            sum += *begin;
            *begin = sum;
        }
        // From its end each bucket is filled to its begin.
        for (segment, at) in middles {
            let cell = self.cell_of(at);
            let end = &mut self.begins[bucket(cell, buckets)];
            *end -= 1;
            self.entries[*end as usize] = Entry { cell, segment, middle: at };
        }
    }

    /// Shows `see` every segment whose middle is no farther from `at` than a cell is long.
    pub fn around(&self, from: Vec3, mut see: impl FnMut(u32)) {
        let (cell, buckets) = (self.cell_of(from), self.begins.len().saturating_sub(1));
        if self.entries.is_empty() {
            return;
        }
        for k in 0..27 {
            let there = cell.wrapping_add(IVec3::new(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
            let at = bucket(there, buckets);
            let entries = &self.entries[self.begins[at] as usize..self.begins[at + 1] as usize];
            // Cells share buckets.
            for entry in entries.iter().filter(|e| e.cell == there) {
                if entry.middle.distance_squared(from) <= self.cell * self.cell {
                    see(entry.segment);
                }
            }
        }
    }

    fn cell_of(&self, at: Vec3) -> IVec3 {
        (at / self.cell).floor().as_ivec3()
    }
}

/// The bucket of a cell, of a power of two: three large primes (Teschner 2003, §4.1), folded.
fn bucket(cell: IVec3, buckets: usize) -> usize {
    let [x, y, z] = cell.to_array().map(|k| k as u32);
    let hash = x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791);
    ((hash ^ hash >> 16) as usize) & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_near_segment_is_found_once() {
        let at = |k: u32| {
            let x = |m: u32| (f64::from(k * 5 + m) * 0.754_877_666_246_692_7).fract() as f32 - 0.5;
            Vec3::new(x(0), x(1) * 3.0, x(2) * 0.2)
        };
        let mut near = Near::default();
        near.sort(0.1, (0..400).map(|k| (k, at(k))));
        for k in 0..400 {
            let mut seen = Vec::new();
            near.around(at(k), |s| seen.push(s));
            seen.sort_unstable();
            let once = seen.windows(2).all(|w| w[0] != w[1]);
            let all = (0..400).filter(|m| at(*m).distance(at(k)) < 0.1).all(|m| seen.contains(&m));
            assert!(once && all, "{k}: {seen:?}");
        }
    }
}
