//! Scene files: TOML that names grooms, a body, its motion and settings (`docs/scene.md` shows every field).

mod body;
mod check;
mod file;
mod grow;
mod motion;
mod sentence;

use crate::{
    Error, Format, Loaded, Problem, ReadOptions, Result, load, read_bones, read_groom, text::as_text,
    tfxbone::RootBones,
};
use file::{FileName, GroomFile, OneOrMore, SceneFile};
use glam::{Affine3A, EulerRot, Quat};
use hairspring::{
    body::Body,
    groom::{Groom, Repairs, bind_roots_where, thicken},
    material::{self, Material},
    scene::{Scene, SceneGroom},
};
use sentence::{line_at, line_of_key, problem, problem_in_table, unknown};
use std::path::{Path, PathBuf};

/// Reads a scene file and all files that it names, relative to its own folder.
///
/// # Errors
/// A field that is not known (with its line and the nearest right name), a value out of range, a named file that is
/// missing or broken, or parts that do not fit together (a joint or motion that is not there).
pub fn read_scene(path: &Path) -> Result<Loaded<Scene>> {
    if Format::of(path) != Some(Format::Scene) {
        let reason = "a scene is read from .toml, told by the extension".into();
        return Err(Error::Unsupported { path: path.to_owned(), reason });
    }
    let data = load::bytes_of(path)?;
    let text = as_text(&data);
    let file = parse(&text).map_err(|p| p.in_file(path))?;
    Reader { path, text: &text, notes: Vec::new(), repairs: Repairs::default() }.scene(file)
}

/// Reads the text of a scene file without the files that it names: whether all fields are known and in range.
///
/// # Errors
/// As [`read_scene`], but for what concerns other files.
pub fn check_text(text: &str) -> std::result::Result<(), Problem> {
    parse(text).map(|_| ())
}

fn parse(text: &str) -> std::result::Result<SceneFile, Problem> {
    let file: SceneFile = toml::from_str(text).map_err(|e| problem(text, &e))?;
    check::ranges(text, &file)?;
    for groom in &file.groom {
        materials(text, &file, groom)?;
    }
    Ok(file)
}

/// The materials of a groom, one a group.
fn materials(
    text: &str,
    scene: &SceneFile,
    groom: &GroomFile,
) -> std::result::Result<Vec<Material>, Problem> {
    let names: &[String] = match &groom.material {
        None => &[],
        Some(OneOrMore::One(name)) => std::slice::from_ref(name),
        Some(OneOrMore::More(names)) => names,
    };
    let known = || scene.material.keys().map(String::as_str).chain(material::PRESETS);
    names
        .iter()
        .map(|name| match (scene.material.get(name), material::preset(name)) {
            (Some(table), _) => overlaid(text, table),
            (None, Some(preset)) => Ok(preset),
            (None, None) => {
                let line = line_of_key(text, line_at(text, groom.start()), "material").unwrap_or(1);
                Err(Problem::line(line, format!("the material {}", unknown(name, known()))))
            }
        })
        .collect()
}

/// A `[material.NAME]`: its preset with the given fields over it.
fn overlaid(text: &str, table: &toml::Spanned<toml::Table>) -> std::result::Result<Material, Problem> {
    let start = table.span().start;
    let mut fields = table.get_ref().clone();
    let base = match fields.remove("preset") {
        None => Material::default(),
        Some(value) => value.as_str().and_then(material::preset).ok_or_else(|| {
            let line = line_of_key(text, line_at(text, start), "preset").unwrap_or(1);
            let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            Problem::line(line, format!("the preset {}", unknown(&name, material::PRESETS)))
        })?,
    };
    let in_table = |e: &toml::de::Error| problem_in_table(text, start, e);
    let mut all = toml::Table::try_from(&base).map_err(|e| Problem::whole(e.to_string()))?;
    all.extend(fields);
    let material: Material = all.try_into().map_err(|e| in_table(&e))?;
    check::material(text, line_at(text, start), &material)?;
    Ok(material)
}

/// Follows a scene file's names to their files.
struct Reader<'a> {
    path: &'a Path,
    text: &'a str,
    notes: Vec<String>,
    repairs: Repairs,
}

