//! Software prefetch of the next tile while the current one is solved. A tile is read only once a frame, so
//! the hardware prefetcher would have to start anew for each.

/// Prefetches the `line`th cache line of the next tile's counterpart of `rows[i]`; the arrays are contiguous
/// over tiles. `line` wraps around, because a redundant prefetch costs less than a test. Prefetches are
/// spread over the points: issued all at once, they would stall on memory as if there were none.
#[inline(always)]
pub fn prefetch_next_tile<T>(rows: &[T], i: usize, line: usize) {
    const LINE: usize = 64;
    #[cfg(all(target_arch = "x86_64", not(miri)))]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        let line = line % size_of::<T>().div_ceil(LINE);
        let point = rows.as_ptr_range().end.cast::<i8>().wrapping_add(line * LINE + i * size_of::<T>());
        // SAFETY: a prefetch hint does not read memory and never faults, whatever the address. The pointer is
        // computed by wrapping arithmetic and is not dereferenced.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(point) }
    }
}
