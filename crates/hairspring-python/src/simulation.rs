//! `Simulation`: strands that Python steps frame by frame.

use crate::{
    arrays::{Floats, Indices, copied_rows, fill_rows},
    collider::{Collider, ColliderHistory},
    errors::setting,
    force::Forces,
    groom::Groom,
    pose::{self, Pose},
    settings::{Material, Solver, Volume, Wind},
};
use bytemuck::cast_slice_mut;
use glam::{Quat, Vec3};
use hairspring::{
    air::Air,
    math::RigidTransform,
    simulation::{self, StepInput},
};
use numpy::PyArray2;
use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyDict},
};

/// The state of a simulation, as `Simulation.snapshot` returns it.
#[pyclass(frozen, module = "hairspring")]
pub struct Snapshot {
    inner: simulation::Snapshot,
    time: f64,
}

/// Simulated strands.
///
/// Parameters
/// ----------
/// groom : Groom
///     The strands in their rest shape.
/// material : Material or list of Material, optional
///     One for all strands, or one for each group of the groom.
/// solver : Solver, optional
/// volume : Volume, optional
///     Hair against hair; off by default.
/// gravity : (3,) float, default (0, -9.81, 0)
///     [m/s²]
/// strands : array of int, optional
///     The simulated strands. Default: all.
///
/// Arrays of points have the shape [points, 3] and hold the simulated strands one after the other.
#[pyclass(module = "hairspring")]
pub struct Simulation {
    inner: simulation::Simulation,
    /// Roots of the simulated strands at rest [m].
    rest_roots: Vec<Vec3>,
    /// First simulated point of each strand of the groom.
    first: Vec<u32>,
    offsets: Vec<u32>,
    forces: Forces,
    colliders: ColliderHistory,
    time: f64,
}

