//! The extension module `hairspring._native` of the Python package `hairspring`.
//!
//! Each class wraps a type of the library and keeps its name. Arrays are numpy arrays of `float32`, `uint32` or `uint16` with
//! the shapes that the docstrings state. Arrays of immutable objects share their memory. Units are SI, Y up.

mod arrays;
mod collider;
mod command;
mod errors;
mod external;
mod field;
mod force;
mod groom;
mod mesh;
mod pose;
mod scene;
mod settings;
mod simulation;
mod stage;

use pyo3::prelude::*;

/// Real-time strand hair.
#[pymodule(gil_used = true)]
mod _native {
    #[pymodule_export]
    use super::{
        collider::Collider,
        command::{run_command, scene_inputs, scene_with},
        errors::{FileError, HairspringError, SettingError},
        field::SignedDistanceField,
        groom::Groom,
        mesh::Body,
        scene::Scene,
        settings::{Material, Solver, Volume, Wind},
        simulation::{Simulation, Snapshot},
        stage::Stage,
    };

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        hairspring_io::set_external_formats(Box::new(external::PythonFormats));
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
