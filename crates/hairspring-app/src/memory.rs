//! Returns unused memory to the system.
//!
//! The C library of Linux keeps freed memory. Each thread has its own arena, and a hole in one arena, however
//! large, cannot be used by another. After several scenes, a window would hold three times the memory that it
//! needs.

/// Arrays of at least this size are allocated as separate pages: 4 MiB. Smaller ones are allocated for every
/// picture, and mapping new pages each time would be slow.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const PAGES: i32 = 4 << 20;

/// From now on, large allocations are returned to the system as soon as they are freed.
pub fn keep_little() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: `mallopt` may be called from any thread at any time; it sets a number. By default the number
    // grows with the size of freed blocks, up to 32 MiB.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, PAGES);
    }
}

/// Returns freed memory to the system.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: `malloc_trim` may be called from any thread at any time. It takes each arena's lock, and does not
    // touch memory in use.
    unsafe {
        libc::malloc_trim(0);
    }
}
