//! Errors of the window.

use hairspring_scene::stage::StageError;
use hairspring_view::OutputError;

/// One sentence for the user of the window.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AppError(String);

impl AppError {
    /// Creates an error with this message.
    pub fn new(sentence: impl Into<String>) -> Self {
        Self(sentence.into())
    }
}

impl From<hairspring_io::Error> for AppError {
    fn from(error: hairspring_io::Error) -> Self {
        Self(error.to_string())
    }
}

impl From<hairspring_io::ManifestError> for AppError {
    fn from(error: hairspring_io::ManifestError) -> Self {
        Self(error.to_string())
    }
}

impl From<StageError> for AppError {
    fn from(error: StageError) -> Self {
        Self(error.to_string())
    }
}

impl From<OutputError> for AppError {
    fn from(error: OutputError) -> Self {
        Self(error.to_string())
    }
}
