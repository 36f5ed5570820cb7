//! The exceptions of the package. Their texts are the sentences of the library.

use pyo3::{PyErr, create_exception, exceptions::PyException};
use std::fmt::Display;

create_exception!(hairspring, HairspringError, PyException, "Base class of the package's exceptions.");
create_exception!(hairspring, FileError, HairspringError, "A file could not be read or written.");
create_exception!(hairspring, SettingError, HairspringError, "A setting, an array or a scene is not valid.");

/// The exception for a file.
pub fn file(error: impl Display) -> PyErr {
    FileError::new_err(error.to_string())
}

/// The exception for a setting or an array.
pub fn setting(error: impl Display) -> PyErr {
    SettingError::new_err(error.to_string())
}
