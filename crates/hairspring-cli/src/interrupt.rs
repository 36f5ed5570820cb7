//! Ctrl-C, SIGTERM and SIGHUP end a run with [`CODE`]. No partial file is left, neither under its final name
//! nor under a temporary one.
//!
//! By default a signal ends the program immediately. A command that keeps its finished frames calls [`finish_current`].
//! After that call the first signal ends it after the current frame, and the second one ends it immediately. Signals
//! within [`ONE`] count as one: `timeout` and some job managers send one to the process and one to its group.

use crate::console;
use std::{
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

/// Exit code of an interrupted run.
pub const CODE: u8 = 130;

/// Longest time between signals that count as one.
const ONE: Duration = Duration::from_millis(200);

static STOP_REQUESTED: AtomicBool = AtomicBool::new(false);

/// What the first signal waits for.
static CURRENT: Mutex<Option<&'static str>> = Mutex::new(None);

/// Makes a write beyond the limit for the size of files (`ulimit -f`) an error, as on a full disk, instead of the end
/// of the process.
fn report_file_size_limit() {
    #[cfg(unix)]
    // SAFETY: ignores a signal. No handler runs, and no other code depends on its disposition.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

/// Installs the handler. From here on a signal ends the program immediately. `quiet`: no note after the first
/// signal of a run that waits for its frame.
pub fn install_handler(quiet: bool) {
    report_file_size_limit();
    // If the system has no such signal, the run can only be killed.
    let mut first: Option<Instant> = None;
    let _ = ctrlc::set_handler(move || {
        // The lock is held until the exit, so that the run does not begin to write frames meanwhile.
        let current = CURRENT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(what) = *current
            && first.is_none_or(|at| at.elapsed() < ONE)
        {
            first.get_or_insert_with(Instant::now);
            if STOP_REQUESTED.swap(true, Ordering::Relaxed) {
                return;
            }
            if !quiet {
                console::note(format_args!("stopping after {what}; a second interrupt stops immediately"));
            }
            return;
        }
        hairspring_file::remove_pending_files();
        match *current {
            Some(what) => console::print_error(&format_args!(
                "interrupted before the end of {what}; no partial file is left"
            )),
            None => console::print_error(&"interrupted; no partial file is left"),
        }
        std::process::exit(CODE.into());
    });
}

/// From here on the first signal requests a stop after `what`, such as `the current frame`.
pub fn finish_current(what: &'static str) {
    *CURRENT.lock().unwrap_or_else(PoisonError::into_inner) = Some(what);
}

/// Whether the user has requested a stop.
pub fn stop_requested() -> bool {
    STOP_REQUESTED.load(Ordering::Relaxed)
}
