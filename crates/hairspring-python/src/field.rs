//! `SignedDistanceField`: the distance to a closed mesh, or an array of distances.

use crate::{
    arrays::{Floats, Indices, shared},
    errors::setting,
};
use glam::{UVec3, Vec3};
use hairspring::collide::{self, voxelize};
use numpy::{PyArray1, ndarray::Array3};
use pyo3::prelude::*;
use std::sync::Arc;

/// Signed distances on a grid, negative inside. Immutable.
///
/// Node (x, y, z) is at `origin + cell * (x, y, z)`, and its distance is `distances[z, y, x]`.
///
/// Parameters
/// ----------
/// origin : (3,) float
///     Position of the first node [m].
/// cell : float
///     Edge of a cell [m].
/// distances : array [nz, ny, nx], float32
///     Signed distance of each node [m]; the outermost ones should be positive.
#[pyclass(frozen, module = "hairspring")]
pub struct SignedDistanceField(pub Arc<collide::SignedDistanceField>);

#[pymethods]
impl SignedDistanceField {
    #[new]
    fn new(origin: Floats, cell: f32, distances: Floats) -> PyResult<Self> {
        let [nz, ny, nx] = *distances.shape() else {
            return Err(setting(format!(
                "`distances` must have the shape [nz, ny, nx], but has {:?}",
                distances.shape()
            )));
        };
        let size = UVec3::new(nx as u32, ny as u32, nz as u32);
        let samples = distances.numbers()?.to_vec();
        let origin = origin.vector::<Vec3, 3>("origin")?;
        let field =
            collide::SignedDistanceField::from_samples(origin, cell, size, samples).map_err(setting)?;
        Ok(Self(Arc::new(field)))
    }

    /// Computes the field of a closed mesh: `vertices` [n, 3] [m], `triangles` [m, 3], and the edge of a cell [m].
    #[staticmethod]
    fn from_mesh(py: Python<'_>, vertices: Floats, triangles: Indices, cell: f32) -> PyResult<Self> {
        let (vertices, triangles): (&[Vec3], _) =
            (vertices.rows::<_, 3>("vertices")?, triangles.triples("triangles")?);
        check_mesh(vertices, triangles)?;
        if !(cell.is_finite() && cell > 0.0) {
            return Err(setting("`cell` must be above 0 [m]"));
        }
        Ok(Self(Arc::new(py.detach(|| voxelize(vertices, triangles, cell)))))
    }

    /// Returns the signed distance at each of `points` [n, 3]: [n], float32 [m].
    fn distance<'py>(&self, py: Python<'py>, points: Floats) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let points: &[Vec3] = points.rows::<_, 3>("points")?;
        let distances: Vec<f32> = points.iter().map(|p| self.0.distance_and_normal(*p).0).collect();
        Ok(PyArray1::from_vec(py, distances))
    }

    /// Position of the first node [m].
    #[getter]
    fn origin(&self) -> [f32; 3] {
        self.0.origin().to_array()
    }

    /// Edge of a cell [m].
    #[getter]
    fn cell(&self) -> f32 {
        self.0.cell()
    }

    /// Distances [nz, ny, nx], float32 [m].
    #[getter]
    fn distances<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let field = &this.get().0;
        let size = field.size();
        let nodes = size.to_array().iter().map(|n| *n as usize).product::<usize>();
        // SAFETY: the class is frozen and its field is never changed.
        let flat = unsafe { shared(&field.distances()[..nodes], this.clone().into_any())? };
        flat.as_any().call_method1("reshape", (size.z, size.y, size.x))
    }

    fn __repr__(&self) -> String {
        let size = self.0.size();
        format!("SignedDistanceField({} × {} × {} nodes, cell {} m)", size.x, size.y, size.z, self.0.cell())
    }
}

/// Checks the arrays of a mesh.
pub fn check_mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> PyResult<()> {
    if triangles.is_empty() {
        return Err(setting("a mesh needs at least one triangle"));
    }
    if let Some(bad) = vertices.iter().position(|p| !p.is_finite()) {
        return Err(setting(format!("vertex {bad} is not finite")));
    }
    if triangles.iter().flatten().any(|i| *i as usize >= vertices.len()) {
        return Err(setting(format!("a triangle names a vertex beyond the last of {}", vertices.len())));
    }
    Ok(())
}

/// Samples a Python function of positions on a grid over the box from `low` to `high`.
pub fn sampled(
    function: &Bound<'_, PyAny>,
    (low, high): (Vec3, Vec3),
    cell: f32,
    time: f64,
) -> PyResult<collide::SignedDistanceField> {
    let size = ((high - low) / cell).ceil().as_uvec3() + 1;
    let [nx, ny, nz] = size.to_array().map(|n| n as usize);
    let nodes = Array3::from_shape_fn((nx * ny * nz, 1, 3), |(k, _, axis)| {
        let at = [k % nx, k / nx % ny, k / (nx * ny)][axis];
        low[axis] + cell * at as f32
    });
    let nodes = nodes.into_shape_with_order((nx * ny * nz, 3)).map_err(setting)?;
    let nodes = numpy::PyArray2::from_owned_array(function.py(), nodes);
    let distances: Floats = function.call1((nodes, time))?.extract()?;
    let numbers = distances.numbers()?;
    if numbers.len() != nx * ny * nz {
        let text =
            format!("a custom collider returned {} distances for {} points", numbers.len(), nx * ny * nz);
        return Err(setting(text));
    }
    collide::SignedDistanceField::from_samples(low, cell, size, numbers.to_vec()).map_err(setting)
}
