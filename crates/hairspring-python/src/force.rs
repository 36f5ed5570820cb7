//! Forces that are Python functions. Each is called once a frame for all points.

use crate::{
    arrays::{Floats, copied_rows},
    errors::setting,
};
use glam::Vec3;
use hairspring::{
    forces::{ForceField, StrandView},
    simulation::{ForceId, Simulation},
};
use pyo3::{prelude::*, types::PyDict};
use std::sync::{Arc, PoisonError, RwLock};

/// What a function returned for a frame. Arrays are empty, or have one entry for each simulated point.
#[derive(Default)]
struct Values {
    acceleration: Vec<Vec3>,
    drag_velocity: Vec<Vec3>,
    drag_rate: Vec<f32>,
    wind: Vec<Vec3>,
}

/// The force of a function in the current frame.
struct Field {
    /// First simulated point of each strand of the groom.
    first: Vec<u32>,
    values: RwLock<Values>,
}

impl ForceField for Field {
    fn apply(&self, strand: &mut StrandView) {
        let values = self.values.read().unwrap_or_else(PoisonError::into_inner);
        let first = self.first[strand.index()] as usize;
        for i in 0..strand.point_count() {
            if let Some(a) = values.acceleration.get(first + i) {
                strand.accelerate(i, *a);
            }
            if let (Some(v), Some(rate)) =
                (values.drag_velocity.get(first + i), values.drag_rate.get(first + i))
            {
                strand.add_velocity_drag(i, *v, *rate);
            }
            if let Some(v) = values.wind.get(first + i) {
                strand.add_wind(i, *v);
            }
        }
    }
}

/// The functions that act on a simulation.
#[derive(Default)]
pub struct Forces(Vec<(ForceId, Py<PyAny>, Arc<Field>)>);

impl Forces {
    /// Adds a function by `add`; `first` is the first simulated point of each strand.
    pub fn add(
        &mut self,
        function: Bound<'_, PyAny>,
        first: Vec<u32>,
        add: impl FnOnce(Arc<dyn ForceField>) -> ForceId,
    ) -> PyResult<()> {
        if !function.is_callable() {
            return Err(setting("a force must be a function of points, velocities and the time"));
        }
        let field = Arc::new(Field { first, values: RwLock::default() });
        self.0.push((add(field.clone()), function.unbind(), field));
        Ok(())
    }

    /// Removes all functions by `remove`.
    pub fn clear<T>(&mut self, mut remove: impl FnMut(ForceId) -> T) {
        self.0.drain(..).for_each(|(id, ..)| drop(remove(id)));
    }

    /// Calls the functions with the points and velocities of `simulation` at `time` [s].
    pub fn evaluate(&self, py: Python<'_>, simulation: &Simulation, time: f64) -> PyResult<()> {
        if self.0.is_empty() {
            return Ok(());
        }
        let mut vectors = vec![Vec3::ZERO; simulation.point_count()];
        simulation.write_points(&mut vectors);
        let points = copied_rows::<_, 3>(py, &vectors)?;
        simulation.write_velocities(&mut vectors);
        let velocities = copied_rows::<_, 3>(py, &vectors)?;
        for (_, function, field) in &self.0 {
            let result = function.bind(py).call1((&points, &velocities, time))?;
            *field.values.write().unwrap_or_else(PoisonError::into_inner) = values(&result, vectors.len())?;
        }
        Ok(())
    }
}

/// Reads the result of a function: an array of accelerations, or a dict of arrays.
fn values(result: &Bound<'_, PyAny>, points: usize) -> PyResult<Values> {
    let vectors = |given: &Bound<'_, PyAny>, name: &str| -> PyResult<Vec<Vec3>> {
        let given: Floats = given.extract()?;
        let rows: &[Vec3] = given.rows::<_, 3>(name)?;
        if rows.len() != points || !rows.iter().all(|v| v.is_finite()) {
            return Err(setting(format!(
                "a force's `{name}` must be {points} finite vectors, one for each point"
            )));
        }
        Ok(rows.to_vec())
    };
    let mut out = Values::default();
    let Ok(dict) = result.cast::<PyDict>() else {
        out.acceleration = vectors(result, "acceleration")?;
        return Ok(out);
    };
    for (key, value) in dict {
        match key.extract::<String>()?.as_str() {
            "acceleration" => out.acceleration = vectors(&value, "acceleration")?,
            "drag_velocity" => out.drag_velocity = vectors(&value, "drag_velocity")?,
            "wind" => out.wind = vectors(&value, "wind")?,
            "drag_rate" => {
                let given: Floats = value.extract()?;
                out.drag_rate = match given.numbers()? {
                    [one] => vec![*one; points],
                    many => many.to_vec(),
                };
            }
            other => {
                let known = "acceleration, drag_velocity, drag_rate and wind";
                return Err(setting(format!("a force returned `{other}`; it may return {known}")));
            }
        }
    }
    let drag = (out.drag_velocity.len(), out.drag_rate.len());
    if drag != (0, 0) && drag != (points, points) || !out.drag_rate.iter().all(|r| r.is_finite() && *r >= 0.0)
    {
        return Err(setting(
            "a force's `drag_velocity` [m/s] needs a `drag_rate` of 0 or more [1/s], one for each point",
        ));
    }
    Ok(out)
}
