//! Opening a file of any kind as a scene.

use super::{Document, builtin_text};
use crate::{AppError, destination::settled};
use hairspring_io::{Format, holds_only_curves};
use std::path::{Path, PathBuf};

/// The kinds of file that open as a scene: title and extensions, for file dialogs.
pub const KINDS: [(&str, &[&str]); 4] = [
    ("Scene", &["toml"]),
    ("Groom", &["hair", "tfx", "data", "obj", "glb", "gltf", "csv", "ply"]),
    ("Body", &["glb", "gltf", "vrm", "obj", "tfxmesh"]),
    ("Motion", &["bvh"]),
];

/// What a file is to the open scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Scene,
    Groom,
    Body,
    Motion,
}

impl Role {
    fn of(path: &Path) -> Option<Self> {
        Some(match Format::of(path)? {
            Format::Scene => Self::Scene,
            Format::Hair
            | Format::Tfx
            | Format::Usc
            | Format::Csv
            | Format::Ply
            | Format::Usd
            | Format::Alembic => Self::Groom,
            Format::Obj | Format::Gltf if holds_only_curves(path) => Self::Groom,
            Format::Obj | Format::Gltf | Format::TfxMesh => Self::Body,
            Format::Bvh => Self::Motion,
            Format::TfxBone | Format::Pc2 => return None,
        })
    }
}

/// Whether opening this file takes the place of the scene. Otherwise it replaces a part of the scene.
pub fn replaces_scene(path: &Path) -> bool {
    !matches!(Role::of(path), Some(Role::Body | Role::Motion))
}

impl Document {
    /// Opens a file of any kind: a scene, or a groom in a scene of its own. A body or a motion replaces that
    /// of `current`, or that of the built-in head.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or if its extension is unknown. The files that a scene
    /// names are not read yet.
    pub fn open_any(path: &Path, current: Option<&Self>) -> Result<Self, AppError> {
        let whole = settled(path);
        let name = toml::Value::String(whole.to_string_lossy().into_owned()).to_string();
        let head;
        let current = match current {
            Some(current) => current,
            None => {
                head = Self::new(&new_scene(), builtin_text("wavy", None))?;
                &head
            }
        };
        match Role::of(path) {
            Some(Role::Scene) => Self::open(&whole),
            Some(Role::Groom) => {
                Self::new(&new_scene(), format!("[[groom]]\nfile = {name}\nmaterial = \"wavy\"\n"))
            }
            Some(Role::Body) => Ok(Self::new(&current.base(), current.with_body(&name)?)?.never_saved()),
            Some(Role::Motion) => Ok(Self::new(&current.base(), current.with_motion(&name)?)?.never_saved()),
            None => {
                let kinds = KINDS.map(|(kind, extensions)| {
                    format!("{} (.{})", kind.to_lowercase(), extensions.join(", ."))
                });
                Err(AppError::new(format!(
                    "{} is not a {}; open such a file",
                    path.display(),
                    kinds.join(", ")
                )))
            }
        }
    }

    /// The path that named files are relative to.
    pub fn base(&self) -> PathBuf {
        self.path.clone()
    }

    /// The same document, all of which counts as an unsaved change.
    pub(super) fn never_saved(mut self) -> Self {
        self.saved.clear();
        self
    }
}

/// The path of a scene without a file, in the current folder. Its name is what errors of the scene begin with.
pub fn new_scene() -> PathBuf {
    "the unsaved scene".into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_file_opens_as_a_scene() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let text = |path: &Path| Document::open_any(path, None).unwrap().text().to_owned();
        for name in ["a.hair", "a.tfx", "a.data", "a.ply", "a.TFX"] {
            let text = text(&file(name, ""));
            assert!(text.contains("[[groom]]") && text.contains(name) && !text.contains("builtin"), "{text}");
        }
        for name in ["b.glb", "b.gltf", "b.vrm", "b.tfxmesh"] {
            let text = text(&file(name, ""));
            assert!(text.contains("[body]") && text.contains("[groom.grow]"), "{text}");
        }
        let motion = text(&file("c.bvh", ""));
        assert!(motion.contains("[clip]") && motion.contains("[builtin]"), "{motion}");
        assert!(text(&file("faces.obj", "v 0 0 0\n l1\nf 1 2 3\nl 1 2\n")).contains("[body]"));
        assert!(text(&file("lines.obj", "v 0 0 0\r\n  l 1 2\r\n")).contains("[[groom]]"));
        assert_eq!(text(&file("d.toml", "[builtin]\n")), "[builtin]\n");
        let why = Document::open_any("e.gif".as_ref(), None).err().unwrap().to_string();
        assert!(why.contains("e.gif") && KINDS.iter().flat_map(|k| k.1).all(|e| why.contains(e)), "{why}");
    }

    #[test]
    fn errors_of_a_scene_without_a_file_name_no_file() {
        let mut document = Document::new(&new_scene(), builtin_text("wavy", None)).unwrap();
        let why = document.set(&"solver.substeps".parse().unwrap(), Some((-1).into())).unwrap_err();
        assert!(why.to_string().starts_with("the unsaved scene, line "), "{why}");
    }

    #[test]
    fn a_gltf_file_of_lines_opens_as_a_groom_and_a_mesh_as_a_body() {
        let folder = tempfile::tempdir().unwrap();
        let role = |name: &str, mode: u32| {
            let path = folder.path().join(name);
            let primitive = format!(r#"{{"mode":{mode},"attributes":{{"POSITION":0}}}}"#);
            let text =
                format!(r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{primitive}]}}]}}"#);
            std::fs::write(&path, text).unwrap();
            Role::of(&path)
        };
        assert_eq!(role("lines.gltf", 3), Some(Role::Groom));
        assert_eq!(role("mesh.gltf", 4), Some(Role::Body));
    }
}
