//! A scene that is read again on a thread of its own after an edit of its hair, body or motion: the window goes on meanwhile, and shows the one before.

use crate::{AppError, document::Document};
use hairspring_io::Loaded;
use hairspring_scene::Scene;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// The scene, and the one that is compared with it.
pub type Read = (Loaded<Scene>, Option<Loaded<Scene>>);

/// Both, or why not.
pub type Outcome = Result<Read, AppError>;

/// Reads both where it is called.
pub fn both(document: &Document, second: Option<&Document>) -> Outcome {
    Ok((document.load()?, second.map(Document::load).transpose()?))
}

/// What is being read.
pub struct Reading {
    outcome: Receiver<Outcome>,
    /// Whether the text has changed since, so that what comes of it is not wanted.
    pub stale: bool,
}

impl Reading {
    /// Begins, with so many threads; `wake` is called at the end.
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
            // A pool of its own: the picture is drawn by that of all.
            let outcome = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(read),
                Err(_) => read(),
            };
            // The window may have closed meanwhile.
            let _ = send.send(outcome);
            wake();
        });
        Self { outcome, stale: false }
    }

    /// What came of it; `None`: not yet.
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
