//! Reads a scene again on its own thread after its hair, body or motion was edited. The window continues to
//! show the previous scene.

use crate::{
    AppError,
    document::{Document, Source},
};
use hairspring_io::{Loaded, observe_files};
use hairspring_scene::Scene;
use std::{
    cell::RefCell,
    path::{Path, PathBuf},
    rc::Rc,
    sync::mpsc::{Receiver, TryRecvError, channel},
};

/// Scenes that were read.
pub struct Read {
    /// The scene.
    pub first: Loaded<Scene>,
    /// The one that it is compared with.
    pub second: Option<Loaded<Scene>>,
    /// The files that they name.
    pub files: Vec<PathBuf>,
}

/// Both scenes, or an error.
pub type Outcome = Result<Read, AppError>;

/// Reads both on the calling thread.
pub fn both(first: &Source, second: Option<&Source>) -> Outcome {
    let files = Rc::<RefCell<Vec<PathBuf>>>::default();
    let list = files.clone();
    let observe = move |path: &Path, _: &[u8]| list.borrow_mut().push(path.to_owned());
    let read = || Ok::<_, AppError>((first.load()?, second.map(Source::load).transpose()?));
    let (first, second) = observe_files(observe, read)?;
    Ok(Read { first, second, files: files.take() })
}

/// A read in progress.
pub struct Reading {
    outcome: Receiver<Outcome>,
    /// Whether the text has changed since, so that the result is not needed.
    pub stale: bool,
}

impl Reading {
    /// Starts reading with `threads` threads; `wake` is called at the end.
    pub fn new(
        document: &Document,
        second: Option<&Document>,
        threads: usize,
        wake: impl FnOnce() + Send + 'static,
    ) -> Self {
        let (send, outcome) = channel();
        let (first, second) = (document.source(), second.map(Document::source));
        std::thread::spawn(move || {
            let read = || both(&first, second.as_ref());
            // A separate pool, because the global one draws the picture.
            let outcome = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(read),
                Err(_) => read(),
            };
            // The window may have been closed in the meantime.
            let _ = send.send(outcome);
            wake();
        });
        Self { outcome, stale: false }
    }

    /// The result; `None` if it is not finished yet.
    pub fn outcome(&self) -> Option<Outcome> {
        match self.outcome.try_recv() {
            Ok(outcome) => Some(outcome),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(AppError::new(
                "the scene could not be read: the reader failed with an internal error",
            ))),
        }
    }
}
