//! Recovery after a crash: unsaved changes are kept in a file of the user, which the next start offers.
//!
//! A window writes one file for each open scene. While it runs, it locks a second file in the same folder. A file whose
//! lock is free was left by a window that ended before the user decided about the changes.

use crate::{AppError, document::Document};
use hairspring_io::{atomically, text_of};
use serde::{Deserialize, Serialize};
use std::{
    fs::File,
    io,
    path::{Path, PathBuf},
    thread::JoinHandle,
    time::{Duration, Instant, SystemTime},
};

/// Smallest time between two writes [s]: what a crash may lose.
const EVERY: Duration = Duration::from_secs(3);

/// The folder for recovery files, if the system has one for the state of programs.
pub fn recovery_folder() -> Option<PathBuf> {
    Some(dirs::state_dir().or_else(dirs::data_local_dir)?.join("hairspring").join("recovery"))
}

/// A scene with unsaved changes, as it is kept.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptScene {
    /// Path of the scene file. Files that the scene names are relative to its folder.
    pub path: PathBuf,
    /// Content of that file when it was last read or saved; `None` if the scene has no file.
    pub stored: Option<String>,
    /// The text with all changes.
    pub text: String,
}

/// A scene of a window that crashed.
#[derive(Clone, Debug)]
pub struct FoundScene {
    /// The scene.
    pub scene: KeptScene,
    /// Time since it was kept.
    pub age: Duration,
    /// The file that it is kept in.
    file: PathBuf,
}

impl FoundScene {
    /// Removes the file.
    pub fn discard(&self) {
        // If a file cannot be removed, it is offered again at the next start.
        let _ = std::fs::remove_file(&self.file);
        let _ = std::fs::remove_file(self.file.with_extension("lock"));
    }
}

/// Returns the scenes that crashed windows left in a folder, the newest first.
pub fn find(folder: &Path) -> Vec<FoundScene> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let files = entries.flatten().map(|entry| entry.path());
    let mut found: Vec<FoundScene> = files.filter_map(|file| left_by_a_crash(&file)).collect();
    found.sort_by_key(|scene| scene.age);
    found
}

fn left_by_a_crash(file: &Path) -> Option<FoundScene> {
    if file.extension()? != "toml" || is_locked(&file.with_extension("lock")) {
        return None;
    }
    let scene = toml::from_str(&text_of(file).ok()?).ok()?;
    let age = file.metadata().ok()?.modified().ok().and_then(|at| SystemTime::now().duration_since(at).ok());
    Some(FoundScene { scene, age: age.unwrap_or_default(), file: file.to_owned() })
}

/// Whether a running window holds this lock.
fn is_locked(lock: &Path) -> bool {
    File::open(lock).is_ok_and(|file| matches!(file.try_lock(), Err(std::fs::TryLockError::WouldBlock)))
}

/// Keeps the unsaved changes of one scene of a window.
pub struct Recovery {
    file: PathBuf,
    /// Locked while the window runs.
    lock: Option<File>,
    /// The text that was last written, or is being written.
    kept: Option<String>,
    writing: Option<JoinHandle<io::Result<()>>>,
    written: Option<Instant>,
}

impl Recovery {
    /// Reserves a file in a folder, which is created if it does not exist.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written to.
    pub fn new(folder: &Path) -> Result<Self, AppError> {
        Self::reserve(folder).map_err(|why| {
            let folder = folder.display();
            AppError::new(format!("crash recovery is off: cannot write to {folder}: {why}"))
        })
    }

    fn reserve(folder: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        let process = std::process::id();
        for number in 0.. {
            let file = folder.join(format!("scene-{process}-{number}.toml"));
            // Those of an earlier process with the same id are not touched.
            match File::create_new(file.with_extension("lock")) {
                Ok(lock) => {
                    lock.lock()?;
                    let lock = Some(lock);
                    return Ok(Self { file, lock, kept: None, writing: None, written: None });
                }
                Err(why) if why.kind() == io::ErrorKind::AlreadyExists => {}
                Err(why) => return Err(why),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// Writes the document if it has unsaved changes that are not on disk. Pass `None` when the scene is closed. Returns
    /// the delay before the next call, if a write is pending.
    ///
    /// # Errors
    /// Returns an error if the last write failed.
    pub fn keep(&mut self, document: Option<&Document>) -> Result<Option<Duration>, AppError> {
        if self.writing.as_ref().is_some_and(JoinHandle::is_finished) {
            self.finish_write()?;
        }
        let Some(document) = document.filter(|document| document.is_changed()) else {
            if self.kept.is_some() && self.writing.is_none() {
                self.kept = None;
                // A file that stays is overwritten later, or removed at the end.
                let _ = std::fs::remove_file(&self.file);
            }
            return Ok(None);
        };
        if self.kept.as_deref() == Some(document.text()) {
            return Ok(None);
        }
        let wait = self.written.map_or(Duration::ZERO, |at| EVERY.saturating_sub(at.elapsed()));
        if self.writing.is_some() || !wait.is_zero() {
            return Ok(Some(wait.max(Duration::from_millis(50))));
        }
        let scene = document.kept();
        self.kept = Some(scene.text.clone());
        self.written = Some(Instant::now());
        let file = self.file.clone();
        // On a thread, because a full write to the disk may take a moment.
        self.writing = Some(std::thread::spawn(move || {
            let text = toml::to_string(&scene).map_err(io::Error::other)?;
            atomically(&file, |out| out.write_all(text.as_bytes()))
        }));
        Ok(None)
    }

    fn finish_write(&mut self) -> Result<(), AppError> {
        match self.writing.take().map(JoinHandle::join) {
            Some(Ok(Err(why))) => Err(AppError::new(format!(
                "unsaved changes could not be kept for a crash: {}: {why}",
                self.file.display()
            ))),
            _ => Ok(()),
        }
    }
}

impl Drop for Recovery {
    /// Removes the file of a window that its user closed. One that ends by a panic leaves it.
    fn drop(&mut self) {
        // An error no longer matters.
        let _ = self.finish_write();
        self.lock = None;
        if !std::thread::panicking() {
            let _ = std::fs::remove_file(&self.file);
            let _ = std::fs::remove_file(self.file.with_extension("lock"));
        }
    }
}
