//! Scene files, with small files that they refer to.

use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::{Error, Loaded, read_scene, write_groom};
use hairspring_scene::Scene;
use std::{fs, path::Path};
use tempfile::TempDir;

/// A folder with a groom `hair.data` and a mesh `head.obj`.
pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let strands =
        (0..5).map(|i| (0..4).map(|k| Vec3::new(0.1 * i as f32, 0.1 * k as f32, 0.0)).collect::<Vec<_>>());
    write_groom(&folder.path().join("hair.data"), &Groom::from_strands(strands, 4e-5)).unwrap();
    let mesh = "g scalp\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3\ng neck\nf 1 3 4\n";
    fs::write(folder.path().join("head.obj"), mesh).unwrap();
    let nod = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Yrotation Xrotation\nJOINT Head\n{\nOFFSET 0 0.6 0\n\
               CHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 0.2 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.02\n\
               0 0 0 0 0 0\n0 0 0 0 10 0\n0 0 0 0 20 0\n";
    fs::write(folder.path().join("nod.bvh"), nod).unwrap();
    folder
}

/// Reads a scene with this text in the folder.
pub fn read(folder: &Path, text: &str) -> Result<Loaded<Scene>, Error> {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    read_scene(&path)
}

/// The error message for a scene, without the folder's name.
pub fn message(text: &str) -> String {
    let folder = folder();
    let error = read(folder.path(), text).expect_err(text);
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}
