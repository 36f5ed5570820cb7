//! Ctrl-C: the frame in hand is completed, then the run ends; a second Ctrl-C ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on an interrupt is a wish to stop after the current frame.
pub fn listen() {
    let asked_twice = || ASKED.swap(true, Ordering::Relaxed);
    // Where the system has no such signal, the run just cannot be stopped between frames.
    let _ = ctrlc::set_handler(move || {
        if asked_twice() {
            std::process::exit(130);
        }
    });
}

/// Whether the user asked to stop.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
