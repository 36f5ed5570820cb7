//! A run that needs more memory than there is ends with a sentence and [`CODE`], and leaves no partial file.
//!
//! Rust aborts when an allocation fails. [`Watched`] is the system's allocator, which also remembers that one did; the
//! handler of the abort then reports it.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::atomic::{AtomicBool, Ordering},
};

/// Exit code of a run without enough memory.
pub const CODE: u8 = 8;

/// Whether an allocation has failed.
static FAILED: AtomicBool = AtomicBool::new(false);

/// The system's allocator.
pub struct Watched;

fn watched(memory: *mut u8) -> *mut u8 {
    if memory.is_null() {
        FAILED.store(true, Ordering::Relaxed);
    }
    memory
}

// SAFETY: every method passes its arguments on to the system's allocator and returns what that returns.
unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as this method's own contract.
        watched(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as this method's own contract.
        watched(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as this method's own contract.
        watched(unsafe { System.realloc(memory, layout, size) })
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as this method's own contract.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Installs the handler. Where the system has no such signal, a run without memory ends with Rust's own message.
pub fn report() {
    #[cfg(unix)]
    {
        let handler = || {
            if !FAILED.load(Ordering::Relaxed) {
                return;
            }
            hairspring_file::remove_pending_files();
            crate::console::print_error(
                &"out of memory: use fewer strands or points, or free memory; no partial file is left",
            );
            std::process::exit(CODE.into());
        };
        // SAFETY: the only abort after a failed allocation is that of the thread that requested it, in the middle of no
        // other call of the allocator or of a file's lock: the handler runs as a function that this thread calls. After
        // any other abort it does nothing.
        let installed = unsafe { signal_hook_registry::register(libc::SIGABRT, handler) };
        let _ = installed;
    }
}
