//! Promise: the unit of a body is guessed from its size and shape, and from the hair that grows on it: a head in
//! centimeters is no adult in decimeters.

use crate::ellipsoid::write_ellipsoid;
use glam::Vec3;
use hairspring_io::{ReadOptions, read_body, read_scene};
use std::{f32::consts::TAU, fmt::Write, fs, path::Path};

/// Writes strands of 20 cm on top of the body as a `.csv` file, times `unit`.
fn write_hair(path: &Path, top: Vec3, unit: f32) {
    let mut text = "strand,x,y,z\n".to_owned();
    for s in 0..24 {
        for k in 0..6 {
            let angle = TAU * s as f32 / 24.0;
            let p = (top + Vec3::new(0.002 * angle.cos(), 0.04 * k as f32, 0.002 * angle.sin())) * unit;
            writeln!(text, "{s},{},{},{}", p.x, p.y, p.z).unwrap();
        }
    }
    fs::write(path, text).unwrap();
}

#[test]
fn a_head_in_centimeters_is_no_adult_in_decimeters() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    let unit = |sides: Vec3| {
        write_ellipsoid(&path, Vec3::Y * 30.0, 0.5 * sides);
        read_body(&path, &ReadOptions::default()).unwrap().scale
    };
    for height in 15..=27 {
        let sides = Vec3::new(0.7, 1.0, 0.85) * height as f32;
        assert_eq!(unit(sides), 0.01, "a head of {height} units");
        assert_eq!(unit(sides * 10.0 / 7.0), 0.01, "a bust of {} units", height as f32 / 0.7);
    }
    // An adult is not as deep.
    for height in [15.5, 17.0, 19.0] {
        assert_eq!(unit(Vec3::new(0.9, 1.0, 0.25) * height), 0.1, "an adult of {height} units");
        assert_eq!(unit(Vec3::new(0.9, 1.0, 0.25) * 10.0 * height), 0.01);
    }
}

#[test]
fn the_hair_of_a_scene_decides_between_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let read = |more: &str| {
        let text = format!("[body]\nfile = \"a.obj\"\n[[groom]]\nfile = \"a.csv\"\n{more}\n");
        fs::write(path("a.toml"), text).unwrap();
        let loaded = read_scene(&path("a.toml")).unwrap();
        let (lo, hi) = loaded.value.body.as_ref().unwrap().mesh.bounds().unwrap();
        (hi.y - lo.y, loaded.notes.join("\n"))
    };
    // A face as flat as an adult in centimeters, and a head in millimeters that may be an adult in centimeters.
    for (sides, unit) in [(Vec3::new(0.15, 0.2, 0.06), 100.0), (Vec3::new(0.16, 0.23, 0.19), 1000.0)] {
        let center = Vec3::Y * 1.6;
        write_ellipsoid(&path("a.obj"), center * unit, 0.5 * sides * unit);
        for (of_hair, more) in [(1.0, "scale = 1.0"), (1.0, ""), (unit, "")] {
            write_hair(&path("a.csv"), center + Vec3::Y * 0.5 * sides, of_hair);
            let (height, notes) = read(more);
            assert!((height - sides.y).abs() < 1e-3, "{of_hair}, {more}: {height} m\n{notes}");
            assert!(notes.contains("puts the roots of the hair on its skin"), "{notes}");
            assert!(!notes.contains("from the skin"), "{notes}");
        }
        // Hair that fits no unit leaves the guess by size.
        write_hair(&path("a.csv"), Vec3::X * 50.0, 1.0);
        assert!(read("scale = 1.0").0 > 1.5);
    }
    // A unit that the scene sets stays.
    write_hair(&path("a.csv"), Vec3::ZERO, 1.0);
    let text = "[body]\nfile = \"a.obj\"\nscale = 0.01\n[[groom]]\nfile = \"a.csv\"\n";
    fs::write(path("a.toml"), text).unwrap();
    let (lo, hi) = read_scene(&path("a.toml")).unwrap().value.body.unwrap().mesh.bounds().unwrap();
    assert!((hi.y - lo.y - 2.3).abs() < 0.01);
}
