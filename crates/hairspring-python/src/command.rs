//! The program `hairspring` inside of the package.

use crate::errors::{file, setting};
use hairspring_io::{Inputs, read_scene};
use pyo3::prelude::*;
use std::{ffi::OsString, path::PathBuf};

/// Runs the program with the arguments `arguments`, of which the first is its name. Returns the exit code.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| hairspring_cli::run(arguments))
}

/// Returns the text of a scene file with other values, for a file in `folder`. `values` is a list of keys and values as TOML.
#[pyfunction]
pub fn scene_with(path: PathBuf, folder: PathBuf, values: Vec<(String, String)>) -> PyResult<String> {
    hairspring_cli::scene_with(&path, &folder, &values).map_err(setting)
}

/// Returns the names and the SHA-256 of the scene file `path` and of all files that it names.
#[pyfunction]
pub fn scene_inputs(py: Python<'_>, path: PathBuf) -> PyResult<Vec<(String, String)>> {
    let (scene, inputs) = py.detach(|| Inputs::record(&path, || read_scene(&path)));
    scene.map_err(file)?;
    Ok(inputs.checksums().map(|(name, checksum)| (name.to_owned(), checksum.to_owned())).collect())
}
