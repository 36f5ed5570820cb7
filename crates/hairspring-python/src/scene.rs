//! `Scene`: the settings of a shot.

use crate::{
    errors::{file, setting},
    groom::Groom,
    mesh::Body,
    settings::{Material, Solver, Volume, Wind},
};
use glam::Vec3;
use hairspring_io::{Format, read_groom, read_scene, read_scene_text};
use hairspring_scene::{Guides, SceneGroom, builtin};
use pyo3::prelude::*;
use std::path::PathBuf;

/// A scene: grooms, body, motion and settings.
///
/// It is read from a scene file (`Scene.read`), from text in that format (`Scene.from_toml`), or made of grooms and a body.
///
/// Parameters
/// ----------
/// grooms : list of Groom
/// body : Body, optional
///     The body that the roots are bound to, at rest.
/// materials : list of Material, optional
///     One for each group; groups beyond the end use the last one.
/// guides : int or "all" or "file", default "file"
///     The simulated strands of each groom: this many, all, or those that the groom names. The others follow them.
#[pyclass(frozen, module = "hairspring")]
pub struct Scene {
    pub inner: hairspring_scene::Scene,
    notes: Vec<String>,
}

impl Scene {
    /// A scene that is complete.
    pub fn of(inner: hairspring_scene::Scene) -> Self {
        Self { inner, notes: Vec::new() }
    }
}

/// Which strands are simulated.
#[derive(FromPyObject)]
enum GuidesArgument {
    Count(u32),
    Word(String),
}

impl GuidesArgument {
    fn guides(self) -> PyResult<Guides> {
        match self {
            Self::Count(n) if n > 0 => Ok(Guides::Count(n)),
            Self::Word(word) if word == "all" => Ok(Guides::All),
            Self::Word(word) if word == "file" => Ok(Guides::FromGroom),
            _ => Err(setting("`guides` must be a number above 0, \"all\" or \"file\"")),
        }
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (grooms, *, body=None, materials=Vec::new(), guides=None))]
    fn new(
        grooms: Vec<Bound<'_, Groom>>,
        body: Option<Bound<'_, Body>>,
        materials: Vec<Material>,
        guides: Option<GuidesArgument>,
    ) -> PyResult<Self> {
        let guides = guides.map_or(Ok(Guides::FromGroom), GuidesArgument::guides)?;
        let materials: Vec<_> = materials.into_iter().map(|m| m.0).collect();
        let groom = |groom: &Bound<'_, Groom>| SceneGroom {
            groom: (*groom.get().inner).clone(),
            materials: materials.clone(),
            guides,
            ..SceneGroom::default()
        };
        Ok(Self::of(hairspring_scene::Scene {
            grooms: grooms.iter().map(groom).collect(),
            body: body.map(|body| (*body.get().inner).clone()),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            ..hairspring_scene::Scene::default()
        }))
    }

    /// Reads a scene file (.toml), or a groom file as a scene of its own.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        if Format::of(&path) == Some(Format::Scene) {
            let loaded = py.detach(|| read_scene(&path)).map_err(file)?;
            return Ok(Self { inner: loaded.value, notes: loaded.notes });
        }
        let loaded = py.detach(|| read_groom(&path, &Default::default())).map_err(file)?;
        Ok(Self {
            inner: hairspring_scene::Scene {
                name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
                grooms: vec![SceneGroom { groom: loaded.value, ..SceneGroom::default() }],
                gravity: Vec3::new(0.0, -9.81, 0.0),
                ..hairspring_scene::Scene::default()
            },
            notes: loaded.notes,
        })
    }

    /// Reads a scene from text in the format of scene files. Files that it names are relative to `folder`.
    #[staticmethod]
    #[pyo3(signature = (text, folder=PathBuf::from(".")))]
    fn from_toml(py: Python<'_>, text: &str, folder: PathBuf) -> PyResult<Self> {
        let path = folder.join("scene.toml");
        let loaded = py.detach(|| read_scene_text(&path, text)).map_err(file)?;
        Ok(Self { inner: loaded.value, notes: loaded.notes })
    }

    /// The built-in head with `strands` hairs of a style: "straight", "wavy", "curly", "coily" or "short-fur".
    #[staticmethod]
    #[pyo3(signature = (style="wavy", *, strands=100_000, guides=2000))]
    fn builtin(py: Python<'_>, style: &str, strands: u32, guides: u32) -> PyResult<Self> {
        let style = builtin::Style::from_name(style).ok_or_else(|| {
            let names = builtin::Style::ALL.map(builtin::Style::name).join(", ");
            setting(format!("there is no style `{style}`; the styles are {names}"))
        })?;
        if guides == 0 {
            return Err(setting("`guides` must be above 0"));
        }
        let guides = Guides::Count(guides);
        let options = builtin::BuiltinOptions { strands, guides, ..builtin::BuiltinOptions::new(style) };
        Ok(Self::of(py.detach(|| builtin::scene(&options))))
    }

    /// Returns a copy with other settings.
    #[pyo3(signature = (*, solver=None, volume=None, wind=None, gravity=None, guides=None))]
    fn replace(
        &self,
        solver: Option<Solver>,
        volume: Option<Volume>,
        wind: Option<Wind>,
        gravity: Option<[f32; 3]>,
        guides: Option<GuidesArgument>,
    ) -> PyResult<Self> {
        let mut inner = self.inner.clone();
        inner.solver = solver.map_or(inner.solver, |s| s.0);
        inner.volume = volume.map_or(inner.volume, |v| v.0);
        inner.wind = wind.map_or(inner.wind, |w| w.0);
        inner.gravity = gravity.map_or(inner.gravity, Vec3::from);
        if let Some(guides) = guides {
            let guides = guides.guides()?;
            inner.grooms.iter_mut().for_each(|g| g.guides = guides);
        }
        inner.validate().map_err(setting)?;
        Ok(Self { inner, notes: self.notes.clone() })
    }

    /// What was guessed and repaired when the files were read, one sentence each.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Name of the scene.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// The grooms.
    #[getter]
    fn grooms(&self) -> Vec<Groom> {
        self.inner.grooms.iter().map(|g| Groom::of(g.groom.clone())).collect()
    }

    /// The solver's settings.
    #[getter]
    fn solver(&self) -> Solver {
        Solver(self.inner.solver)
    }

    /// The hair volume's settings.
    #[getter]
    fn volume(&self) -> Volume {
        Volume(self.inner.volume)
    }

    /// The directional wind.
    #[getter]
    fn wind(&self) -> Wind {
        Wind(self.inner.wind)
    }

    /// Length of the motion [s]; None if the body is at rest.
    #[getter]
    fn duration(&self) -> Option<f64> {
        self.inner.motion_duration()
    }

    fn __repr__(&self) -> String {
        let strands: usize = self.inner.grooms.iter().map(|g| g.groom.strand_count()).sum();
        format!("Scene({:?}, {} grooms, {strands} strands)", self.inner.name, self.inner.grooms.len())
    }
}
