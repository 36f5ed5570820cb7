//! Errors of reading and writing files, each described in one sentence.

use crate::text::printable;
use std::{
    fmt, io,
    path::{Path, PathBuf},
};

/// The result of reading or writing a file.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file could not be read or written. Its text is one sentence that names the file, the place in it,
/// what was expected and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file does not exist.
    #[error("{path} was not found{why}", path = shown(path), why = printable(why))]
    NotFound {
        /// The path that was looked for.
        path: PathBuf,
        /// What refers to the file (`"; scene.toml, line 3, names it as the groom"`), or empty.
        why: String,
    },
    /// The file exists, but the system could not read it.
    #[error("{path} could not be read: {source}", path = shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The content of the file violates its format.
    #[error("{path}{between}{problem}", path = shown(path), between = problem.between())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        problem: Problem,
    },
    /// The file exceeds one of the reader's limits.
    #[error("{path}{between}{problem}", path = shown(path), between = problem.between())]
    Limit {
        /// The file.
        path: PathBuf,
        /// Which limit, and where.
        problem: Problem,
    },
    /// There is no reader or writer for this extension, or none for this purpose.
    #[error("{path}: {reason}", path = shown(path), reason = printable(reason))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Which formats are supported instead.
        reason: String,
    },
    /// The format cannot hold the data that was to be written.
    #[error("{path} cannot be written: {reason}", path = shown(path), reason = printable(reason))]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What does not fit, and what to do.
        reason: String,
    },
    /// The system could not write the file. No partial file is left.
    #[error("{path} could not be written: {source}", path = shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// Returns a path for a message, without characters that control a terminal.
fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

/// The category of an [`Error`], for exit codes and retries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// The file does not exist.
    NotFound,
    /// The file cannot be opened or read.
    Unreadable,
    /// The file's content is wrong.
    Malformed,
    /// The file is larger than the limits.
    Limit,
    /// The kind of file is unknown, or it cannot hold the data.
    Unsupported,
    /// The file could not be written.
    Write,
}

impl Error {
    /// Returns the category of the error.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Self::NotFound { .. } => ErrorKind::NotFound,
            Self::Unreadable { .. } => ErrorKind::Unreadable,
            Self::Malformed { .. } => ErrorKind::Malformed,
            Self::Limit { .. } => ErrorKind::Limit,
            Self::Unsupported { .. } | Self::Unwritable { .. } => ErrorKind::Unsupported,
            Self::Write { .. } => ErrorKind::Write,
        }
    }

    /// Returns the path of the file that the error is about.
    pub fn path(&self) -> &Path {
        match self {
            Self::NotFound { path, .. }
            | Self::Unreadable { path, .. }
            | Self::Malformed { path, .. }
            | Self::Limit { path, .. }
            | Self::Unsupported { path, .. }
            | Self::Unwritable { path, .. }
            | Self::Write { path, .. } => path,
        }
    }
}

/// A position in a file where something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Offset from the file's start [bytes].
    Byte(usize),
    /// Line, counted from 1.
    Line(usize),
    /// The file as a whole.
    Whole,
}

/// What a reader found wrong in a file's bytes. It does not know the file's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where the problem is.
    pub place: Place,
    /// What was expected, what was found, and what to do.
    pub text: String,
    /// Whether a limit was exceeded, rather than the format violated.
    pub limit: bool,
    /// Name of a file in the folder of this one, or below, that could not be read.
    pub missing: Option<String>,
}

impl Problem {
    /// Creates a violation of the format at `place`.
    pub(crate) fn new(place: Place, text: impl Into<String>) -> Self {
        Self { place, text: text.into(), limit: false, missing: None }
    }

    /// Creates a violation of the format in line `line`, counted from 1.
    pub(crate) fn line(line: usize, text: impl Into<String>) -> Self {
        Self::new(Place::Line(line), text)
    }

    /// Creates a violation of the format that has no single place.
    pub(crate) fn whole(text: impl Into<String>) -> Self {
        Self::new(Place::Whole, text)
    }

    /// Creates a problem for data that exceeds a limit of the reader.
    pub(crate) fn limit(place: Place, text: impl Into<String>) -> Self {
        Self { limit: true, ..Self::new(place, text) }
    }

    /// Creates a problem for the file `name`, relative to the folder of this one, that could not be read.
    pub(crate) fn missing(name: &str) -> Self {
        let text = format!("its buffer {name:?} was not found next to it, or is no file that can be read");
        Self { missing: Some(name.into()), ..Self::whole(text) }
    }

    /// The separator between a file's name and the problem. A place continues the name; a sentence does not.
    fn between(&self) -> &'static str {
        if self.place == Place::Whole { ": " } else { ", " }
    }

    /// Converts the problem into an error about the file at `path`.
    pub fn in_file(self, path: &Path) -> Error {
        let missing = self.missing.as_ref().map(|name| path.with_file_name(name));
        if let Some(missing) = missing.filter(|missing| !missing.exists()) {
            let why = format!("; {} names it as a buffer", path.display());
            return Error::NotFound { path: missing, why };
        }
        let path = path.to_owned();
        if self.limit {
            Error::Limit { path, problem: self }
        } else {
            Error::Malformed { path, problem: self }
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = printable(&self.text);
        match self.place {
            Place::Byte(at) => write!(f, "byte {at}: {text}"),
            Place::Line(line) => write!(f, "line {line}: {text}"),
            Place::Whole => f.write_str(&text),
        }
    }
}

impl std::error::Error for Problem {}
