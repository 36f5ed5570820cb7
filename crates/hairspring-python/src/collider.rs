//! `Collider`: shapes that hair collides with.

use crate::{
    arrays::{Floats, Indices},
    errors::setting,
    field::{SignedDistanceField, check_mesh, sampled},
    pose::Pose,
};
use glam::{EulerRot, Mat3, Vec3};
use hairspring::{
    collide::{ColliderShape, Hull, MovingCollider, ThinShell, voxelize},
    math::RigidTransform,
};
use numpy::PyArray2;
use pyo3::{prelude::*, types::PyAny};
use std::sync::Arc;

/// Largest number of nodes that the function of a custom collider is sampled at.
const MAX_SAMPLES: f32 = 4e6;

/// A shape that hair collides with.
///
/// It is made by `sphere`, `capsule`, `box`, `plane`, `hull`, `mesh`, `sheet`, `field` or `custom`, and its `pose` can be set
/// before each step. Within the step it moves from its previous pose to `pose`, and passes its velocity on to the hair.
#[pyclass(module = "hairspring")]
pub struct Collider {
    shape: Shape,
    pose: RigidTransform,
}

enum Shape {
    Fixed(ColliderShape),
    /// A function of positions [n, 3] and the time, which returns distances [n].
    Function {
        function: Py<PyAny>,
        bounds: (Vec3, Vec3),
        cell: f32,
    },
}

impl From<ColliderShape> for Collider {
    fn from(shape: ColliderShape) -> Self {
        Self { shape: Shape::Fixed(shape), pose: RigidTransform::default() }
    }
}

fn radius_above_0(radius: f32) -> PyResult<f32> {
    if radius.is_finite() && radius > 0.0 { Ok(radius) } else { Err(setting("`radius` must be above 0 [m]")) }
}

#[pymethods]
impl Collider {
    /// A sphere: center and radius [m].
    #[staticmethod]
    fn sphere(center: Floats, radius: f32) -> PyResult<Self> {
        let center = center.vector::<Vec3, 3>("center")?;
        Ok(ColliderShape::Sphere { center, radius: radius_above_0(radius)? }.into())
    }

    /// All points nearer than `radius` to the segment from `a` to `b` [m].
    #[staticmethod]
    fn capsule(a: Floats, b: Floats, radius: f32) -> PyResult<Self> {
        let (a, b) = (a.vector::<Vec3, 3>("a")?, b.vector::<Vec3, 3>("b")?);
        Ok(ColliderShape::Capsule { a, b, radius: radius_above_0(radius)? }.into())
    }

    /// A box: center, edge lengths [m], and its rotation about X, then Y, then Z [degrees].
    #[staticmethod]
    #[pyo3(name = "box", signature = (center, size, rotation=None))]
    fn cuboid(center: Floats, size: Floats, rotation: Option<Floats>) -> PyResult<Self> {
        let half = 0.5 * size.vector::<Vec3, 3>("size")?;
        if !(half.is_finite() && half.min_element() > 0.0) {
            return Err(setting("`size` must be three numbers above 0 [m]"));
        }
        let turn = rotation.map_or(Ok(Vec3::ZERO), |r| r.vector::<Vec3, 3>("rotation"))?;
        let [x, y, z] = turn.to_array().map(f32::to_radians);
        let axes = Mat3::from_euler(EulerRot::ZYX, z, y, x);
        Ok(ColliderShape::Cuboid { center: center.vector::<Vec3, 3>("center")?, half, axes }.into())
    }

    /// The half-space behind a plane: a point on it [m] and its normal, which points out of the solid.
    #[staticmethod]
    fn plane(point: Floats, normal: Floats) -> PyResult<Self> {
        let normal = normal.vector::<Vec3, 3>("normal")?;
        let normal = normal.try_normalize().ok_or_else(|| setting("`normal` must not be zero"))?;
        Ok(ColliderShape::Plane { point: point.vector::<Vec3, 3>("point")?, normal }.into())
    }

    /// The convex hull of `points` [n, 3] [m].
    #[staticmethod]
    fn hull(points: Floats) -> PyResult<Self> {
        let hull = Hull::new(points.rows::<Vec3, 3>("points")?);
        let hull = hull.ok_or_else(|| setting("the points of a hull must be finite and span a volume"))?;
        Ok(ColliderShape::Hull(Arc::new(hull)).into())
    }

    /// The interior of a closed mesh: `vertices` [n, 3] [m], `triangles` [m, 3]; `cell` is the resolution of its distance field
    /// [m].
    #[staticmethod]
    #[pyo3(signature = (vertices, triangles, cell=0.005))]
    fn mesh(py: Python<'_>, vertices: Floats, triangles: Indices, cell: f32) -> PyResult<Self> {
        let (vertices, triangles): (&[Vec3], _) =
            (vertices.rows::<_, 3>("vertices")?, triangles.triples("triangles")?);
        check_mesh(vertices, triangles)?;
        if !(cell.is_finite() && cell > 0.0) {
            return Err(setting("`cell` must be above 0 [m]"));
        }
        let field = py.detach(|| voxelize(vertices, triangles, cell));
        Ok(ColliderShape::Field(Arc::new(field)).into())
    }

