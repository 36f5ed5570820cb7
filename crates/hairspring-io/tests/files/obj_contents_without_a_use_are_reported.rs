//! Promise: what a `.obj` file holds and the reader does not use is reported: points, other files, faces without an area,
//! vertices without a face, and names in an old encoding.

use glam::Vec3;
use hairspring_io::{Character, Loaded, ReadOptions, read_body, read_groom};
use std::fs;

/// A cube of 20 cm at a height of 1.6 m, as text.
fn cube() -> String {
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|side| 0.2 * side as f32);
    let vertices = (0..8).map(corner).map(|[x, y, z]| format!("v {x} {} {z}\n", 1.6 + y));
    vertices.collect::<String>() + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn read(data: &[u8]) -> Loaded<Character> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    fs::write(&path, data).unwrap();
    read_body(&path, &ReadOptions::default()).unwrap()
}

#[test]
fn points_and_other_files_are_reported() {
    let loaded = read(format!("{}p 1 2\np 3\ncall other.obj\n", cube()).as_bytes());
    assert!(loaded.notes[0].starts_with("3 points (`p`)"), "{:?}", loaded.notes);
    assert!(loaded.notes[1].starts_with("1 other files are named by `call`"), "{:?}", loaded.notes);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    fs::write(&path, "v 0 0 0\nv 0 0.1 0\nv 0 0.2 0\np 1\ncall b.obj\nl 1 2 3\n").unwrap();
    let notes = read_groom(&path, &ReadOptions::default()).unwrap().notes.join("; ");
    assert!(notes.contains("1 points and") && notes.contains("named by `call`"), "{notes}");
}

#[test]
fn faces_with_a_corner_twice_have_no_triangle_there() {
    let count = |faces: &str| {
        let loaded = read(format!("{}{faces}", cube()).as_bytes());
        (loaded.value.body.mesh.triangles.len() - 12, loaded.notes.join("; "))
    };
    let (more, notes) = count("f 1 1 2\nf 3 4 4\nf 2 3 2\nf 5 5 5\n");
    assert_eq!(more, 0);
    assert!(notes.contains("4 faces have fewer than three different corners"), "{notes}");
    let (more, notes) = count("f 1 2 2 3\nf 1 2 3 1\n");
    assert_eq!(more, 2);
    assert!(!notes.contains("faces"), "{notes}");
}

#[test]
fn a_vertex_without_a_face_does_not_decide_the_size() {
    for stray in ["5000 0 0", "0 -300 0", "1e9 1e9 1e9"] {
        let loaded = read(format!("{}v {stray}\n", cube()).as_bytes());
        assert_eq!((loaded.scale, loaded.value.body.mesh.positions.len()), (1.0, 9), "{:?}", loaded.notes);
        let (lo, hi) = loaded.value.body.mesh.bounds().unwrap();
        assert!(lo.distance(Vec3::Y * 1.6) < 1e-6 && (hi - lo).distance(Vec3::splat(0.2)) < 1e-6);
        assert!(loaded.notes[0].starts_with("1 vertices that no face uses"), "{:?}", loaded.notes);
    }
    // One inside of the mesh is no matter.
    assert_eq!(read(format!("{}v 0.1 1.7 0.1\n", cube()).as_bytes()).notes.len(), 1);
}

#[test]
fn names_in_latin_1_are_read_with_a_note() {
    let file = [&b"g T\xeate\n"[..], cube().as_bytes()].concat();
    let loaded = read(&file);
    assert_eq!(loaded.value.body.mesh.parts[0].name, "Tête");
    assert!(loaded.notes[0].contains("read as Latin-1"), "{:?}", loaded.notes);
    let loaded = read(format!("g Tête\n{}", cube()).as_bytes());
    assert_eq!((&loaded.value.body.mesh.parts[0].name[..], loaded.notes.len()), ("Tête", 1));
}
