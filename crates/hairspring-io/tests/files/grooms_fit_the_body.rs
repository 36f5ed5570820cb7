//! Promise: a groom that does not fit its body is reported, with what to do.
//!
//! The unit is chosen by the body that the strands stand on, or by their length if there is no body. Stray
//! points do not decide it. Roots away from the skin, strands that begin at their tips, and colors that
//! replace those of the look are reported.

use crate::{ellipsoid::write_ellipsoid, samples};
use glam::{Vec2, Vec3};
use hairspring::groom::Groom;
use hairspring_io::{ReadOptions, SkinDistance, hair, read_groom, read_scene, tfx};
use std::{f32::consts::TAU, fs, path::Path};
use tempfile::TempDir;

/// Strands of `length` m on a sphere of radius `radius` m around `center`, outward, times `unit`.
fn fur(center: Vec3, radius: f32, length: f32, unit: f32) -> Vec<Vec<Vec3>> {
    let on_sphere = |i: usize| {
        let (angle, y) = (0.618 * TAU * i as f32, 1.0 - 2.0 * (i as f32 + 0.5) / 200.0);
        let ring = (1.0 - y * y).sqrt();
        Vec3::new(ring * angle.cos(), y, ring * angle.sin())
    };
    let strand = |out: Vec3| -> Vec<Vec3> {
        (0..6).map(|k| (center + out * (radius + length * k as f32 / 5.0)) * unit).collect()
    };
    (0..200).map(|i| strand(on_sphere(i))).collect()
}

/// Writes strands as a `.data` file, which has no unit.
fn write_data(path: &Path, strands: &[Vec<Vec3>]) {
    let mut bytes = (strands.len() as i32).to_le_bytes().to_vec();
    for strand in strands {
        bytes.extend((strand.len() as i32).to_le_bytes());
        bytes.extend(strand.iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    }
    fs::write(path, bytes).unwrap();
}

/// Writes a sphere as an `.obj` in meters.
fn write_sphere(path: &Path, center: Vec3, radius: f32) {
    write_ellipsoid(path, center, Vec3::splat(radius));
}

const CENTER: Vec3 = Vec3::new(0.0, 1.6, 0.0);

/// A folder with a head as `head.obj`, and these strands as `hair.data`.
fn folder(strands: &[Vec<Vec3>]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    write_sphere(&folder.path().join("head.obj"), CENTER, 0.1);
    write_data(&folder.path().join("hair.data"), strands);
    folder
}

/// Reads a scene with the head and the groom; returns the groom and the notes about it.
fn on_head(folder: &TempDir, more: &str) -> (Groom, String) {
    let text = format!("[body]\nfile = \"head.obj\"\nscale = 1.0\n[[groom]]\nfile = \"hair.data\"\n{more}\n");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    let mut loaded = read_scene(&path).unwrap();
    loaded.notes.retain(|note| note.starts_with("hair."));
    (loaded.value.grooms.remove(0).groom, loaded.notes.join("\n"))
}

#[test]
fn the_unit_that_puts_the_roots_on_the_body_is_chosen() {
    for (unit, name) in
        [(1.0, "meters"), (10.0, "decimeters"), (100.0, "centimeters"), (1000.0, "millimeters")]
    {
        // From a stubble to long hair, whose size alone would give other units.
        for length in [0.004, 0.03, 0.3, 0.8] {
            let folder = folder(&fur(CENTER, 0.1, length, unit));
            let (groom, notes) = on_head(&folder, "");
            let got = groom.strand_length(0);
            assert!((got / length - 1.0).abs() < 1e-3, "{name}: {length} m was read as {got} m: {notes}");
            assert!(notes.contains(name) && notes.contains("skin") && notes.contains("`scale`"), "{notes}");
            assert!(!notes.contains("from the skin"), "{notes}");
        }
    }
    // A placement counts.
    let folder = folder(&fur(Vec3::ZERO, 0.1, 0.03, 100.0));
    let (groom, notes) = on_head(&folder, "transform.position = [0.0, 1.6, 0.0]");
    assert!((groom.strand_length(0) - 0.03).abs() < 1e-4, "{notes}");
}

#[test]
fn without_a_body_the_length_of_strands_decides_between_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    let read = |strands: &[Vec<Vec3>]| {
        write_data(&path, strands);
        let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
        (loaded.scale, loaded.notes.join("\n"))
    };
    let brows = |unit: f32| -> Vec<Vec<Vec3>> {
        let brow = |i: i32| Vec3::new(0.005 * i as f32, 0.0, 0.09);
        let hair = |i| (0..4).map(|k| (brow(i) + Vec3::Y * 0.0017 * k as f32) * unit).collect();
        (-6..=6).map(hair).collect()
    };
    for unit in [1.0, 100.0, 1000.0] {
        assert_eq!(read(&brows(unit)).0, 1.0 / unit, "brows, {unit} units in a meter");
    }
    // The coat of an animal of 1.8 m.
    for unit in [1.0, 100.0, 1000.0] {
        let (scale, notes) = read(&fur(CENTER, 0.9, 0.02, unit));
        assert_eq!(scale, 1.0 / unit, "fur, {unit} units in a meter: {notes}");
    }
    for unit in [1.0, 10.0, 100.0, 1000.0] {
        assert_eq!(read(&fur(CENTER, 0.1, 0.2, unit)).0, 1.0 / unit, "hair, {unit} units in a meter");
    }
}

