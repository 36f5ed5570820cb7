//! Reports the files that are read, so that a program can tell later whether one of them has changed.

use std::{cell::RefCell, path::Path};

type Observer = Box<dyn FnMut(&Path, &[u8])>;

thread_local! {
    static OBSERVER: RefCell<Option<Observer>> = const { RefCell::new(None) };
}

/// Calls `read`, and calls `observe` with the path and the content of each file that it reads on this thread.
/// A file that is read twice is reported twice.
pub fn observe_files<T>(observe: impl FnMut(&Path, &[u8]) + 'static, read: impl FnOnce() -> T) -> T {
    /// Restores the former observer, also after a panic.
    struct Restore(Option<Observer>);
    impl Drop for Restore {
        fn drop(&mut self) {
            OBSERVER.set(self.0.take());
        }
    }
    let _restore = Restore(OBSERVER.replace(Some(Box::new(observe))));
    read()
}

/// Reports a file that was read.
pub(crate) fn report(path: &Path, content: &[u8]) {
    // The observer is taken out, so that it may read files itself.
    if let Some(mut observer) = OBSERVER.take() {
        observer(path, content);
        OBSERVER.set(Some(observer));
    }
}
