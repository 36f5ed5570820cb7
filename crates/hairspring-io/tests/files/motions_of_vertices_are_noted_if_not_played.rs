//! Promise: a note names each mesh of a scene whose file moves its vertices, as USD and Alembic do, if that motion is not
//! played.

use crate::gltf_file::GltfFile;
use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::{
    CacheDescription, CacheWriter, Character, ExternalError, ExternalFile, ExternalFormats, ReadOptions,
    gltf, read_scene, set_external_formats,
};
use hairspring_scene::VertexCache;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// A tetrahedron whose vertices move, for any file.
struct Moving;

impl ExternalFormats for Moving {
    fn read_groom(&self, _: &Path, _: &ReadOptions) -> Result<ExternalFile<Groom>, ExternalError> {
        Err(ExternalError::Absent("it has no curves".into()))
    }

    fn read_body(&self, _: &Path, _: &ReadOptions) -> Result<ExternalFile<Character>, ExternalError> {
        let (mut value, _) = gltf::parse(&GltfFile::tetrahedron().glb(), &|_| None).unwrap();
        let rest = value.body.mesh.positions.clone();
        let moved = rest.iter().map(|p| *p + Vec3::Y).collect();
        value.vertex_cache = Some(VertexCache { rate: 24.0, frames: vec![rest, moved] });
        Ok(ExternalFile { value, unit_known: true, notes: Vec::new() })
    }

    fn used_files(&self, _: &Path) -> Result<Vec<PathBuf>, String> {
        Ok(Vec::new())
    }

    fn write_cache(&self, _: &Path, _: &CacheDescription) -> Result<Box<dyn CacheWriter>, String> {
        Err("not in this test".into())
    }
}

#[test]
fn motions_of_vertices_that_are_not_played_are_noted() {
    set_external_formats(Box::new(Moving));
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("head.glb"), GltfFile::tetrahedron().glb()).unwrap();
    ["body.abc", "other.abc"].into_iter().for_each(|name| fs::write(path(name), "moving").unwrap());
    let hair = "[[groom]]\nguides = \"all\"\n[groom.grow]\nstrands = 20\nlength = 0.05\n";
    let notes = |rest: &str| {
        fs::write(path("a.toml"), format!("{hair}{rest}\n")).unwrap();
        let notes = read_scene(&path("a.toml")).unwrap().notes;
        notes.into_iter().filter(|note| note.contains("not played")).collect::<Vec<_>>()
    };
    let text = "the file has 1 motion (that of its vertices), which is not played";
    let head = "[body]\nfile = \"head.glb\"\n";
    for (rest, file, end) in [
        (
            format!("{head}[[body.more]]\nfile = \"other.abc\"\njoint = \"Head\""),
            "other.abc",
            "; the mesh moves with the joints of the [body]",
        ),
        (
            format!("{head}[collision]\nfile = \"other.abc\"\njoint = \"Head\""),
            "other.abc",
            "; the mesh moves with the joints of the [body]",
        ),
        (
            format!("{head}[[sheet]]\nfile = \"other.abc\"\njoint = \"Head\""),
            "other.abc",
            "; the mesh moves with the joints of the [body]",
        ),
        (
            format!("{head}[[prop]]\nname = \"Rope\"\nmesh = {{ file = \"other.abc\" }}"),
            "other.abc",
            "; the [[prop]] moves by its `keys`",
        ),
        (
            format!("{head}[[collider]]\nshape = {{ hull = {{ file = \"other.abc\" }} }}"),
            "other.abc",
            "; the hull moves with the `joint` of its [[collider]]",
        ),
        (
            "[body]\nfile = \"body.abc\"\n[clip]\nkeys = [{ time = 0 }, { time = 1, position = [0, 1, 0] }]"
                .into(),
            "body.abc",
            "; [clip] replaces it",
        ),
    ] {
        assert_eq!(notes(&rest), [format!("{file}: {text}{end}")], "{rest}");
    }
    // The body plays its own.
    assert_eq!(notes("[body]\nfile = \"body.abc\""), Vec::<String>::new());
}