#[test]
fn stray_points_do_not_decide_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    for unit in [1.0, 100.0] {
        let mut strands = fur(Vec3::new(0.0, 30.0, 0.0), 0.1, 0.2, unit);
        strands.iter_mut().take(3).for_each(|strand| strand.fill(Vec3::ZERO));
        strands[10][3] = Vec3::ZERO;
        write_data(&path, &strands);
        let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
        let notes = loaded.notes.join("\n");
        assert_eq!(loaded.scale, 1.0 / unit, "{notes}");
        assert!(notes.contains("19 points at the origin"), "{notes}");
    }
}

#[test]
fn strands_without_a_length_or_far_from_the_others_do_not_decide_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    for length in [0.2, 0.5] {
        for unit in [1.0, 100.0] {
            let right = fur(CENTER, 0.1, length, unit);
            let stub =
                |at: Vec3| (0..6).map(|k| (at + Vec3::X * 0.001 * k as f32) * unit).collect::<Vec<_>>();
            for (what, stray) in [
                ("at the origin", vec![Vec3::ZERO; 6]),
                ("of another place", vec![CENTER * 3.0 * unit; 6]),
                ("without a number", vec![Vec3::NAN; 6]),
                ("short, at the origin", stub(Vec3::ZERO)),
                ("short, far away", stub(Vec3::splat(-40.0))),
            ] {
                let mut strands = right[..50].to_vec();
                strands.iter_mut().step_by(5).for_each(|strand| *strand = stray.clone());
                write_data(&path, &strands);
                let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
                let notes = loaded.notes.join("\n");
                assert_eq!(loaded.scale, 1.0 / unit, "10 of 50 strands {what}, {length} m: {notes}");
                let mentioned = notes.contains("do not count");
                assert_eq!(mentioned, what != "without a number", "{what}: {notes}");
            }
        }
    }
}

/// `count` strands of `points` points of 20 cm, 2 cm apart, with the tips of the first `strays` 30 m away.
fn small(count: usize, points: usize, strays: usize, far: f32) -> Vec<Vec<Vec3>> {
    let at = |s: usize, k: usize| {
        Vec3::new(0.02 * (s % 12) as f32, 1.6 + 0.2 * k as f32 / (points - 1) as f32, 0.0)
    };
    let mut strands: Vec<Vec<Vec3>> = (0..count).map(|s| (0..points).map(|k| at(s, k)).collect()).collect();
    strands.iter_mut().take(strays).for_each(|strand| strand[points - 1] = Vec3::X * far);
    strands
}

