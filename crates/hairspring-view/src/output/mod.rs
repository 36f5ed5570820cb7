//! Pictures and clips as files. Every file is written beside its place under a temporary name and renamed when complete.

mod clip;
mod jpeg;
mod png;
mod yuv;

pub use clip::ClipWriter;
pub use jpeg::write_jpeg;
pub use png::{encode_png, read_png, sequence_path, write_png};

use std::path::{Path, PathBuf};

/// Why a picture or clip could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file system said no.
    #[error("{path}: {source}; check that the folder exists, can be written to and has room", path = path.display())]
    File {
        /// The file that was meant.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A clip cannot be made as asked.
    #[error("{path}: {why}", path = path.display())]
    Clip {
        /// The file that was meant.
        path: PathBuf,
        /// What is wrong, what was expected, what to do.
        why: String,
    },
    /// A file that is read is not what it should be.
    #[error("{path}: not a picture that can be read ({why}); an 8-bit RGB PNG was expected", path = path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        why: String,
    },
}

/// A temporary file in the folder of `path`.
fn beside(path: &Path) -> Result<tempfile::NamedTempFile, OutputError> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    // What a program creates is readable as the user's mask says, not private as temporary files are.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
        .prefix(".hairspring-")
        .tempfile_in(folder)
        .map_err(|source| OutputError::File { path: path.into(), source })
}

/// Gives a finished temporary file its name.
fn keep(file: tempfile::NamedTempFile, path: &Path) -> Result<(), OutputError> {
    file.persist(path).map(drop).map_err(|e| OutputError::File { path: path.into(), source: e.error })
}
