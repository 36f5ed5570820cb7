//! Reads a scene again on its own thread after its hair, body or motion was edited. The window continues to
//! show the previous scene.

use crate::{AppError, document::Document};
use hairspring_io::Loaded;
use hairspring_scene::Scene;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// The scene, and the one that it is compared with.
pub type Read = (Loaded<Scene>, Option<Loaded<Scene>>);

/// Both scenes, or an error.
pub type Outcome = Result<Read, AppError>;

/// Reads both on the calling thread.
pub fn both(document: &Document, second: Option<&Document>) -> Outcome {
    Ok((document.load()?, second.map(Document::load).transpose()?))
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
            let read = || -> Outcome { Ok((first.load()?, second.map(|s| s.load()).transpose()?)) };
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
                "the scene could not be read: its reader ended by an error of its own",
            ))),
        }
    }
}