#[test]
fn points_far_from_the_others_do_not_decide_the_unit_of_small_grooms() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    for (count, points, strays, far) in [
        (12, 8, 0, 0.0),
        (12, 8, 1, 30.0),
        (12, 16, 2, 30.0),
        (100, 10, 15, 30.0),
        (6, 8, 1, 1e30),
        (12, 8, 1, f32::MAX),
    ] {
        write_data(&path, &small(count, points, strays, far));
        let loaded = read_groom(&path, &ReadOptions::default()).unwrap();
        let notes = loaded.notes.join("\n");
        assert_eq!(loaded.scale, 1.0, "{count} strands, {strays} strays at {far}: {notes}");
        let of_strays = format!("({strays} points far from the others do not count)");
        assert_eq!(notes.contains(&of_strays), strays > 0, "{notes}");
        assert!(!notes.contains("000000"), "{notes}");
    }
    // On a body, too.
    let mut strands = fur(CENTER, 0.1, 0.2, 1.0);
    strands.iter_mut().take(20).for_each(|strand| strand[5] = Vec3::X * 30.0);
    let (_, notes) = on_head(&self::folder(&strands), "");
    assert!(notes.contains("guessed meters") && notes.contains("(20 points far"), "{notes}");
}

#[test]
fn strands_with_a_point_far_away_are_reported_and_others_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.data");
    let read = |strands: &[Vec<Vec3>]| {
        write_data(&path, strands);
        read_groom(&path, &ReadOptions { scale: Some(1.0), up: None }).unwrap().notes
    };
    let mut strands = small(40, 8, 0, 0.0);
    assert_eq!(read(&strands), Vec::<String>::new());
    strands[7][0] = Vec3::ZERO;
    strands[9][7] = Vec3::new(1.8, 1.8, 0.0);
    let notes = read(&strands);
    assert!(notes[0].starts_with("2 strands, the first of them strand 7, have a segment"), "{notes:?}");
    assert!(notes[0].contains("(1.6") && notes[0].contains("correct it"), "{notes:?}");
}

#[test]
fn roots_away_from_the_skin_are_reported() {
    // Nothing to say within a centimeter.
    let (_, notes) = on_head(&folder(&fur(CENTER, 0.105, 0.1, 1.0)), "scale = 1.0");
    assert_eq!(notes, "");
    let (groom, notes) = on_head(&folder(&fur(CENTER, 0.13, 0.1, 1.0)), "scale = 1.0");
    assert!(notes.contains("roots are 0.03") && notes.contains("m from the skin"), "{notes}");
    assert!(notes.contains("`scale`") && notes.contains("`transform`"), "{notes}");
    // Only some of them.
    let mut strands = fur(CENTER, 0.1, 0.1, 1.0);
    strands.iter_mut().take(5).flatten().for_each(|p| p.y += 0.2);
    let (_, notes) = on_head(&folder(&strands), "scale = 1.0");
    assert!(notes.contains("some roots are up to 0.20"), "{notes}");
    // Far away, by a wrong unit.
    let (_, notes) = on_head(&folder(&fur(CENTER, 0.1, 0.1, 1.0)), "scale = 0.01");
    assert!(notes.contains("roots are 1.4") || notes.contains("roots are 1.5"), "{notes}");
    let tree = hairspring::body::Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Z],
        triangles: vec![[0, 2, 1]],
        ..Default::default()
    };
    assert!(SkinDistance::of(&groom, &tree).unwrap().median > 1.0);
}

