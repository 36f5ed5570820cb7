//! Ctrl-C: the run ends after the current frame. A second Ctrl-C ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Installs the handler. From here on an interrupt requests a stop after the current frame.
pub fn listen() {
    let asked_twice = || ASKED.swap(true, Ordering::Relaxed);
    // If the system has no such signal, the run cannot be stopped between frames.
    let _ = ctrlc::set_handler(move || {
        if asked_twice() {
            std::process::exit(130);
        }
    });
}

/// Whether the user has requested a stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
