//! What can go wrong with a file, said in one sentence.

use std::{
    fmt, io,
    path::{Path, PathBuf},
};

/// The result of reading or writing a file.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file could not be read or written. Its text is one sentence: which file, where in it, what was
/// expected and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is no such file.
    #[error("{path} was not found{why}", path = path.display())]
    NotFound {
        /// The file looked for.
        path: PathBuf,
        /// Who asked for it (`": the groom named in scene.toml, line 3"`), or nothing.
        why: String,
    },
    /// The file is there but the system would not give its bytes.
    #[error("{path} could not be read: {source}", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is not what its format asks for.
    #[error("{path}{between}{problem}", path = path.display(), between = problem.between())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        problem: Problem,
    },
    /// The file asks for more than the reader's limits.
    #[error("{path}{between}{problem}", path = path.display(), between = problem.between())]
    Limit {
        /// The file.
        path: PathBuf,
        /// Which limit, and where.
        problem: Problem,
    },
    /// No reader or writer for this extension, or none for this purpose.
    #[error("{path}: {reason}", path = path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What is known instead.
        reason: String,
    },
    /// The format can not hold what was to be written.
    #[error("{path} can not be written: {reason}", path = path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What does not fit, and what to do.
        reason: String,
    },
    /// The system would not take the bytes; nothing is left half-written.
    #[error("{path} could not be written: {source}", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// What an [`Error`] is, for exit codes and retries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// A file that is not there.
    NotFound,
    /// A file that can not be opened or read.
    Unreadable,
    /// A file whose content is wrong.
    Malformed,
    /// A file larger than the limits.
    Limit,
    /// A kind of file that is not known, or one that can not hold the data.
    Unsupported,
    /// A file that could not be written.
    Write,
}

impl Error {
    /// What kind of error it is.
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

    /// The file that it is about.
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

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Offset from the file's start [bytes].
    Byte(usize),
    /// Line, counted from 1.
    Line(usize),
    /// The file as a whole.
    Whole,
}

/// What a reader found wrong in a file's bytes; it does not know the file's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where.
    pub place: Place,
    /// What was expected, what was found, what to do.
    pub text: String,
    /// Whether a limit was met, rather than the format broken.
    pub limit: bool,
}

impl Problem {
    /// A breach of the format at `place`.
    pub(crate) fn new(place: Place, text: impl Into<String>) -> Self {
        Self { place, text: text.into(), limit: false }
    }

    /// A breach of the format in line `line`, counted from 1.
    pub(crate) fn line(line: usize, text: impl Into<String>) -> Self {
        Self::new(Place::Line(line), text)
    }

    /// A breach of the format that belongs to no one place.
    pub(crate) fn whole(text: impl Into<String>) -> Self {
        Self::new(Place::Whole, text)
    }

    /// More than the reader takes.
    pub(crate) fn limit(place: Place, text: impl Into<String>) -> Self {
        Self { place, text: text.into(), limit: true }
    }

    /// What stands between a file's name and the problem: the place is part of the name, the sentence is not.
    fn between(&self) -> &'static str {
        if self.place == Place::Whole { ": " } else { ", " }
    }

    /// The error of the file at `path`.
    pub fn in_file(self, path: &Path) -> Error {
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
        match self.place {
            Place::Byte(at) => write!(f, "byte {at}: {}", self.text),
            Place::Line(line) => write!(f, "line {line}: {}", self.text),
            Place::Whole => f.write_str(&self.text),
        }
    }
}

impl std::error::Error for Problem {}