#[test]
fn reversed_strands_are_reported_and_can_be_turned() {
    for length in [0.01, 0.15] {
        let mut strands = fur(CENTER, 0.1, length, 1.0);
        let right = Groom::from_strands(&strands, 35e-6).points;
        strands.iter_mut().for_each(|strand| strand.reverse());
        // A few strands the other way round do not matter.
        strands.iter_mut().take(20).for_each(|strand| strand.reverse());
        let folder = folder(&strands);
        let (_, notes) = on_head(&folder, "scale = 1.0");
        assert!(notes.contains("probably reversed") && notes.contains("`reverse = true`"), "{notes}");
        let (groom, notes) = on_head(&folder, "scale = 1.0\nreverse = true");
        assert!(!notes.contains("reversed"), "{notes}");
        assert_eq!(groom.points[20 * 6..], right[20 * 6..]);
        // The unit is found all the same.
        let (_, notes) = on_head(&folder, "");
        assert!(notes.contains("meters") && notes.contains("probably reversed"), "{notes}");
    }
    // One of them is named with the remedy, too.
    let mut strands = fur(CENTER, 0.1, 0.1, 1.0);
    strands[3].reverse();
    let (_, notes) = on_head(&folder(&strands), "scale = 1.0");
    assert!(notes.contains("up to 0.1") && notes.contains("`reverse = \"nearest\"`"), "{notes}");
    let folder = folder(&fur(CENTER, 0.1, 0.1, 1.0));
    let (_, notes) = on_head(&folder, "scale = 1.0\nreverse = true");
    assert!(notes.contains("remove `reverse`"), "{notes}");
    // A groom of which a part is reversed is turned strand by strand.
    for share in [0.3, 0.6] {
        let mut strands = fur(CENTER, 0.1, 0.1, 1.0);
        let right = Groom::from_strands(&strands, 35e-6).points;
        let turned = (share * strands.len() as f32) as usize;
        strands.iter_mut().take(turned).for_each(|strand| strand.reverse());
        let folder = self::folder(&strands);
        let (_, notes) = on_head(&folder, "scale = 1.0");
        let part = format!("{:.0} % of the strands begin away from the skin", 100.0 * share);
        assert!(notes.contains(&part) && notes.contains("`reverse = \"nearest\"`"), "{notes}");
        let (groom, notes) = on_head(&folder, "scale = 1.0\nreverse = \"nearest\"");
        let part = format!("{turned} of {} strands ended nearer to the skin", strands.len());
        assert!(notes.contains(&part) && !notes.contains("probably"), "{notes}");
        assert_eq!(groom.points, right);
        // The place of the groom counts, not that in its file.
        strands.iter_mut().flatten().for_each(|p| *p += Vec3::Z);
        let moved = "scale = 1.0\nreverse = \"nearest\"\ntransform.position = [0.0, 0.0, -1.0]";
        let (groom, _) = on_head(&self::folder(&strands), moved);
        assert!(groom.points.iter().zip(&right).all(|(a, b)| a.distance(*b) < 1e-6), "share {share}");
    }
    // Values of points turn with them.
    let mut groom = samples::groom(4);
    let before = groom.clone();
    groom.reverse();
    assert_eq!((groom.points[0], groom.colors[0]), (before.points[3], before.colors[3]));
    assert_eq!(groom.radii[0], before.radii[3]);
    groom.reverse();
    assert_eq!(groom, before);
}

#[test]
fn colors_of_a_file_replace_those_of_the_look_unless_the_scene_sets_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(folder.path().join("hair.hair"), samples::written(&samples::groom(4), "hair")).unwrap();
    let read = |more: &str| {
        fs::write(&path, format!("[[groom]]\nfile = \"hair.hair\"\n{more}\n")).unwrap();
        let mut loaded = read_scene(&path).unwrap();
        (!loaded.value.grooms.remove(0).groom.colors.is_empty(), loaded.notes.join("\n"))
    };
    assert_eq!(read(""), (true, String::new()));
    for look in
        ["root_color = [0.5, 0.1, 0.1]", "tip_color = \"#a0522d\"", "melanin = 0.3", "dye = [1, 0, 0]"]
    {
        let (colored, notes) = read(&format!("look.{look}"));
        assert!(colored && notes.contains("color for each point, which replaces"), "{look}: {notes}");
        assert!(notes.contains("`colors = \"look\"`"), "{notes}");
        assert_eq!(read(&format!("colors = \"look\"\nlook.{look}")), (false, String::new()));
        assert!(read(&format!("colors = \"file\"\nlook.{look}")).0);
    }
    // Settings that are not colors are no conflict.
    assert_eq!(read("look.roughness = 0.5"), (true, String::new()));
    // A file without colors has none to use.
    let mut plain = samples::groom(4);
    plain.colors.clear();
    fs::write(folder.path().join("hair.hair"), samples::written(&plain, "hair")).unwrap();
    assert_eq!(read(""), (false, String::new()));
    let (colored, notes) = read("colors = \"file\"");
    assert!(!colored && notes.contains("the file has no colors"), "{notes}");
}

