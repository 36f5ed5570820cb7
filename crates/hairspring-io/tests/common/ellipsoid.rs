//! A body that tests write as a file.

use glam::Vec3;
use std::{f32::consts::TAU, fmt::Write, fs, path::Path};

/// Writes an `.obj` file of an ellipsoid with these half axes around `center` [file units].
pub fn write_ellipsoid(path: &Path, center: Vec3, half: Vec3) {
    let (mut text, rings, around) = (String::new(), 16, 32);
    for ring in 0..=rings {
        for k in 0..around {
            let (polar, angle) = (ring as f32 / rings as f32 * TAU / 2.0, k as f32 / around as f32 * TAU);
            let out = Vec3::new(polar.sin() * angle.cos(), polar.cos(), polar.sin() * angle.sin());
            let p = center + out * half;
            writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
        }
    }
    for ring in 0..rings {
        for k in 0..around {
            let at = |r: usize, k: usize| r * around + k % around + 1;
            let corners = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
            writeln!(text, "f {} {} {} {}", corners[0], corners[1], corners[2], corners[3]).unwrap();
        }
    }
    fs::write(path, text).unwrap();
}
