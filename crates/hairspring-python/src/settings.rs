//! Settings from keyword arguments, with the names, ranges and errors of scene files.

use crate::errors::setting;
use hairspring::{material, settings::Validate};
use pyo3::{prelude::*, types::PyDict};
use pythonize::{depythonize, pythonize};
use serde::{Serialize, de::DeserializeOwned};

/// Returns `base` with the fields of `changes` replaced, after a check of all ranges.
fn with<T: Serialize + DeserializeOwned + Validate>(
    py: Python<'_>,
    base: &T,
    changes: Option<&Bound<'_, PyDict>>,
) -> PyResult<T> {
    let fields = pythonize(py, base).map_err(setting)?.cast_into::<PyDict>()?;
    if let Some(changes) = changes {
        for (key, value) in changes {
            if !fields.contains(&key)? {
                let mut known: Vec<String> = fields.keys().iter().map(|k| k.to_string()).collect();
                known.sort();
                return Err(setting(format!(
                    "there is no setting `{key}`; the settings are {}",
                    known.join(", ")
                )));
            }
            // numpy's numbers and arrays become Python's own.
            let value = if value.hasattr("tolist")? { value.call_method0("tolist")? } else { value };
            fields.set_item(key, value)?;
        }
    }
    let settings: T = depythonize(fields.as_any()).map_err(setting)?;
    settings.validate().map_err(setting)?;
    Ok(settings)
}

/// Reads a field as Python's own type.
fn field<'py>(py: Python<'py>, settings: &impl Serialize, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let fields = pythonize(py, settings).map_err(setting)?.cast_into::<PyDict>()?;
    fields
        .get_item(name)?
        .ok_or_else(|| pyo3::exceptions::PyAttributeError::new_err(format!("there is no setting `{name}`")))
}

/// The methods that all settings have: fields as attributes, `replace`, equality and a text.
macro_rules! settings_class {
    ($(#[$doc:meta])* $name:ident($inner:ty) $text:literal { $($new:tt)* }) => {
        $(#[$doc])*
        #[pyclass(frozen, eq, module = "hairspring", from_py_object)]
        #[derive(Clone, PartialEq)]
        pub struct $name(pub $inner);

        #[pymethods]
        impl $name {
            $($new)*

            /// Returns a copy with other values.
            #[pyo3(signature = (**settings))]
            fn replace(&self, py: Python<'_>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
                with(py, &self.0, settings).map(Self)
            }

            /// Returns all settings by name.
            fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                pythonize(py, &self.0).map_err(setting)
            }

            fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
                field(py, &self.0, name)
            }

            fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
                Ok(format!(concat!($text, "(**{})"), self.to_dict(py)?.repr()?))
            }
        }
    };
}

settings_class! {
    /// The fiber of a group of strands: physical constants, and factors for artists.
    ///
    /// The settings are those of `[material.NAME]` in a scene file, by the same names and ranges
    /// (docs/parameters): `young` [Pa], `bend` (factor), `damping` [s], `friction`, `model`, and others.
    /// `preset` is "straight", "wavy", "curly", "coily" or "short-fur"; without one, a single human hair.
    Material(material::Material) "Material" {
        #[new]
        #[pyo3(signature = (preset=None, **settings))]
        fn new(py: Python<'_>, preset: Option<&str>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
            let base = match preset {
                None => material::Material::default(),
                Some(name) => material::preset(name).ok_or_else(|| {
                    let presets = material::PRESETS.join(", ");
                    setting(format!("there is no preset `{name}`; the presets are {presets}"))
                })?,
            };
            with(py, &base, settings).map(Self)
        }
    }
}

settings_class! {
    /// Time steps, integrator and contact: the settings of `[solver]` in a scene file, such as `substeps`
    /// (per 1/60 s, default 4), `integrator` and `sag_free`.
    Solver(hairspring::settings::Solver) "Solver" {
        #[new]
        #[pyo3(signature = (**settings))]
        fn new(py: Python<'_>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
            with(py, &Default::default(), settings).map(Self)
        }
    }
}

settings_class! {
    /// Hair against hair by a grid: the settings of `[volume]` in a scene file, such as `method` and `cell` [m].
    Volume(hairspring::settings::Volume) "Volume" {
        #[new]
        #[pyo3(signature = (**settings))]
        fn new(py: Python<'_>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
            with(py, &Default::default(), settings).map(Self)
        }
    }
}

settings_class! {
    /// The directional wind: `velocity` [m/s], `gust` (fraction), `gust_rate` [Hz].
    Wind(hairspring::settings::Wind) "Wind" {
        #[new]
        #[pyo3(signature = (**settings))]
        fn new(py: Python<'_>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
            with(py, &Default::default(), settings).map(Self)
        }
    }
}
