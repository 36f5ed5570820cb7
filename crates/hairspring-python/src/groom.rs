//! `Groom`: strands as numpy arrays, and groom files.

use crate::{
    arrays::{Floats, Indices, shared, shared_rows},
    errors::{file, setting},
};
use glam::{Vec2, Vec3};
use hairspring::groom::{self, DEFAULT_RADIUS, GuideWeights, StrandScale};
use hairspring_io::{Axis, ReadOptions, read_groom, write_groom};
use numpy::{PyArray1, PyArray2};
use pyo3::{prelude::*, types::PyDict};
use std::{path::PathBuf, sync::Arc};

/// The strands of a hairstyle as authored. Immutable.
///
/// Strand `s` owns the points `offsets[s]` to `offsets[s + 1]`, root first. Arrays are read-only views.
///
/// Parameters
/// ----------
/// points : array [points, 3], float32
///     Positions of all strands, one strand after the other [m], Y up.
/// offsets : array [strands + 1], uint32
///     Index of each strand's first point, followed by the number of points.
/// radii : float or array [points], default 35e-6
///     Fiber radius [m].
/// groups : array [strands], uint16, optional
///     Group of each strand; a simulation has one material for each group.
/// root_uvs : array [strands, 2], float32, optional
///     Texture coordinates of each root on the scalp.
/// colors : array [points, 3], float32, optional
///     Linear RGB from 0 to 1.
/// guides : array [strands, 3], uint32, optional
///     Guide strands of each strand; unused entries repeat the first one.
/// guide_weights : array [strands, 3], float32, optional
///     Weight of each guide; they sum to 1.
/// stiffness, damping, drag, friction, charge : array [strands], float32, optional
///     Factors of the material's `bend`, `damping`, `drag`, `friction` and `charge` for each strand, 0 or more.
///
/// Raises
/// ------
/// SettingError
///     An array has a wrong shape, or a coordinate is not finite.
#[pyclass(frozen, module = "hairspring")]
pub struct Groom {
    pub inner: Arc<groom::Groom>,
    notes: Vec<String>,
}

impl Groom {
    /// A groom that was not read from a file.
    pub fn of(inner: groom::Groom) -> Self {
        Self { inner: Arc::new(inner), notes: Vec::new() }
    }
}

/// The arrays of a groom, as Python passes them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Arrays<'py> {
    points: Floats<'py>,
    offsets: Indices<'py>,
    #[pyo3(default)]
    radii: Option<Floats<'py>>,
    #[pyo3(default)]
    groups: Option<Indices<'py>>,
    #[pyo3(default)]
    root_uvs: Option<Floats<'py>>,
    #[pyo3(default)]
    colors: Option<Floats<'py>>,
    #[pyo3(default)]
    guides: Option<Indices<'py>>,
    #[pyo3(default)]
    guide_weights: Option<Floats<'py>>,
    #[pyo3(default)]
    stiffness: Option<Floats<'py>>,
    #[pyo3(default)]
    damping: Option<Floats<'py>>,
    #[pyo3(default)]
    drag: Option<Floats<'py>>,
    #[pyo3(default)]
    friction: Option<Floats<'py>>,
    #[pyo3(default)]
    charge: Option<Floats<'py>>,
    #[pyo3(default)]
    flatness: Option<Floats<'py>>,
    #[pyo3(default)]
    tether: Option<Floats<'py>>,
}