impl Reader<'_> {
    fn scene(mut self, file: SceneFile) -> Result<Loaded<Scene>> {
        let character = file.body.as_ref().map(|b| self.body(b, "body")).transpose()?;
        let collision = file.collision.as_ref().map(|b| self.body(b, "collision mesh")).transpose()?;
        let mut scene = Scene {
            name: file.name.clone().unwrap_or_else(|| stem(self.path)),
            colliders: file.collider.clone(),
            wind: file.wind,
            gravity: file.gravity,
            solver: file.solver,
            volume: file.volume,
            neighbours: file.neighbours,
            camera: file.camera,
            ..Scene::default()
        };
        for groom in &file.groom {
            let materials = materials(self.text, &file, groom).map_err(|p| p.in_file(self.path))?;
            scene.grooms.push(self.groom(groom, materials, character.as_ref().map(|c| &c.body))?);
        }
        let (body, clip) = self.motion(file.clip.as_ref(), character)?;
        scene.collision = match (collision, &body, &file.collision) {
            (Some(collision), Some(body), Some(named)) => Some(self.carried(collision.body, body, named)?),
            (collision, ..) => collision.map(|c| c.body),
        };
        (scene.body, scene.clip) = (body, clip);
        self.colliders(&scene)?;
        Ok(Loaded {
            value: scene,
            format: Format::Scene,
            scale: 1.0,
            repairs: self.repairs,
            notes: self.notes,
        })
    }

    /// The path of a file that the scene names.
    fn resolve(&self, name: &FileName) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name.get_ref())
    }

    /// What a reader returned for the file `name`, with who asked for it if it is not there.
    fn named<T>(&self, result: Result<T>, name: &FileName, what: &str) -> Result<T> {
        result.map_err(|error| match error {
            Error::NotFound { path, .. } => {
                let line = line_at(self.text, name.span().start);
                let why = format!(": it is the {what} that {}, line {line}, names", self.path.display());
                Error::NotFound { path, why }
            }
            other => other,
        })
    }

    fn note(&mut self, file: &Path, notes: Vec<String>) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        self.notes.extend(notes.into_iter().map(|n| format!("{name}: {n}")));
    }

    /// The error that the value of the key nearest after `near` is wrong.
    fn wrong(&self, near: usize, key: &str, text: String) -> Error {
        let from = line_at(self.text, near);
        Problem::line(line_of_key(self.text, from, key).unwrap_or(from), text).in_file(self.path)
    }

    fn groom(
        &mut self,
        named: &GroomFile,
        materials: Vec<Material>,
        body: Option<&Body>,
    ) -> Result<SceneGroom> {
        let mut groom = match (&named.file, &named.grow) {
            (Some(file), _) => self.read_strands(named, file)?,
            (None, Some(grow)) => self.grown(grow, body)?,
            // Refused when the text was checked.
            (None, None) => Groom::default(),
        };
        let t = named.transform;
        let [x, y, z] = t.rotation.to_array().map(f32::to_radians);
        let place = Affine3A::from_scale_rotation_translation(
            t.scale,
            Quat::from_euler(EulerRot::ZYX, z, y, x),
            t.position,
        );
        if place != Affine3A::IDENTITY {
            groom.points.iter_mut().for_each(|p| *p = place.transform_point3(*p));
        }
        if !groom.roots.is_empty() && place != Affine3A::IDENTITY {
            groom.roots.clear();
        }
        if named.thicken.copies > 0 {
            groom.roots.clear();
            thicken(&mut groom, &named.thicken, body.map(|b| &b.mesh));
        }
        if let Some(bones) = &named.bones {
            let read = self.named(read_bones(&self.resolve(bones)), bones, "bone file")?;
            self.bind_by_bones(&mut groom, &read, body, named.thicken.copies)
                .map_err(|text| self.wrong(bones.span().start, "bones", text))?;
        }
        // A material's radius is the groom's from here on: hair is drawn as thick as it is simulated.
        for s in 0..groom.strand_count() {
            let material = materials.get(groom.group(s) as usize).or(materials.last());
            if let Some(radius) = material.and_then(|m| m.radius) {
                let points = groom.range(s);
                groom.radii[points].fill(radius);
            }
        }
        Ok(SceneGroom {
            groom,
            materials,
            guides: named.guides,
            effects: named.effects,
            look: named.look.clone(),
        })
    }

    /// The strands of a groom's file.
    fn read_strands(&mut self, named: &GroomFile, file: &FileName) -> Result<Groom> {
        let path = self.resolve(file);
        let options = ReadOptions { scale: named.scale, up: named.up };
        let loaded = self.named(read_groom(&path, &options), file, "groom")?;
        self.note(&path, loaded.notes);
        let r = loaded.repairs;
        self.repairs.non_finite_points += r.non_finite_points;
        self.repairs.zero_segments += r.zero_segments;
        self.repairs.short_strands += r.short_strands;
        self.repairs.bad_radii += r.bad_radii;
        Ok(loaded.value)
    }

    /// Binds each root to skin that follows one of its bones. Copies of strands have the bones of the strand that they follow.
    fn bind_by_bones(
        &self,
        groom: &mut Groom,
        bones: &RootBones,
        body: Option<&Body>,
        copies: u32,
    ) -> std::result::Result<(), String> {
        let Some((body, skin)) = body.and_then(|b| b.skin.as_ref().map(|s| (b, s))) else {
            return Err("bones of roots need a [body] that is skinned".into());
        };
        let copies = 1 + copies as usize;
        if bones.bones.len() * copies != groom.strand_count() {
            let (n, strands) = (bones.bones.len(), groom.strand_count() / copies);
            return Err(format!(
                "the file holds the bones of {n} roots, but the groom has {strands} strands"
            ));
        }
        let joint: Vec<Option<u16>> = bones.names.iter().map(|n| body.joint(n).map(|j| j as u16)).collect();
        let of_root = |s: usize| {
            let s = s % bones.bones.len();
            let pairs = bones.bones[s].iter().zip(bones.weights[s]);
            pairs.filter(|(_, w)| *w > 0.0).filter_map(|(b, _)| joint[*b as usize])
        };
        let follows = |t: usize, j: u16| {
            let corners = body.mesh.triangles[t].iter().map(|v| *v as usize);
            corners
                .flat_map(|v| skin.joints[v].into_iter().zip(skin.weights[v]))
                .any(|(k, w)| k == j && w > 0.0)
        };
        bind_roots_where(groom, &body.mesh, |s, t| of_root(s).any(|j| follows(t, j)));
        Ok(())
    }

    /// Checks that the joints of colliders are there.
    fn colliders(&self, scene: &Scene) -> Result<()> {
        for collider in &scene.colliders {
            let Some(name) = &collider.joint else {
                continue;
            };
            let joints = scene.body.as_ref().map_or(&[][..], |b| &b.joints);
            if !joints.iter().any(|j| j.name.eq_ignore_ascii_case(name)) {
                let text = format!("the joint {}", unknown(name, joints.iter().map(|j| j.name.as_str())));
                return Err(self.wrong(self.text.find("[[collider]]").unwrap_or(0), "joint", text));
            }
        }
        Ok(())
    }
}

/// A file's name without folder and extension.
fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