    /// All points nearer than `thickness` [m] to an open mesh, on both sides.
    #[staticmethod]
    #[pyo3(signature = (vertices, triangles, thickness=0.002))]
    fn sheet(vertices: Floats, triangles: Indices, thickness: f32) -> PyResult<Self> {
        let (vertices, triangles): (&[Vec3], _) =
            (vertices.rows::<_, 3>("vertices")?, triangles.triples("triangles")?);
        check_mesh(vertices, triangles)?;
        if !(thickness.is_finite() && thickness > 0.0) {
            return Err(setting("`thickness` must be above 0 [m]"));
        }
        Ok(ColliderShape::Sheet(Arc::new(ThinShell::new(vertices, triangles, thickness))).into())
    }

    /// The interior of a `SignedDistanceField`.
    #[staticmethod]
    fn field(field: &Bound<'_, SignedDistanceField>) -> Self {
        ColliderShape::Field(field.get().0.clone()).into()
    }

    /// A shape given by a Python function.
    ///
    /// `function(points, time)` gets positions [n, 3] in the space of the collider [m] and the time [s], and returns the signed
    /// distances [n] [m], negative inside. It is called once a frame for all nodes of a grid with the edge `cell` [m] over
    /// `bounds` ((x, y, z), (x, y, z)) [m], between which distances are interpolated. With `once`, it is called only here.
    #[staticmethod]
    #[pyo3(signature = (function, bounds, *, cell=0.005, once=false))]
    fn custom(function: Bound<'_, PyAny>, bounds: (Floats, Floats), cell: f32, once: bool) -> PyResult<Self> {
        let (low, high) =
            (bounds.0.vector::<Vec3, 3>("bounds[0]")?, bounds.1.vector::<Vec3, 3>("bounds[1]")?);
        let cells = (high - low) / cell;
        if !(cells.is_finite() && cells.min_element() > 0.0 && cell > 0.0) {
            return Err(setting("`bounds` must be a low and a higher corner, and `cell` above 0 [m]"));
        }
        if (cells + 2.0).element_product() > MAX_SAMPLES {
            let text =
                format!("the bounds hold more than {MAX_SAMPLES:.0} cells of {cell} m; use a larger `cell`");
            return Err(setting(text));
        }
        let shape = Shape::Function { function: function.clone().unbind(), bounds: (low, high), cell };
        let shape = match once {
            false => shape,
            true => Shape::Fixed(ColliderShape::Field(Arc::new(sampled(&function, (low, high), cell, 0.0)?))),
        };
        Ok(Self { shape, pose: RigidTransform::default() })
    }

    /// Pose at the end of the next step: a 4×4 matrix, or only a translation [m]. Default: identity.
    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        let m = glam::Mat4::from_rotation_translation(self.pose.rotation, self.pose.translation);
        let rows = m.transpose().to_cols_array_2d();
        PyArray2::from_owned_array(py, numpy::ndarray::Array2::from(rows.to_vec()))
    }

    #[setter]
    fn set_pose(&mut self, pose: Pose) {
        self.pose = pose.0;
    }
}

/// The colliders of the last step and where they were, so that a step knows how they move.
#[derive(Default)]
pub struct ColliderHistory(Vec<(Py<Collider>, RigidTransform)>);

impl ColliderHistory {
    /// Returns `colliders` with their motion in a frame that begins at `time` [s]. A collider that was not in the last frame is
    /// at rest.
    pub fn moving(&mut self, colliders: &[Bound<'_, Collider>], time: f64) -> PyResult<Vec<MovingCollider>> {
        let mut poses = Vec::with_capacity(colliders.len());
        let mut moving = Vec::with_capacity(colliders.len());
        for collider in colliders {
            let shape = collider.borrow().shape(collider.py(), time)?;
            let end = collider.borrow().pose;
            let before = self.0.iter().find(|(earlier, _)| earlier.is(collider));
            moving.push(MovingCollider::new(shape, before.map_or(end, |(_, pose)| *pose), end));
            poses.push((collider.clone().unbind(), end));
        }
        self.0 = poses;
        Ok(moving)
    }
}

impl Collider {
    fn shape(&self, py: Python<'_>, time: f64) -> PyResult<ColliderShape> {
        match &self.shape {
            Shape::Fixed(shape) => Ok(shape.clone()),
            Shape::Function { function, bounds, cell } => {
                Ok(ColliderShape::Field(Arc::new(sampled(function.bind(py), *bounds, *cell, time)?)))
            }
        }
    }

    /// Returns the shape if it is at the same place in every frame; otherwise an error.
    pub fn fixed(&self) -> PyResult<(ColliderShape, RigidTransform)> {
        match &self.shape {
            Shape::Fixed(shape) => Ok((shape.clone(), self.pose)),
            Shape::Function { .. } => Err(setting(
                "a custom collider that is sampled every frame can only be used in `Simulation.step`; pass `once=True`",
            )),
        }
    }
}