impl Arrays<'_> {
    /// The factors of the material for each strand; empty if all are 1.
    fn scales(&self, strands: usize) -> PyResult<Vec<StrandScale>> {
        let given = [
            ("stiffness", &self.stiffness),
            ("damping", &self.damping),
            ("drag", &self.drag),
            ("friction", &self.friction),
            ("charge", &self.charge),
            ("flatness", &self.flatness),
            ("tether", &self.tether),
        ];
        let mut scales = Vec::new();
        for (name, array) in given {
            let Some(array) = array else { continue };
            let numbers = array.numbers()?;
            if numbers.len() != strands || !numbers.iter().all(|n| n.is_finite() && *n >= 0.0) {
                return Err(setting(format!(
                    "`{name}` must be {strands} numbers of 0 or more, one for each strand"
                )));
            }
            scales.resize(strands, StrandScale::default());
            for (scale, n) in scales.iter_mut().zip(numbers) {
                match name {
                    "stiffness" => scale.bend = *n,
                    "damping" => scale.damping = *n,
                    "drag" => scale.drag = *n,
                    "friction" => scale.friction = *n,
                    "charge" => scale.charge = *n,
                    "flatness" => scale.flatness = *n,
                    _ => scale.tether = *n,
                }
            }
        }
        Ok(scales)
    }
}

/// Makes a groom of the arrays in a dict, after a check of their shapes.
pub fn from_arrays(arrays: &Bound<'_, PyDict>) -> PyResult<groom::Groom> {
    arrays.extract::<Arrays>()?.groom()
}

impl Arrays<'_> {
    fn groom(&self) -> PyResult<groom::Groom> {
        let points: &[Vec3] = self.points.rows::<_, 3>("points")?;
        let offsets = self.offsets.numbers()?;
        let ordered = offsets.windows(2).all(|w| w[0] <= w[1]);
        if offsets.first() != Some(&0)
            || !ordered
            || offsets.last().map(|n| *n as usize) != Some(points.len())
        {
            let text = "`offsets` must begin with 0, not decrease, and end with the number of points";
            return Err(setting(text));
        }
        if let Some(bad) = points.iter().position(|p| !p.is_finite()) {
            return Err(setting(format!("point {bad} is not finite")));
        }
        let strands = offsets.len() - 1;
        let radii = match &self.radii {
            None => vec![DEFAULT_RADIUS; points.len()],
            Some(radii) => match radii.numbers()? {
                [one] => vec![*one; points.len()],
                many => many.to_vec(),
            },
        };
        if radii.len() != points.len() || !radii.iter().all(|r| r.is_finite() && *r > 0.0) {
            return Err(setting("`radii` must be one number above 0 [m], or one for each point"));
        }
        let groups = match &self.groups {
            None => Vec::new(),
            Some(groups) => {
                let narrow = |g: &u32| u16::try_from(*g).map_err(|_| setting("a group is larger than 65535"));
                groups.numbers()?.iter().map(narrow).collect::<PyResult<_>>()?
            }
        };
        let root_uvs = self.root_uvs.as_ref().map_or(Ok(&[] as &[Vec2]), |a| a.rows::<_, 2>("root_uvs"))?;
        let colors = self.colors.as_ref().map_or(Ok(&[] as &[Vec3]), |a| a.rows::<_, 3>("colors"))?;
        let guides = match (&self.guides, &self.guide_weights) {
            (None, None) => Vec::new(),
            (Some(guides), Some(weights)) => {
                let (guides, weights) =
                    (guides.triples("guides")?, weights.rows::<[f32; 3], 3>("guide_weights")?);
                if guides.len() != weights.len() || guides.iter().flatten().any(|g| *g as usize >= strands) {
                    return Err(setting("`guides` must name strands of the groom, with one weight each"));
                }
                if !weights.iter().all(|w| w.iter().all(|w| w.is_finite() && *w >= 0.0)) {
                    return Err(setting("`guide_weights` must be finite and 0 or more"));
                }
                guides.iter().zip(weights).map(|(g, w)| GuideWeights { guides: *g, weights: *w }).collect()
            }
            _ => return Err(setting("`guides` and `guide_weights` belong together")),
        };
        fits("groups", groups.len(), strands, "strands")?;
        fits("root_uvs", root_uvs.len(), strands, "strands")?;
        fits("guides", guides.len(), strands, "strands")?;
        fits("colors", colors.len(), points.len(), "points")?;
        Ok(groom::Groom {
            points: points.to_vec(),
            radii,
            offsets: offsets.to_vec(),
            groups,
            root_uvs: root_uvs.to_vec(),
            colors: colors.to_vec(),
            guides,
            scales: self.scales(strands)?,
            ..groom::Groom::default()
        })
    }
}

