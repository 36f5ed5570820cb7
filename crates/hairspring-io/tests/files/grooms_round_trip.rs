//! Promise: a written groom is read back, exactly where the format can hold its values.
//!
//! Baked frames must not lose precision: positions, radii and colors come back exactly. `.hair` and `.tfx`
//! files are in meters and Y up, and the reader guesses neither. A file is either complete or absent, and
//! data that a format cannot hold is reported.

use glam::{Vec2, Vec3};
use hairspring::groom::{DEFAULT_RADIUS, Groom};
use hairspring_io::{
    Axis, ErrorKind, FrameWriter, ReadOptions, Strands, hair, read_groom, tfx, usc, write_groom,
    write_strands,
};
use proptest::prelude::*;
use std::fs;

/// Any finite position.
fn point() -> impl Strategy<Value = Vec3> {
    let x = || prop_oneof![4 => -2.0f32..2.0, 1 => any::<f32>().prop_filter("finite", |x| x.is_finite())];
    (x(), x(), x()).prop_map(Vec3::from)
}

/// A groom of strands of 1 to 9 points, with any radii and colors. `even`: equal point counts, and one
/// radius a strand.
fn groom(even: bool) -> impl Strategy<Value = Groom> {
    let strands = (1usize..9).prop_flat_map(move |n| {
        let counts = if even { n..n + 1 } else { 1..10 };
        prop::collection::vec(prop::collection::vec((point(), point(), 1e-7f32..1.0), counts), 0..8)
    });
    (strands, any::<bool>(), any::<bool>()).prop_map(move |(strands, colored, with_uvs)| {
        let mut groom =
            Groom::from_strands(strands.iter().map(|s| s.iter().map(|p| p.0).collect::<Vec<_>>()), 0.0);
        let radius = |s: &[(Vec3, Vec3, f32)], i: usize| if even { s[0].2 } else { s[i].2 };
        groom.radii = strands.iter().flat_map(|s| (0..s.len()).map(move |i| radius(s, i))).collect();
        if colored {
            groom.colors = strands.iter().flatten().map(|p| p.1).collect();
        }
        if even && with_uvs {
            groom.root_uvs = strands.iter().map(|s| Vec2::new(s[0].2, 0.5)).collect();
        }
        groom
    })
}

/// The bytes of a groom as written.
fn bytes(groom: &Groom, extension: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("groom.{extension}"));
    write_groom(&path, groom).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file is left");
    fs::read(path).unwrap()
}

proptest! {
    #[test]
    fn hair_files_hold_points_radii_and_colors(groom in groom(false)) {
        prop_assert_eq!(hair::parse(&bytes(&groom, "hair")).unwrap(), groom);
    }

    #[test]
    fn tfx_files_hold_points_colors_uvs_and_a_radius_a_strand(groom in groom(true)) {
        prop_assert_eq!(tfx::parse(&bytes(&groom, "tfx")).unwrap(), groom);
    }

    #[test]
    fn data_files_hold_points(groom in groom(false)) {
        let read = usc::parse(&bytes(&groom, "data")).unwrap();
        prop_assert_eq!(read.radii, vec![DEFAULT_RADIUS; groom.point_count()]);
        prop_assert_eq!((read.points, read.offsets), (groom.points, groom.offsets));
    }
}

#[test]
fn scale_of_own_files_is_not_guessed() {
    let folder = tempfile::tempdir().unwrap();
    // A hundredth of the size of a head, so that a guess of the scale would be wrong.
    let strand =
        |i: usize| (0..5).map(|k| Vec3::new(1e-4 * i as f32, 3e-4 * k as f32, 0.0)).collect::<Vec<_>>();
    let groom = Groom::from_strands((0..4).map(strand), 7e-4);
    for extension in ["hair", "tfx"] {
        let path = folder.path().join(format!("a.{extension}"));
        assert_eq!(write_groom(&path, &groom).unwrap(), Vec::<String>::new());
        let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
        assert_eq!((loaded.scale, loaded.notes, loaded.value), (1.0, vec![], groom.clone()), "{extension}");
        let options = ReadOptions { scale: Some(100.0), up: Some(Axis::Z) };
        let scaled = read_groom(&path, &options).unwrap().value;
        assert_eq!(scaled.strand(0)[4], Vec3::new(0.0, 0.0, -3e-4 * 4.0) * 100.0);
    }
}

#[test]
fn a_frame_is_written_from_borrowed_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.0001.hair");
    let points: Vec<Vec3> = (0..6).map(|i| Vec3::splat(i as f32)).collect();
    let frame = Strands { points: &points, offsets: &[0, 3, 6], radii: &[], colors: &[], root_uvs: &[] };
    write_strands(&path, frame).unwrap();
    let read = read_groom(&path, &ReadOptions::default()).unwrap().value;
    assert_eq!((read.points.as_slice(), read.radii), (points.as_slice(), vec![DEFAULT_RADIUS; 6]));
}

#[test]
fn unsupported_data_is_refused_or_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let line = |n: usize| (0..n).map(|k| Vec3::Y * k as f32).collect::<Vec<_>>();
    let uneven = Groom::from_strands([line(3), line(5)], 4e-5);
    let error = write_groom(&path("a.tfx"), &uneven).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(
        error.to_string().contains("strand 0 has 3 and strand 1 has 5; write .hair or .data instead"),
        "{error}"
    );
    let error = write_groom(&path("a.abc"), &uneven).unwrap_err();
    assert!(error.to_string().contains(".hair, .tfx or .data"), "{error}");
    let mut broken = uneven.clone();
    broken.offsets[1] = 9;
    assert!(write_groom(&path("a.hair"), &broken).unwrap_err().to_string().contains("offsets"));
    let mut grouped = uneven.clone();
    grouped.groups = vec![0, 1];
    let lost = write_groom(&path("b.data"), &grouped).unwrap();
    assert_eq!(lost, ["a .data file cannot hold groups, radii; left out"]);
    // The refused writes leave no files.
    let names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert_eq!(names, ["b.data"]);
}

#[test]
fn only_what_a_groom_has_is_reported_as_lost() {
    let folder = tempfile::tempdir().unwrap();
    let line = [0.0, 0.1, 0.2].map(|y| Vec3::Y * y);
    // A reader gives a .data file the default radius.
    let plain = Groom::from_strands([line], DEFAULT_RADIUS);
    assert_eq!(write_groom(&folder.path().join("a.data"), &plain).unwrap(), Vec::<String>::new());
    let mut mapped = plain.clone();
    (mapped.root_uvs, mapped.colors) = (vec![Vec2::ZERO], vec![Vec3::X; 3]);
    let left_out = |name: &str| {
        FrameWriter::new(name.as_ref(), [&mapped, &plain].map(Strands::from).into_iter()).unwrap().1
    };
    assert_eq!(left_out("a.hair"), ["only 1 of 2 grooms have colors; left out"]);
    let both =
        ["colors", "texture coordinates"].map(|what| format!("only 1 of 2 grooms have {what}; left out"));
    assert_eq!(left_out("a.tfx"), both);
    assert_eq!(left_out("a.data"), Vec::<String>::new());
}

#[test]
fn an_existing_file_is_replaced_atomically() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    fs::write(&path, "old").unwrap();
    let groom = Groom::from_strands([[Vec3::ZERO, Vec3::X, Vec3::Y]], 4e-5);
    write_groom(&path, &groom).unwrap();
    assert_eq!(usc::parse(&fs::read(&path).unwrap()).unwrap().points, groom.points);
    let error = write_groom(&folder.path().join("no/such/a.data"), &groom).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Write);
}
