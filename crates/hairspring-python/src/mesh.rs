//! `Body`: the mesh that hair grows on, with its skeleton.

use crate::{
    arrays::{Floats, Indices, shared_rows},
    errors::file,
    field::check_mesh,
    groom::axis,
};
use glam::Vec3;
use hairspring::body::{self, Mesh};
use hairspring_io::{ReadOptions, read_body};
use numpy::{PyArray2, ndarray::Array2};
use pyo3::prelude::*;
use std::{path::PathBuf, sync::Arc};

/// A triangle mesh in its rest pose, with the skeleton that moves it. Immutable.
///
/// Parameters
/// ----------
/// vertices : array [vertices, 3], float32
///     Positions [m], Y up.
/// triangles : array [triangles, 3], uint32
///     Vertices of each triangle, counter-clockwise seen from outside.
#[pyclass(frozen, module = "hairspring")]
pub struct Body {
    pub inner: Arc<body::Body>,
    notes: Vec<String>,
}

#[pymethods]
impl Body {
    #[new]
    fn new(vertices: Floats, triangles: Indices) -> PyResult<Self> {
        let positions = vertices.rows::<Vec3, 3>("vertices")?.to_vec();
        let triangles = triangles.triples("triangles")?.to_vec();
        check_mesh(&positions, &triangles)?;
        let mut mesh = Mesh { positions, triangles, ..Mesh::default() };
        mesh.compute_normals();
        Ok(Self { inner: Arc::new(body::Body::rigid(mesh)), notes: Vec::new() })
    }

    /// Reads a body: .glb, .gltf, .vrm, .obj or .tfxmesh. `scale` and `up` are as in `Groom.read`.
    #[staticmethod]
    #[pyo3(signature = (path, *, scale=None, up=None))]
    fn read(py: Python<'_>, path: PathBuf, scale: Option<f32>, up: Option<&str>) -> PyResult<Self> {
        let options = ReadOptions { scale, up: axis(up)? };
        let loaded = py.detach(|| read_body(&path, &options)).map_err(file)?;
        let mut notes = loaded.notes;
        notes.extend(
            loaded.value.unplayed_note("; a Body stays at rest; name the file in a scene file to play one"),
        );
        Ok(Self { inner: Arc::new(loaded.value.body), notes })
    }

    /// What was guessed and left out when the file was read, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Vertices in the rest pose: [vertices, 3], float32 [m].
    #[getter]
    fn vertices<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        // SAFETY: the class is frozen and its mesh is never changed.
        unsafe { shared_rows::<_, 3>(&this.get().inner.mesh.positions, this.clone().into_any()) }
    }

    /// Vertices of each triangle: [triangles, 3], uint32.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        PyArray2::from_owned_array(py, Array2::from(self.inner.mesh.triangles.clone()))
    }

    /// Names of the joints, parents before children.
    #[getter]
    fn joints(&self) -> Vec<String> {
        self.inner.joints.iter().map(|j| j.name.clone()).collect()
    }

    fn __repr__(&self) -> String {
        let mesh = &self.inner.mesh;
        let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
        format!("Body({vertices} vertices, {triangles} triangles, {} joints)", self.inner.joints.len())
    }
}