/// One material, or a list of them.
#[derive(FromPyObject)]
#[expect(clippy::large_enum_variant, reason = "it lives for one call")]
enum Materials {
    One(Material),
    Many(Vec<Material>),
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (groom, *, material=None, solver=None, volume=None, gravity=None, strands=None))]
    fn new(
        py: Python<'_>,
        groom: &Bound<'_, Groom>,
        material: Option<Materials>,
        solver: Option<Solver>,
        volume: Option<Volume>,
        gravity: Option<Floats>,
        strands: Option<Indices>,
    ) -> PyResult<Self> {
        let groom = groom.get().inner.clone();
        let materials: Vec<_> = match material {
            None => Vec::new(),
            Some(Materials::One(one)) => vec![one.0],
            Some(Materials::Many(many)) => many.into_iter().map(|m| m.0).collect(),
        };
        let chosen = match &strands {
            None => (0..groom.strand_count() as u32).collect(),
            Some(strands) => strands.numbers()?.to_vec(),
        };
        let gravity = gravity.map_or(Ok(Vec3::new(0.0, -9.81, 0.0)), |g| g.vector::<Vec3, 3>("gravity"))?;
        let solver = solver.map_or_else(Default::default, |s| s.0);
        let mut inner = py
            .detach(|| {
                simulation::Simulation::builder(groom.clone())
                    .strands(&chosen)
                    .materials(&materials)
                    .solver(solver)
                    .gravity(gravity)
                    .build()
            })
            .map_err(setting)?;
        if let Some(volume) = volume {
            inner.set_volume(&volume.0).map_err(setting)?;
        }
        let mut first = vec![0; groom.strand_count()];
        let mut offsets = vec![0];
        for s in &chosen {
            let points = offsets.last().copied().unwrap_or(0);
            first[*s as usize] = points;
            offsets.push(points + groom.range(*s as usize).len() as u32);
        }
        let rest_roots = chosen.iter().map(|s| groom.strand(*s as usize)[0]).collect();
        let (forces, colliders) = (Forces::default(), ColliderHistory::default());
        Ok(Self { inner, rest_roots, first, offsets, forces, colliders, time: 0.0 })
    }

    /// Advances all strands by a frame.
    ///
    /// Parameters
    /// ----------
    /// dt : float
    ///     Length of the frame [s].
    /// anchor : 4×4 matrix or translation, optional
    ///     Pose of the head at the end of the frame. Roots are carried by it.
    /// roots : array [strands, 3], optional
    ///     Position of each root at the end of the frame [m], instead of the anchor's.
    /// rotations : array [strands, 4], optional
    ///     Rotation of each root since rest, as quaternions (x, y, z, w).
    /// colliders : list of Collider
    ///     Each moves from its last pose to its `pose`.
    /// wind : Wind or (3,) float, optional
    ///     The directional wind, or its velocity [m/s].
    ///
    /// Returns a dict: `substeps`, and `reset_strands`, the number of strands that were not finite and were reset.
    ///
    /// Other threads of Python run meanwhile. Ctrl-C raises KeyboardInterrupt after the frame.
    #[pyo3(signature = (dt, *, anchor=None, roots=None, rotations=None, colliders=Vec::new(), wind=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        dt: f32,
        anchor: Option<Pose>,
        roots: Option<Floats>,
        rotations: Option<Floats>,
        colliders: Vec<Bound<'py, Collider>>,
        wind: Option<WindArgument<'py>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        py.check_signals()?;
        let anchor = anchor.map_or_else(RigidTransform::default, |pose| pose.0);
        let roots = match (&roots, &rotations) {
            (None, None) => {
                let carried = |p: &Vec3| RigidTransform {
                    translation: anchor.transform_point(*p),
                    rotation: anchor.rotation,
                };
                self.rest_roots.iter().map(carried).collect()
            }
            (None, Some(_)) => return Err(setting("`rotations` needs `roots`")),
            (Some(roots), rotations) => {
                let rotations = rotations.as_ref().map(|r| r.rows::<Quat, 4>("rotations")).transpose()?;
                pose::roots(roots.rows::<Vec3, 3>("roots")?, rotations)?
            }
        };
        let wind = wind.map_or(Ok(Default::default()), |wind| wind.settings())?;
        let colliders = self.colliders.moving(&colliders, self.time)?;
        self.forces.evaluate(py, &self.inner, self.time)?;
        let air = Air { wind, time: self.time, ..Air::default() };
        let inner = &mut self.inner;
        let report = py
            .detach(|| inner.try_step(&StepInput { dt, anchor, roots: &roots, colliders: &colliders, air }));
        let report = report.map_err(setting)?;
        self.time += f64::from(dt);
        py.check_signals()?;
        let result = PyDict::new(py);
        result.set_item("substeps", report.substeps)?;
        result.set_item("reset_strands", report.reset_strands)?;
        Ok(result)
    }

    /// Adds a force: `function(points, velocities, time)`, called once a frame with arrays [points, 3] in meters and m/s.
    ///
    /// It returns accelerations [points, 3] [m/s²], which are constant in the frame, or a dict with any of `acceleration`;
    /// `drag_velocity` [points, 3] [m/s], which points take on at `drag_rate` [points] [1/s], implicitly; and `wind`
    /// [points, 3], added to the air [m/s].
    fn add_force(&mut self, function: Bound<'_, PyAny>) -> PyResult<()> {
        let Self { inner, forces, first, .. } = self;
        forces.add(function, first.clone(), |force| inner.add_force(force))
    }

    /// Removes all forces of `add_force`.
    fn clear_forces(&mut self) {
        let Self { inner, forces, .. } = self;
        forces.clear(|id| inner.remove_force(id));
    }

    /// Time since the start [s].
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    /// First point of each simulated strand, then the number of points: [strands + 1].
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<u32>> {
        numpy::PyArray1::from_slice(py, &self.offsets)
    }

    /// Positions [points, 3] [m], as a new array.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let mut points = vec![Vec3::ZERO; self.inner.point_count()];
        self.inner.write_points(&mut points);
        copied_rows::<_, 3>(py, &points)
    }

    /// Velocities [points, 3] [m/s], as a new array.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let mut velocities = vec![Vec3::ZERO; self.inner.point_count()];
        self.inner.write_velocities(&mut velocities);
        copied_rows::<_, 3>(py, &velocities)
    }

    /// Writes the positions to `out`, a contiguous float32 array [points, 3], without allocating.
    fn write_points(&self, out: Bound<'_, PyAny>) -> PyResult<()> {
        fill_rows::<3>(&out, self.inner.point_count(), "out", |out| {
            self.inner.write_points(cast_slice_mut(out))
        })
    }

    /// Writes the velocities to `out`, a contiguous float32 array [points, 3], without allocating.
    fn write_velocities(&self, out: Bound<'_, PyAny>) -> PyResult<()> {
        fill_rows::<3>(&out, self.inner.point_count(), "out", |out| {
            self.inner.write_velocities(cast_slice_mut(out));
        })
    }

    /// Moves all points: `points` [points, 3] [m] and `velocities` [points, 3] [m/s], 0 by default. Roots stay where they are.
    #[pyo3(signature = (points, velocities=None))]
    fn set_points(&mut self, points: Floats, velocities: Option<Floats>) -> PyResult<()> {
        let points: &[Vec3] = points.rows::<_, 3>("points")?;
        let still = vec![Vec3::ZERO; points.len()];
        let velocities = velocities.as_ref().map_or(Ok(&still[..]), |v| v.rows::<_, 3>("velocities"))?;
        self.inner.set_points(points, velocities).map_err(setting)
    }

    /// Returns the whole state.
    fn snapshot(&self) -> Snapshot {
        Snapshot { inner: self.inner.snapshot(), time: self.time }
    }

    /// Returns to a state of this simulation. The same steps then give the same bits again.
    fn restore(&mut self, snapshot: &Snapshot) -> PyResult<()> {
        self.inner.restore(&snapshot.inner).map_err(setting)?;
        self.time = snapshot.time;
        Ok(())
    }

    /// Moves all hair rigidly, with its shape and velocity, as for a cut.
    fn teleport(&mut self, pose: Pose) {
        self.inner.teleport(pose.0);
    }

    /// Measures of the current state: a dict with the energies `kinetic`, `gravitational`, `bending`, `twisting`,
    /// `stretching` and their sum `energy` [J]; `speed_max` [m/s]; and `stretch_mean` and `stretch_max`, the stretch of
    /// segments as a fraction.
    fn measure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (measure, energy) = (self.inner.measure(&[]), self.inner.energy());
        [
            ("energy", energy.total()),
            ("kinetic", energy.kinetic),
            ("gravitational", energy.gravitational),
            ("bending", energy.bending),
            ("twisting", energy.twisting),
            ("stretching", energy.stretching),
            ("speed_max", measure.speed_max),
            ("stretch_mean", measure.stretch_mean),
            ("stretch_max", measure.stretch_max),
        ]
        .into_py_dict(py)
    }

    fn __len__(&self) -> usize {
        self.inner.strand_count()
    }

    fn __repr__(&self) -> String {
        let (strands, points) = (self.inner.strand_count(), self.inner.point_count());
        format!("Simulation({strands} strands, {points} points, time {:.3} s)", self.time)
    }
}

/// The wind of a step: settings, or only a velocity.
#[derive(FromPyObject)]
enum WindArgument<'py> {
    Settings(Wind),
    Velocity(Floats<'py>),
}

impl WindArgument<'_> {
    fn settings(self) -> PyResult<hairspring::settings::Wind> {
        match self {
            Self::Settings(wind) => Ok(wind.0),
            Self::Velocity(v) => {
                let velocity = v.vector::<Vec3, 3>("wind")?;
                Ok(hairspring::settings::Wind { velocity, ..Default::default() })
            }
        }
    }
}
