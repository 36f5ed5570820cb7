//! USD and Alembic: read and written in Python, for the readers and the program.

use crate::arrays::{Floats, Indices, copied_rows};
use glam::{Vec2, Vec3};
use hairspring::{
    body::{Body, Mesh, Part},
    groom::Groom,
};
use hairspring_io::{
    Axis, CacheDescription, CacheWriter, Character, ExternalError, ExternalFile, ExternalFormats,
    ReadOptions, obj,
};
use hairspring_scene::VertexCache;
use numpy::PyArray1;
use pyo3::{
    prelude::*,
    types::{PyDict, PyModule},
};
use std::path::{Path, PathBuf};

/// The readers and writers of the module `hairspring.host`.
pub struct PythonFormats;

/// Calls `act` with the module; an exception becomes its text.
fn with_host<T>(act: impl for<'py> FnOnce(Bound<'py, PyModule>) -> PyResult<T>) -> Result<T, String> {
    Python::attach(|py| {
        py.import("hairspring.host").and_then(act).map_err(|error| error.value(py).to_string())
    })
}

/// The same for reading: an `AbsentError` of Python means that the file has nothing of this kind.
fn read_with_host<T>(
    act: impl for<'py> FnOnce(Bound<'py, PyModule>) -> PyResult<T>,
) -> Result<T, ExternalError> {
    Python::attach(|py| {
        py.import("hairspring.host").and_then(act).map_err(|error| {
            let sentence = error.value(py).to_string();
            match error.get_type(py).name() {
                Ok(name) if name == "AbsentError" => ExternalError::Absent(sentence),
                _ => ExternalError::Invalid(sentence),
            }
        })
    })
}

fn up(options: &ReadOptions) -> Option<&'static str> {
    options.up.map(|up| if up == Axis::Z { "z" } else { "y" })
}

impl ExternalFormats for PythonFormats {
    fn read_groom(&self, path: &Path, options: &ReadOptions) -> Result<ExternalFile<Groom>, ExternalError> {
        read_with_host(|host| {
            let read = host.call_method1("read_groom", (path, options.scale, up(options)))?;
            let (arrays, group_names, unit_known, mut notes): (Bound<PyDict>, _, bool, Vec<String>) =
                read.extract()?;
            let density: Option<Floats> = arrays.get_item("density")?.map(|d| d.extract()).transpose()?;
            arrays.del_item("density").ok();
            let mut value = Groom { group_names, ..crate::groom::from_arrays(&arrays)? };
            if let Some(shares) = density {
                let shares = shares.numbers()?;
                if shares.len() != value.strand_count() {
                    return Err(crate::errors::setting("`density` must have one number for each strand"));
                }
                let all = value.strand_count();
                hairspring::groom::thin(&mut value, shares);
                let left_out = all - value.strand_count();
                if left_out > 0 {
                    notes.push(format!(
                        "the attribute `density` of the curves leaves out {left_out} of {all} strands; remove it to keep them"
                    ));
                }
            }
            Ok(ExternalFile { value, unit_known, notes })
        })
    }

    fn read_body(
        &self,
        path: &Path,
        options: &ReadOptions,
    ) -> Result<ExternalFile<Character>, ExternalError> {
        read_with_host(|host| {
            let read = host.call_method1("read_body", (path, options.scale, up(options)))?;
            #[expect(clippy::type_complexity, reason = "the tuple that Python returns")]
            let (vertices, triangles, uvs, colors, parts, frames, rate, unit_known, notes): (
                Floats,
                Indices,
                Option<Floats>,
                Option<Floats>,
                Vec<(String, u32)>,
                Option<Bound<PyAny>>,
                f64,
                bool,
                Vec<String>,
            ) = read.extract()?;
            let mut mesh = Mesh {
                positions: vertices.rows::<Vec3, 3>("vertices")?.to_vec(),
                triangles: triangles.triples("triangles")?.to_vec(),
                uvs: uvs
                    .map_or(Ok(Vec::new()), |uvs| Ok::<_, PyErr>(uvs.rows::<Vec2, 2>("uvs")?.to_vec()))?,
                colors: colors
                    .map_or(Ok(Vec::new()), |c| Ok::<_, PyErr>(c.rows::<Vec3, 3>("colors")?.to_vec()))?,
                ..Mesh::default()
            };
            crate::field::check_mesh(&mesh.positions, &mesh.triangles)?;
            mesh.compute_normals();
            let mut first = 0;
            for (name, count) in parts {
                let triangles = first..first + count;
                first = triangles.end;
                let (color, roughness) = (obj::DEFAULT_COLOR, obj::DEFAULT_ROUGHNESS);
                mesh.parts.push(Part { name, triangles, color, roughness });
            }
            let frames = frames.map(|frames| frames.try_iter()?.map(|f| frame(&f?)).collect::<PyResult<_>>());
            let vertex_cache = frames.transpose()?.map(|frames| VertexCache { rate, frames });
            let value = Character { body: Body::rigid(mesh), vertex_cache, ..Character::default() };
            Ok(ExternalFile { value, unit_known, notes })
        })
    }

