//! `Stage`: a scene that plays.

use crate::{
    arrays::{copied_rows, fill_rows},
    collider::Collider,
    errors::{HairspringError, setting},
    force::Forces,
    groom::Groom,
    pose::Pose,
    scene::Scene,
};
use bytemuck::cast_slice;
use hairspring_scene::stage::{self, FrameRate};
use numpy::PyArray2;
use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyDict},
};

/// A scene that plays: the body moves, guides are simulated, the other hairs follow.
///
/// It begins at time 0 with the body in the first pose of its motion and the hair at rest.
#[pyclass(module = "hairspring")]
pub struct Stage {
    inner: stage::Stage,
    forces: Forces,
}

#[pymethods]
impl Stage {
    #[new]
    fn new(py: Python<'_>, scene: &Bound<'_, Scene>) -> PyResult<Self> {
        let scene = scene.get().inner.clone();
        let inner = py.detach(|| stage::Stage::new(scene)).map_err(setting)?;
        Ok(Self { inner, forces: Forces::default() })
    }

    /// Advances the scene by one frame at `fps` frames per second; 23.976 and 29.97 are understood as 24000/1001 and
    /// 30000/1001. Returns a dict of durations [s]: `body`, `simulate`, `follow`.
    ///
    /// Other threads of Python run meanwhile. Ctrl-C raises KeyboardInterrupt after the frame.
    fn step<'py>(&mut self, py: Python<'py>, fps: f64) -> PyResult<Bound<'py, PyDict>> {
        py.check_signals()?;
        let rate = FrameRate::nearest(fps)
            .filter(|rate| (1.0..=1e4).contains(&rate.hertz()))
            .ok_or_else(|| setting("`fps` must be from 1 to 10000"))?;
        self.forces.evaluate(py, self.inner.simulation(), self.inner.time())?;
        let inner = &mut self.inner;
        let report = py.detach(|| inner.step_frame(rate));
        py.check_signals()?;
        [("body", report.body), ("simulate", report.simulate), ("follow", report.follow)]
            .map(|(name, duration)| (name, duration.as_secs_f64()))
            .into_py_dict(py)
    }

    /// Returns to time 0.
    fn reset(&mut self, py: Python<'_>) {
        let inner = &mut self.inner;
        py.detach(|| inner.reset());
    }

    /// Time since the start [s].
    #[getter]
    fn time(&self) -> f64 {
        self.inner.time()
    }

    /// The grooms in their rest shape, with the roots bound.
    #[getter]
    fn grooms(&self) -> Vec<Groom> {
        self.inner.strands().map(|s| Groom::of(s.groom.clone())).collect()
    }

    /// Current positions of all strands of groom `groom`: [points, 3] [m], as a new array.
    #[pyo3(signature = (groom=0))]
    fn points<'py>(&self, py: Python<'py>, groom: usize) -> PyResult<Bound<'py, PyArray2<f32>>> {
        copied_rows::<_, 3>(py, self.strands(groom)?)
    }

    /// Writes the current positions of groom `groom` to `out`, a contiguous float32 array [points, 3].
    #[pyo3(signature = (out, groom=0))]
    fn write_points(&self, out: Bound<'_, PyAny>, groom: usize) -> PyResult<()> {
        let points = self.strands(groom)?;
        fill_rows::<3>(&out, points.len(), "out", |out| out.copy_from_slice(cast_slice(points)))
    }

    /// Guide of each strand of groom `groom`: itself if it is simulated, otherwise the nearest of its guides.
    #[pyo3(signature = (groom=0))]
    fn guides(&self, groom: usize) -> PyResult<Vec<u32>> {
        self.strands(groom)?;
        let strands = self.inner.strands().nth(groom).map_or(0, |s| s.groom.strand_count());
        Ok((0..strands).map(|s| self.inner.guide_of(groom, s)).collect())
    }

    /// Current vertices of the body: [vertices, 3] [m]; None for a scene without a body.
    #[getter]
    fn body_vertices<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        self.inner.body().map(|body| copied_rows::<_, 3>(py, body.positions)).transpose()
    }

    /// Triangles of the body: [triangles, 3]; None for a scene without a body.
    #[getter]
    fn body_triangles<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray2<u32>>> {
        let body = self.inner.body()?;
        Some(PyArray2::from_owned_array(py, numpy::ndarray::Array2::from(body.mesh.triangles.clone())))
    }

    /// Moves the whole body rigidly in addition to its motion, from the next step on: a 4×4 matrix or a translation [m].
    fn move_body(&mut self, pose: Pose) {
        self.inner.move_body(pose.0);
    }

    /// Sets colliders in addition to the scene's, all of which move with `pose` from the next step on.
    #[pyo3(signature = (colliders, pose=None))]
    fn set_colliders(&mut self, colliders: Vec<Bound<'_, Collider>>, pose: Option<Pose>) -> PyResult<()> {
        let shapes = colliders.iter().map(|c| c.borrow().fixed()).collect::<PyResult<Vec<_>>>()?;
        if shapes.iter().any(|(_, own)| *own != Default::default()) {
            return Err(setting("colliders of a stage move together by `pose`; leave `Collider.pose` unset"));
        }
        let shapes: Vec<_> = shapes.into_iter().map(|(shape, _)| shape).collect();
        self.inner.set_user_colliders(&shapes, pose.map_or_else(Default::default, |pose| pose.0));
        Ok(())
    }

    /// Adds a force on the simulated strands: see `Simulation.add_force`.
    fn add_force(&mut self, function: Bound<'_, PyAny>) -> PyResult<()> {
        let first = self.inner.simulated_offsets();
        let Self { inner, forces } = self;
        forces.add(function, first, |force| inner.add_force(force))
    }

    /// Removes all forces of `add_force`.
    fn clear_forces(&mut self) {
        let Self { inner, forces } = self;
        forces.clear(|id| inner.remove_force(id));
    }

    /// Measures of the simulated strands: a dict with `energy` [J], `speed_max` [m/s], `stretch_max`, `inside_points` and
    /// `max_depth` [m] below the surface of colliders.
    fn measure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let measure = self.inner.measure();
        [
            ("energy", self.inner.energy().total()),
            ("speed_max", measure.speed_max),
            ("stretch_max", measure.stretch_max),
            ("inside_points", measure.inside_points as f64),
            ("max_depth", measure.max_depth),
        ]
        .into_py_dict(py)
    }

    /// Number of simulated strands, and of all strands.
    #[getter]
    fn strand_counts(&self) -> (usize, usize) {
        self.inner.simulated_strands()
    }

    fn __repr__(&self) -> String {
        let (simulated, all) = self.inner.simulated_strands();
        format!("Stage({simulated} of {all} strands simulated, time {:.3} s)", self.inner.time())
    }
}

impl Stage {
    fn strands(&self, groom: usize) -> PyResult<&[glam::Vec3]> {
        let grooms = self.inner.strands().len();
        self.inner.strands().nth(groom).map(|s| s.points).ok_or_else(|| {
            HairspringError::new_err(format!("groom {groom} does not exist; the scene has {grooms}"))
        })
    }
}
