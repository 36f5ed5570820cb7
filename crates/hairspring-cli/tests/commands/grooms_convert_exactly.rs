//! Promise: `hairspring convert` changes the format of a groom and not one bit of its shape.
//!
//! A groom is converted through every format that can be written and back to the first. Its points must
//! equal the original ones. Scale and axes are applied once, when the file is read.

use crate::common::{groom, succeed};
use glam::Vec3;
use hairspring::groom::Groom;
use hairspring_io::{ReadOptions, read_groom, write_groom};

/// Strands of equal point count, as `.tfx` requires.
fn even(strands: usize) -> Groom {
    let groom = groom(4 * strands);
    Groom::from_strands((0..strands).map(|s| groom.strand(4 * s).to_vec()), 4e-5)
}

#[test]
fn a_round_trip_through_all_formats_is_exact() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let groom = even(100);
    write_groom(&at("a.hair"), &groom).unwrap();
    for (from, to) in [("a.hair", "b.tfx"), ("b.tfx", "c.data"), ("c.data", "d.hair")] {
        let stdout = succeed(folder.path(), &["convert", from, to, "--scale", "1"]);
        assert!(stdout.contains(to) && stdout.contains("100 strands"), "{stdout}");
    }
    let back = read_groom(&at("d.hair"), &ReadOptions::default()).unwrap().value;
    assert_eq!(back.offsets, groom.offsets);
    assert_eq!(back.points, groom.points);
}

#[test]
fn scale_and_axes_are_applied_once() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let groom = even(10);
    write_groom(&at("a.data"), &groom).unwrap();
    succeed(folder.path(), &["convert", "a.data", "b.hair", "--scale", "0.5", "--up", "z"]);
    let back = read_groom(&at("b.hair"), &ReadOptions::default()).unwrap().value;
    for (got, p) in back.points.iter().zip(&groom.points) {
        assert_eq!(*got, 0.5 * Vec3::new(p.x, p.z, -p.y));
    }
}
