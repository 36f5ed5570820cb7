//! Runs the program as a user does, and writes small files for it to read.

// Each test file uses some of this.
#![allow(dead_code)]

use glam::Vec3;
use hairspring::groom::Groom;
use openh264::{decoder::Decoder, formats::YUVSource};
use std::{
    ffi::OsStr,
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

/// The program with `arguments`, in `folder`.
pub fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairspring"));
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command
}

/// Runs the program in `folder`.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments).output().unwrap()
}

/// Runs the program in `folder`; it must fail with this exit code. Returns its standard error.
pub fn fail(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = run(folder, arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    stderr
}

/// Runs the program in `folder`; it must succeed. Returns what it prints.
pub fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Names of the files in `folder`, sorted, including hidden ones.
pub fn names(folder: &Path) -> Vec<String> {
    let name = |f: std::io::Result<std::fs::DirEntry>| f.unwrap().file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = std::fs::read_dir(folder).unwrap().map(name).collect();
    names.sort();
    names
}

/// Bytes of each file in `folder`, by name.
pub fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    names(folder).into_iter().map(|n| (n.clone(), std::fs::read(folder.join(n)).unwrap())).collect()
}

/// Strands of 20 cm that start sideways on a disc of 10 cm and droop, with 8 to 11 points each.
pub fn groom(strands: usize) -> Groom {
    let strand = |s: usize| {
        let angle = s as f32 * 2.4;
        let out = Vec3::new(angle.cos(), 0.2, angle.sin()).normalize();
        let points = 8 + s % 4;
        (0..points).map(move |i| {
            let t = i as f32 / (points - 1) as f32;
            out * (0.1 + 0.2 * t) - Vec3::Y * 0.05 * t * t
        })
    };
    Groom::from_strands((0..strands).map(|s| strand(s).collect::<Vec<_>>()), 4e-5)
}

/// Writes [`groom`] to `folder` as `groom.hair`.
pub fn write_groom(folder: &Path, strands: usize) -> PathBuf {
    let path = folder.join("groom.hair");
    hairspring_io::write_groom(&path, &groom(strands)).unwrap();
    path
}

/// Writes `scene.toml` and its groom to `folder`: a sphere collider, and a gusty wind that moves all
/// strands.
pub fn write_scene(folder: &Path, strands: usize) {
    write_groom(folder, strands);
    let scene = r#"
        [[groom]]
        file = "groom.hair"
        scale = 1.0
        guides = 60

        [[collider]]
        shape.sphere = { center = [0.0, 0.0, 0.0], radius = 0.09 }

        [wind]
        velocity = [3.0, 0.0, 1.0]
        gust = 0.5
        gust_rate = 1.0
    "#;
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
}

/// Parses JSON that the program printed.
pub fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text:?}"))
}

/// The number of frames of a clip that decode, and its size.
pub fn play(path: &Path) -> (u32, (u16, u16)) {
    let file = File::open(path).unwrap();
    let size = file.metadata().unwrap().len();
    let mut reader = mp4::Mp4Reader::read_header(BufReader::new(file), size).unwrap();
    let (&id, track) = reader.tracks().iter().next().unwrap();
    let (count, size) = (track.sample_count(), (track.width(), track.height()));
    let mut unit = vec![];
    for set in [track.sequence_parameter_set().unwrap(), track.picture_parameter_set().unwrap()] {
        unit.extend([0, 0, 0, 1]);
        unit.extend(set);
    }
    let mut decoder = Decoder::new().unwrap();
    let mut shown = 0;
    for n in 1..=count {
        let sample = reader.read_sample(id, n).unwrap().unwrap();
        let mut rest = &sample.bytes[..];
        while rest.len() > 4 {
            let (length, after) = rest.split_first_chunk::<4>().unwrap();
            let (bytes, next) = after.split_at(u32::from_be_bytes(*length) as usize);
            unit.extend([0, 0, 0, 1]);
            unit.extend(bytes);
            rest = next;
        }
        if let Some(yuv) = decoder.decode(&unit).unwrap() {
            assert_eq!(yuv.dimensions(), (size.0.into(), size.1.into()));
            shown += 1;
        }
        unit.clear();
    }
    (shown, size)
}

/// A path as text.
pub fn text(path: &impl AsRef<OsStr>) -> &str {
    path.as_ref().to_str().unwrap()
}
