//! The input of a simulation: a scene file, or a groom file on its own.

use crate::{console::Console, fault::Fault, frames};
use clap::{Args, ValueEnum};
use glam::Vec3;
use hairspring_io::{
    Axis, ErrorKind, Format, Inputs, ReadOptions, printable, read_body, read_groom, read_scene,
};
use hairspring_scene::{Guides, Scene, SceneGroom};
use std::path::{Path, PathBuf};

/// The conventions of a file that it does not specify.
#[derive(Args, Clone, Copy, Default)]
pub struct Units {
    /// Meters in one unit of the file, if the file does not specify it [default: guessed; the guess is
    /// printed]
    #[arg(long, value_name = "METERS", value_parser = frames::positive)]
    pub scale: Option<f32>,

    /// Axis that points up in the file [default: depends on the format]
    #[arg(long, value_name = "AXIS")]
    pub up: Option<Up>,

    /// Reverse the points of each strand of a groom, so that the last point of the file is the root
    #[arg(long)]
    pub reverse: bool,
}

impl Units {
    /// Returns an error for a scene file, which sets them per file.
    pub fn refuse_for_scene(self) -> Result<(), Fault> {
        if self.scale.is_some() || self.up.is_some() {
            let text =
                "--scale and --up apply to a groom file; a scene sets them for each file that it names";
            return Err(Fault::Usage(text.into()));
        }
        if self.reverse {
            let text = "--reverse applies to a groom file; in a scene, set `reverse = true` in its [[groom]]";
            return Err(Fault::Usage(text.into()));
        }
        Ok(())
    }
}

/// The axis that points up.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Up {
    /// Y points up.
    Y,
    /// Z points up.
    Z,
}

impl From<Units> for ReadOptions {
    fn from(units: Units) -> Self {
        let up = units.up.map(|up| match up {
            Up::Y => Axis::Y,
            Up::Z => Axis::Z,
        });
        Self { scale: units.scale, up }
    }
}

/// The input of a simulation and the settings that override it.
#[derive(Args)]
pub struct Input {
    /// A scene (.toml), or a groom (.hair, .tfx, .data, .csv, .ply, or lines in .obj, .glb and .gltf; .usd and .abc with the
    /// Python package) that hangs still under gravity
    #[arg(value_name = "SCENE|GROOM")]
    pub path: PathBuf,

    #[command(flatten)]
    pub units: Units,

    /// Strands to simulate in each groom, and in the brows of the built-in head, at least one for each group; the others
    /// follow. A number, `all`, or `file` for the guides that the file names [default: from the scene, otherwise `file`, or 2000 if the file names none]
    #[arg(long, value_name = "N|all|file", value_parser = frames::guides)]
    pub guides: Option<Guides>,

    /// Substeps per 1/60 s, for any frame rate [default: from the scene, otherwise 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub substeps: Option<u32>,
}

impl Input {
    /// Options that change the result, for a manifest: see [`hairspring_io::Origin`].
    pub fn options(&self) -> [(&'static str, Option<String>); 4] {
        let guides = |guides| match guides {
            Guides::All => "all".into(),
            Guides::FromGroom => "file".into(),
            Guides::Count(n) => n.to_string(),
        };
        let up = |up| if up == Up::Y { "y" } else { "z" };
        [
            ("scale", self.units.scale.map(|scale| scale.to_string())),
            ("up", self.units.up.map(|axis| up(axis).into())),
            ("guides", self.guides.map(guides)),
            ("substeps", self.substeps.map(|n| n.to_string())),
        ]
    }

    /// Reads the scene and records the files that it consists of.
    pub fn scene_and_files(&self, console: Console) -> Result<(Scene, Inputs), Fault> {
        let (scene, files) = Inputs::record(&self.path, || self.scene(console));
        Ok((scene?, files))
    }

    /// Reads the scene.
    pub fn scene(&self, console: Console) -> Result<Scene, Fault> {
        let path = &self.path;
        let mut scene = if Format::of(path) == Some(Format::Scene) {
            self.units.refuse_for_scene()?;
            let loaded = read_scene(path).map_err(|e| Fault::reading(e, path))?;
            print_notes(&loaded.notes, console);
            loaded.value
        } else {
            let mut loaded = read_groom(path, &self.units.into()).map_err(|e| match e {
                hairspring_io::Error::Unsupported { .. } if Format::of(path).is_none() => {
                    unknown_extension(path)
                }
                other => Fault::reading(other, path),
            })?;
            print_notes(&loaded.notes, console);
            if self.units.reverse {
                loaded.value.reverse();
            }
            let mut scene = alone(path, loaded.value);
            if Format::of(path).is_some_and(|format| Format::EXTERNAL.contains(&format)) {
                self.add_body(&mut scene, console)?;
            }
            scene
        };
        if let Some(guides) = self.guides {
            scene.grooms.iter_mut().for_each(|g| g.guides = guides);
        }
        if let Some(substeps) = self.substeps {
            scene.solver.substeps = substeps;
        }
        Ok(scene)
    }
}

impl Input {
    /// Adds the meshes of the groom's own file to the scene, if it has any.
    ///
    /// # Errors
    /// Returns an error if they cannot be read.
    fn add_body(&self, scene: &mut Scene, console: Console) -> Result<(), Fault> {
        match read_body(&self.path, &self.units.into()) {
            Ok(loaded) => {
                print_notes(&loaded.notes, console);
                (scene.body, scene.vertex_cache) = (Some(loaded.value.body), loaded.value.vertex_cache);
            }
            Err(why) if why.kind() == ErrorKind::Unsupported => {
                console.note(format_args!("the hair has no body: {why}"));
            }
            Err(why) => return Err(Fault::reading(why, &self.path)),
        }
        Ok(())
    }
}

/// The error for a file that is neither a scene nor a groom.
pub fn unknown_extension(path: &Path) -> Fault {
    Fault::Usage(format!(
        "{}: unknown extension; a scene is read from .toml, a groom from .hair, .tfx, .data, .csv, .ply, .obj, .glb or .gltf",
        path.display()
    ))
}

/// A scene with only a groom: fixed roots and gravity.
fn alone(path: &Path, groom: hairspring::groom::Groom) -> Scene {
    Scene {
        name: printable(&path.file_stem().unwrap_or_default().to_string_lossy()).into_owned(),
        grooms: vec![SceneGroom { groom, ..SceneGroom::default() }],
        gravity: Vec3::new(0.0, -9.81, 0.0),
        ..Scene::default()
    }
}

/// Prints what a reader guessed, left out and repaired.
pub fn print_notes(notes: &[String], console: Console) {
    notes.iter().for_each(|n| console.note(n));
}
