//! Asks for the next tile's memory while this one is worked on: a tile is read but once an interval, and at each the processor's own
//! foresight would begin anew.

/// Asks for the `line`th cache line of what corresponds to `rows[i]` in the tile after: the arrays hold tile after tile. Lines are counted
/// round and round: to ask again costs less than to see that there is nothing to ask for. A little at every point; all at once would wait for
/// memory as much as no asking does.
#[inline(always)]
pub fn prefetch_next_tile<T>(rows: &[T], i: usize, line: usize) {
    const LINE: usize = 64;
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        let line = line % size_of::<T>().div_ceil(LINE);
        let point = rows.as_ptr_range().end.cast::<i8>().wrapping_add(line * LINE + i * size_of::<T>());
        // SAFETY: a hint, which reads nothing and faults on no address; the pointer is made without a claim that it points at anything.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(point) }
    }
}
