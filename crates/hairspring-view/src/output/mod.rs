//! Writes pictures and clips to files. Every file is written under a temporary name in the same folder and
//! renamed when it is complete.

mod clip;
mod exr;
mod jpeg;
mod png;
mod yuv;

pub use clip::ClipWriter;
pub use exr::{Layers, write_exr};
pub use jpeg::write_jpeg;
pub use png::{encode_png, read_png, sequence_path, write_png};

use hairspring_file::PendingFile;
use std::path::{Path, PathBuf};

/// Why a picture or clip could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file system reported an error.
    #[error("{path}: {source}; check that the folder exists, can be written to and has room", path = path.display())]
    File {
        /// The path of the file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A clip with the requested settings is not possible.
    #[error("{path}: {why}", path = path.display())]
    Clip {
        /// The path of the file.
        path: PathBuf,
        /// What is wrong, what was expected, and what to do.
        why: String,
    },
    /// A file that was read is not a valid picture.
    #[error("{path}: not a picture that can be read ({why}); an 8-bit RGB or RGBA PNG was expected", path = path.display())]
    Picture {
        /// The path of the file.
        path: PathBuf,
        /// The error of the decoder.
        why: String,
    },
}

/// Creates a temporary file in the folder of `path`.
fn beside(path: &Path) -> Result<PendingFile, OutputError> {
    PendingFile::create(path).map_err(|source| OutputError::File { path: path.into(), source })
}

/// Renames a finished temporary file to its final name.
fn keep(file: PendingFile, path: &Path) -> Result<(), OutputError> {
    file.commit().map_err(|source| OutputError::File { path: path.into(), source })
}
