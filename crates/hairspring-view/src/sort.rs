//! Lazy sorting by depth. Entries are distributed into buckets by depth, and a bucket is sorted only when it
//! is needed. On a full head, most buckets of a tile are behind opaque hair and are never needed.

use crate::hair::ribbon::Entry;

/// Maximum number of buckets of a tile: a few dozen entries in each.
const BUCKETS: usize = 512;

/// One tile's entries.
#[derive(Default)]
pub(crate) struct Buckets {
    entries: Vec<Entry>,
    /// First entry of each bucket, and the end of the last.
    starts: Vec<u32>,
    /// Number of buckets that were returned.
    taken: usize,
    /// Depth at which the first bucket begins, and the base-2 logarithm of the depth of a bucket.
    low: u32,
    shift: u32,
}

impl Buckets {
    /// Loads a tile's entries.
    pub fn fill<'a>(&mut self, parts: impl Iterator<Item = &'a [Entry]> + Clone) {
        self.starts.clear();
        self.entries.clear();
        self.taken = 0;
        let (mut low, mut high, mut count) = (u32::MAX, 0, 0);
        for part in parts.clone() {
            part.iter().for_each(|e| (low, high) = (low.min(e.depth()), high.max(e.depth())));
            count += part.len();
        }
        if count == 0 {
            return;
        }
        // The depth range of the tile is divided evenly, by a shift.
        let shift = ((high - low) / BUCKETS as u32 + 1).next_power_of_two().ilog2();
        (self.low, self.shift) = (low, shift);
        let bucket = |e: &Entry| ((e.depth() - low) >> shift) as usize;
        // One extra element at the front: filling advances each start to the end of its bucket, where the
        // next one starts.
        self.starts.resize(((high - low) >> shift) as usize + 3, 0);
        parts.clone().flatten().for_each(|e| self.starts[bucket(e) + 2] += 1);
        (2..self.starts.len()).for_each(|i| self.starts[i] += self.starts[i - 1]);
        self.entries.resize(count, Entry::default());
        for e in parts.flatten() {
            let place = &mut self.starts[bucket(e) + 1];
            self.entries[*place as usize] = *e;
            *place += 1;
        }
        self.starts.pop();
    }

    /// Returns the next bucket, in order of depth: the minimum depth that it can hold, and its entries,
    /// unsorted. `None` after the last one.
    #[inline(always)]
    pub fn next(&mut self) -> Option<(u32, &[Entry])> {
        let ends = self.starts.get(self.taken..self.taken + 2)?;
        let depth = self.low + ((self.taken as u32) << self.shift);
        self.taken += 1;
        Some((depth, &self.entries[ends[0] as usize..ends[1] as usize]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_follow_one_another_in_depth() {
        for (n, range) in [(0u64, 1), (1, 1), (255, 65536), (5000, 65536), (5000, 700), (300, 1)] {
            let mut state = 7u64;
            let mut next = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                state >> 33
            };
            let entries: Vec<Entry> = (0..n).map(|i| Entry((next() % range) << 48 | i)).collect();
            let mut buckets = Buckets::default();
            let mut out = Vec::new();
            for _ in 0..2 {
                buckets.fill(entries.chunks(100));
                out.clear();
                while let Some((depth, bucket)) = buckets.next() {
                    assert!(bucket.iter().all(|e| e.depth() >= depth));
                    out.extend_from_slice(bucket);
                    let first = out.len() - bucket.len();
                    out[first..].sort_unstable();
                }
            }
            let mut sorted = entries.clone();
            sorted.sort();
            assert_eq!(out, sorted);
        }
    }
}