#[test]
fn tressfx_text_is_read() {
    let groom = tfx::parse(samples::tfx_2().as_bytes()).unwrap();
    assert_eq!(groom.offsets, [0, 4, 7]);
    assert_eq!((groom.points[0], groom.points[3]), (Vec3::new(0.0, 1.0, 0.5), Vec3::new(0.3, 1.3, 0.5)));
    assert_eq!(groom.points[6], Vec3::new(-1.0, 1.2, 0.0));
    assert_eq!(groom.root_uvs, [Vec2::new(0.25, 0.0), Vec2::new(0.5, 1.0)]);
    // The header places the strands.
    let placed = samples::tfx_2().replace("scale 1.0", "scale 2.0").replace("translation 0", "translation 1");
    assert_eq!(tfx::parse(placed.as_bytes()).unwrap().points[0], Vec3::new(1.0, 2.0, 1.0));
    let dos = samples::tfx_2().replace('\n', "\r\n");
    assert_eq!(tfx::parse(dos.as_bytes()).unwrap(), groom);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.tfx");
    fs::write(&path, samples::tfx_2()).unwrap();
    let notes = read_groom(&path, &ReadOptions::default()).unwrap().notes.join("\n");
    assert!(notes.contains("4 follow hairs"), "{notes}");
    for (from, to, part) in [
        ("numStrands 2", "numStrands 3", "names 3 strands, but the file holds 2"),
        ("numVerts 4", "numVerts 5", "line 16: expected a coordinate of strand 0, found `strand`"),
        ("numVerts 4", "numVerts 3", "line 15: strand 0 has more points than its `numVerts` names (3)"),
        ("numVerts 4", "numPoints 4", "line 11: expected `numVerts`"),
        ("0.0, 1.0, 0.5", "0.0, one, 0.5", "line 12: expected a coordinate of strand 0, found `one`"),
        ("version 2.0", "version 5", "line 1: version 5 is not supported"),
        ("is sorted 1", "sorted 1", "line 10: `sorted` is no keyword"),
    ] {
        let error = tfx::parse(samples::tfx_2().replace(from, to).as_bytes()).unwrap_err().to_string();
        assert!(error.contains(part), "{to}: {error}");
    }
    // The binary form names fixed points by their mass, and may be longer than its arrays.
    let binary = |fixed: &[usize], extra: usize| {
        let mut data = samples::written(&samples::groom(4), "tfx");
        let positions = u32::from_le_bytes(data[12..16].try_into().unwrap()) as usize;
        fixed.iter().for_each(|point| data[positions + 16 * point + 12..][..4].fill(0));
        data.extend(vec![0; extra]);
        fs::write(&path, data).unwrap();
        read_groom(&path, &ReadOptions::default()).unwrap().notes.join("\n")
    };
    assert_eq!(binary(&[], 0), "");
    assert!(binary(&[3, 7], 0).contains("2 of its tips are marked as fixed; they are simulated as free"));
    assert!(binary(&[2], 0).contains("1 points after the first two"));
    assert!(binary(&[], 40).contains("40 bytes after the last array are not used"));
    // Other formats are not taken for text.
    assert!(tfx::parse(b"HAIR").is_err() && hair::parse(samples::tfx_2().as_bytes()).is_err());
}