/// Checks that an optional array has one entry for each of `what`.
fn fits(name: &str, length: usize, expected: usize, what: &str) -> PyResult<()> {
    if length == 0 || length == expected {
        return Ok(());
    }
    Err(setting(format!("`{name}` has {length} entries for {expected} {what}")))
}

#[pymethods]
impl Groom {
    #[new]
    #[pyo3(signature = (points, offsets, *, radii=None, groups=None, root_uvs=None, colors=None, guides=None, guide_weights=None, stiffness=None, damping=None, drag=None, friction=None, charge=None, flatness=None, tether=None))]
    #[expect(clippy::too_many_arguments, reason = "one for each array; keywords in Python")]
    fn new(
        points: Floats,
        offsets: Indices,
        radii: Option<Floats>,
        groups: Option<Indices>,
        root_uvs: Option<Floats>,
        colors: Option<Floats>,
        guides: Option<Indices>,
        guide_weights: Option<Floats>,
        stiffness: Option<Floats>,
        damping: Option<Floats>,
        drag: Option<Floats>,
        friction: Option<Floats>,
        charge: Option<Floats>,
        flatness: Option<Floats>,
        tether: Option<Floats>,
    ) -> PyResult<Self> {
        let arrays = Arrays {
            points,
            offsets,
            radii,
            groups,
            root_uvs,
            colors,
            guides,
            guide_weights,
            stiffness,
            damping,
            drag,
            friction,
            charge,
            flatness,
            tether,
        };
        arrays.groom().map(Self::of)
    }

    /// Reads a groom file: .hair, .tfx, .data or .obj.
    ///
    /// `scale` is the length of the file's unit [m], and `up` its vertical axis, "y" or "z"; without them, they are taken from
    /// the file or guessed. `notes` then says what was guessed and repaired.
    #[staticmethod]
    #[pyo3(signature = (path, *, scale=None, up=None))]
    fn read(py: Python<'_>, path: PathBuf, scale: Option<f32>, up: Option<&str>) -> PyResult<Self> {
        let options = ReadOptions { scale, up: axis(up)? };
        let loaded = py.detach(|| read_groom(&path, &options)).map_err(file)?;
        Ok(Self { inner: Arc::new(loaded.value), notes: loaded.notes })
    }

