//! Memory that nobody needs any more goes back to the system.
//!
//! The C library of Linux keeps what is freed: each thread fills an arena of its own, and a hole in one, however large, is of use to no other. Scene after scene, a
//! window would hold three times what it needs.

/// Arrays of so many bytes and more are pages of their own: 4 MiB. Smaller ones come and go with every picture, and would cost a new page each time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const PAGES: i32 = 4 << 20;

/// What is large goes back as soon as it is freed, from now on.
pub fn keep_little() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: any thread may call it at any time; it sets a number. Else the number grows with what is freed, up to 32 MiB.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, PAGES);
    }
}

/// Gives back what has been freed.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: any thread may call it at any time; it takes each arena's lock, and leaves alone what is in use.
    unsafe {
        libc::malloc_trim(0);
    }
}
