//! Depth order: a stable radix sort of packed keys.

const BITS: u32 = 11;
const BUCKETS: usize = 1 << BITS;
/// Bits of the key that are sorted by, from the top of the word: two rounds.
pub(crate) const KEY_BITS: u32 = 2 * BITS;

/// Sorts by the highest [`KEY_BITS`] bits; equal keys keep their order. `scratch` is memory to reuse.
pub(crate) fn sort(entries: &mut Vec<u64>, scratch: &mut Vec<u64>) {
    if entries.len() < 256 {
        // The low bits grow with the order of arrival, so a full sort is stable too.
        entries.sort_unstable();
        return;
    }
    scratch.resize(entries.len(), 0);
    for shift in [64 - KEY_BITS, 64 - BITS] {
        let mut next = [0u32; BUCKETS];
        let bucket = |e: u64| (e >> shift) as usize & (BUCKETS - 1);
        entries.iter().for_each(|e| next[bucket(*e)] += 1);
        let mut sum = 0;
        for n in &mut next {
            sum += std::mem::replace(n, sum);
        }
        for e in entries.iter() {
            let place = &mut next[bucket(*e)];
            scratch[*place as usize] = *e;
            *place += 1;
        }
        std::mem::swap(entries, scratch);
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn radix_order_is_full_order() {
        for n in [0u64, 1, 255, 256, 5000] {
            let mut state = 7u64;
            let mut next = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                state
            };
            let mut entries: Vec<u64> = (0..n).map(|i| (next() >> 42 << 42) | i).collect();
            let mut sorted = entries.clone();
            sorted.sort();
            super::sort(&mut entries, &mut Vec::new());
            assert_eq!(entries, sorted);
        }
    }
}