    fn used_files(&self, path: &Path) -> Result<Vec<PathBuf>, String> {
        with_host(|host| host.call_method1("used_files", (path,))?.extract())
    }

    fn write_cache(
        &self,
        path: &Path,
        description: &CacheDescription,
    ) -> Result<Box<dyn CacheWriter>, String> {
        with_host(|host| {
            let py = host.py();
            let mut grooms = Vec::new();
            for (k, ((name, groom), guide)) in description.grooms.iter().zip(&description.guides).enumerate()
            {
                // The same properties that Python sees.
                let shown = Bound::new(py, crate::groom::Groom::of(groom.clone()))?;
                let fields = PyDict::new(py);
                for property in ["points", "offsets", "radii", "groups", "group_names", "root_uvs", "colors"]
                {
                    fields.set_item(property, shown.getattr(property)?)?;
                }
                fields.set_item("guides_and_weights", shown.getattr("guides")?)?;
                fields.set_item("name", name)?;
                let materials = description.materials.get(k).map_or(&[][..], |m| m);
                fields.set_item(
                    "materials",
                    pythonize::pythonize(py, materials).map_err(crate::errors::setting)?,
                )?;
                fields.set_item("guide", PyArray1::from_slice(py, guide))?;
                grooms.push(fields);
            }
            let CacheDescription { fps, first_frame, frames, per_frame, source, over, .. } = description;
            let time = (fps, first_frame, frames, per_frame);
            let writer = host.call_method1("write_cache", (path, time, source, over.as_deref(), grooms))?;
            Ok(Box::new(Writer(Some(writer.unbind()))) as Box<dyn CacheWriter>)
        })
    }
}

/// The positions of one frame.
fn frame(array: &Bound<'_, PyAny>) -> PyResult<Vec<Vec3>> {
    let array: Floats = array.extract()?;
    Ok(array.rows::<Vec3, 3>("frames")?.to_vec())
}

/// A writer in Python; `None` after it has finished.
struct Writer(Option<Py<PyAny>>);

impl Writer {
    fn call<T>(&self, act: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> Result<T, String> {
        Python::attach(|py| match &self.0 {
            Some(writer) => act(writer.bind(py)).map_err(|error| error.value(py).to_string()),
            None => Err("the file is already complete".into()),
        })
    }
}

impl CacheWriter for Writer {
    fn frame(&mut self, frame: f64, points: &[Vec3], velocities: &[Vec3]) -> Result<(), String> {
        self.call(|writer| {
            let py = writer.py();
            let points = copied_rows::<_, 3>(py, points)?;
            let velocities = copied_rows::<_, 3>(py, velocities)?;
            writer.call_method1("frame", (frame, points, velocities)).map(drop)
        })
    }

    fn finish(mut self: Box<Self>) -> Result<(), String> {
        let done = self.call(|writer| writer.call_method0("finish").map(drop));
        if done.is_ok() {
            self.0 = None;
        }
        done
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        if self.0.is_some() {
            // Nothing more can be done about a file that cannot be removed.
            let _ = self.call(|writer| writer.call_method0("discard").map(drop));
        }
    }
}