    /// Writes a groom file: .hair, .tfx or .data. Returns what the format cannot hold, one sentence each.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
        py.detach(|| write_groom(&path, &self.inner)).map_err(file)
    }

    /// Returns a copy whose strands begin at the other end.
    fn reversed(&self) -> Self {
        let mut groom = (*self.inner).clone();
        groom.reverse();
        Self::of(groom)
    }

    /// What was guessed and repaired when the file was read, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Number of strands.
    fn __len__(&self) -> usize {
        self.inner.strand_count()
    }

    /// Positions [points, 3], float32 [m].
    #[getter]
    fn points<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        // SAFETY: the class is frozen and its groom is never changed.
        unsafe { shared_rows::<_, 3>(&this.get().inner.points, this.clone().into_any()) }
    }

    /// First point of each strand, then the number of points: [strands + 1], uint32.
    #[getter]
    fn offsets<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        // SAFETY: as for `points`.
        unsafe { shared(&this.get().inner.offsets, this.clone().into_any()) }
    }

    /// Fiber radius at each point: [points], float32 [m].
    #[getter]
    fn radii<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        // SAFETY: as for `points`.
        unsafe { shared(&this.get().inner.radii, this.clone().into_any()) }
    }

    /// Group of each strand: [strands], uint16; or None.
    #[getter]
    fn groups<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray1<u16>>>> {
        let groups = &this.get().inner.groups;
        // SAFETY: as for `points`.
        (!groups.is_empty()).then(|| unsafe { shared(groups, this.clone().into_any()) }).transpose()
    }

    /// Names of the groups; may be shorter than the highest group.
    #[getter]
    fn group_names(&self) -> Vec<String> {
        self.inner.group_names.clone()
    }

    /// Texture coordinates of the roots: [strands, 2], float32; or None.
    #[getter]
    fn root_uvs<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let uvs = &this.get().inner.root_uvs;
        // SAFETY: as for `points`.
        (!uvs.is_empty()).then(|| unsafe { shared_rows::<_, 2>(uvs, this.clone().into_any()) }).transpose()
    }

    /// Linear RGB of each point: [points, 3], float32; or None.
    #[getter]
    fn colors<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<f32>>>> {
        let colors = &this.get().inner.colors;
        // SAFETY: as for `points`.
        (!colors.is_empty())
            .then(|| unsafe { shared_rows::<_, 3>(colors, this.clone().into_any()) })
            .transpose()
    }

    /// Guides of each strand, [strands, 3] uint32, and their weights, [strands, 3] float32; or None.
    #[getter]
    #[expect(clippy::type_complexity, reason = "a pair of arrays")]
    fn guides<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Option<(Bound<'py, PyArray2<u32>>, Bound<'py, PyArray2<f32>>)>> {
        let guides = &self.inner.guides;
        if guides.is_empty() {
            return Ok(None);
        }
        let (strands, weights): (Vec<[u32; 3]>, Vec<[f32; 3]>) =
            guides.iter().map(|g| (g.guides, g.weights)).unzip();
        Ok(Some((
            PyArray2::from_owned_array(py, numpy::ndarray::Array2::from(strands)),
            PyArray2::from_owned_array(py, numpy::ndarray::Array2::from(weights)),
        )))
    }

    /// Factors of the material for each strand: a dict of `stiffness`, `damping`, `drag`, `friction`, `charge`,
    /// `flatness` and `tether`, [strands] float32; or None.
    #[getter]
    fn factors<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let scales = &self.inner.scales;
        let factors = PyDict::new(py);
        let of = |pick: fn(&StrandScale) -> f32| PyArray1::from_iter(py, scales.iter().map(pick));
        factors.set_item("stiffness", of(|s| s.bend))?;
        factors.set_item("damping", of(|s| s.damping))?;
        factors.set_item("drag", of(|s| s.drag))?;
        factors.set_item("friction", of(|s| s.friction))?;
        factors.set_item("charge", of(|s| s.charge))?;
        factors.set_item("flatness", of(|s| s.flatness))?;
        factors.set_item("tether", of(|s| s.tether))?;
        Ok((!scales.is_empty()).then_some(factors))
    }

    /// Points of strand `s`: [n, 3], float32 [m].
    fn strand<'py>(this: &Bound<'py, Self>, s: usize) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let groom = &this.get().inner;
        if s >= groom.strand_count() {
            let text = format!("strand {s} of {}", groom.strand_count());
            return Err(pyo3::exceptions::PyIndexError::new_err(text));
        }
        // SAFETY: as for `points`.
        unsafe { shared_rows::<_, 3>(groom.strand(s), this.clone().into_any()) }
    }

    fn __repr__(&self) -> String {
        format!("Groom({} strands, {} points)", self.inner.strand_count(), self.inner.point_count())
    }
}

/// The axis "y" or "z".
pub fn axis(name: Option<&str>) -> PyResult<Option<Axis>> {
    match name {
        None => Ok(None),
        Some("y" | "Y") => Ok(Some(Axis::Y)),
        Some("z" | "Z") => Ok(Some(Axis::Z)),
        Some(other) => Err(setting(format!("`up` must be \"y\" or \"z\", not \"{other}\""))),
    }
}
